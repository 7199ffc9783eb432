"""Observable indicators of a wrong joint: views, residuals, lengths, motion, the other side.

P persons, T frames, J joints, C cameras. Every sign is (P, T, J) without a unit, finite, and grows
with the errors that it indicates (`reconstruction.joint_errors` weights the signs).
"""

import warnings
from collections.abc import Sequence
from itertools import pairwise, product

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import epipolar, triangulation
from courtside.geometry.camera import Camera
from courtside.geometry.interpolation import window
from courtside.reconstruction import left_right, resampling
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints
from courtside.records.keypoints import skeleton as limbs
from courtside.records.keypoints.keypoints import Keypoints2D, Keypoints3D
from courtside.records.keypoints.skeleton import Skeleton

# Scales: at a length so long a logarithm becomes linear. # ASSUME: near the usual value of each.
REJECTED_M, RESIDUAL_M, LEFT_OUT_M, LENGTH_M, JUMP_M = 0.05, 0.01, 0.02, 0.02, 0.03
MOST_M = 1.0  # longer ones say no more
SIGMA_M = (0.003, 0.3)  # standard deviations below and above count as these
SIDES_M = 0.15  # joints of both sides so close are mistaken for each other
TRUNK_M = 0.25  # ASSUME: half the width of a trunk and of an arm beside it
BEHIND_M = 0.15  # a joint this far behind the trunk's axis is hidden
AXIS = np.linspace(0.0, 1.0, 5)  # where the trunk's axis is looked at
JUMP_S, MEAN_S = 0.3, 0.15  # to either side: of the median path, and of means over time
STEPS = 3  # of Gauss-Newton, without one view
MIN_SCORE = 0.05  # of a view that counts as usable, as `triangulate.min_score`
NAMES = [  # of the signs; those with `_mean` are means over time
    *("two", "rejected", "residual", "doubt", "spread", "left_out", "length", "jump", "sides"),
    *("hidden", "views_mean", "rejected_mean", "length_mean", "doubt_mean"),
]
TRUNK = (("left_shoulder", "left_hip"), ("right_shoulder", "right_hip"))
ACROSS = (("left_shoulder", "right_shoulder"),), (("left_hip", "right_hip"),)


def keypoints_used(
    views: Sequence[Keypoints2D], clocks: Sequence[Clock], points: Keypoints3D, skeleton: Skeleton
) -> tuple[NDArray, NDArray]:
    """Return keypoints (C, P, T, J, 2) px and scores (C, P, T, J) as a triangulation used them.

    `views` and `clocks` are in the order of `points.cameras`; sides are exchanged where it says so.
    """
    xy, score = resampling.resample_all(views, clocks, points.time_s)
    for each in (xy, score):
        left_right.exchange(each, np.moveaxis(points.swapped, -1, 0), skeleton.mirror())
    return xy, score


def of_points(
    cameras: Sequence[Camera], points: Keypoints3D, xy: NDArray, score: NDArray, skeleton: Skeleton
) -> dict[str, NDArray]:
    """Return the signs of a raw record by name (`NAMES`).

    `cameras` are those of `points.cameras`, `xy` and `score` of `keypoints_used`. Where a joint is
    missing its signs mean nothing.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # means and maxima of nothing
        parts = [
            _of_frames(cameras, points.frames(at), score[:, :, at], skeleton)
            for at in keypoints.blocks(len(points.time_s))
        ]
        found = {key: np.concatenate([part[key] for part in parts], axis=1) for key in parts[0]}
        del parts
        found["left_out"] = _log(_without_one(cameras, points, xy, score), LEFT_OUT_M)
        found["length"] = _log(_length_errors(points), LENGTH_M)
        found["jump"] = _log(_jumps(points), JUMP_M)
        means = {"views": 4.0 - np.minimum(points.n_views, 4), **found}
        known = np.isfinite(points.xyz[..., 0])
        for name in NAMES:
            if name.endswith("_mean"):
                one = np.nan_to_num(means[name.removesuffix("_mean")])
                found[name] = _mean_over_time(one, known, points)
    return {name: np.nan_to_num(found[name], copy=False) for name in NAMES}


def _log(length_m: NDArray, scale_m: float) -> NDArray:
    return np.log1p(np.minimum(np.nan_to_num(length_m), MOST_M) / scale_m)


def _of_frames(
    cameras: Sequence[Camera], points: Keypoints3D, score: NDArray, skeleton: Skeleton
) -> dict[str, NDArray]:
    """Return the signs from single frames: number, scores, residuals of views, places of joints."""
    used, seen = points.accepted, np.moveaxis(score, 0, -1)
    focal_px = np.array([epipolar.focal_px(camera) for camera in cameras])
    error_m = points.reproj_error_px / focal_px * _distances(cameras, points)
    rejected = (seen >= MIN_SCORE) & ~used
    sigma_m = np.sqrt(np.trace(points.covariance_2d, axis1=-2, axis2=-1) / 3)
    residual_m = np.sqrt(np.nanmean(np.where(used, error_m**2, np.nan), axis=-1))
    apart = np.linalg.norm(points.xyz - points.xyz[:, :, skeleton.mirror()], axis=-1)
    apart = np.where(np.arange(len(points.joints)) == skeleton.mirror(), np.inf, apart)
    return {
        "two": (points.n_views <= 2).astype(float),
        "rejected": _log(np.nanmax(np.where(rejected, error_m, 0.0), axis=-1), REJECTED_M),
        "residual": _log(residual_m, RESIDUAL_M),
        "doubt": 1 - np.nanmean(np.where(used, seen, np.nan), axis=-1),
        "spread": np.log(np.clip(np.nan_to_num(sigma_m, nan=REJECTED_M), *SIGMA_M) / LEFT_OUT_M),
        "sides": np.exp(-np.nan_to_num(apart, nan=np.inf, posinf=np.inf) / SIDES_M),
        "hidden": 2 - np.minimum(_clear_views(cameras, points), 4) / 2,
    }


def _distances(cameras: Sequence[Camera], points: Keypoints3D) -> NDArray:
    """Return the distance (P, T, J, C) m of joints from cameras."""
    return np.linalg.norm(points.xyz[..., None, :] - _centres(cameras), axis=-1)


def _centres(cameras: Sequence[Camera]) -> NDArray:
    """Return the positions of cameras, (C, 3) m."""
    poses = np.stack([camera.cam_from_world for camera in cameras])
    return -np.einsum("cji,cj->ci", poses[:, :, :3], poses[:, :, 3])


def _without_one(
    cameras: Sequence[Camera], points: Keypoints3D, xy: NDArray, score: NDArray
) -> NDArray:
    """Return the largest shift (P, T, J) m of a joint without one of its views; 0 with two."""
    flat, n_cameras = points.xyz.reshape(-1, 3), len(cameras)
    used = np.moveaxis(points.accepted, -1, 0).reshape(n_cameras, -1)
    weight = np.nan_to_num(score.reshape(n_cameras, -1))
    weight[~used] = 0.0
    n_used = (weight > 0).sum(axis=0)
    moved = np.zeros(len(flat))
    for left_out in range(n_cameras):
        enough = (n_used > 2) & (weight[left_out] > 0)
        there = np.flatnonzero(enough & np.isfinite(flat[:, 0]))
        for start in range(0, len(there), triangulation.BATCH):
            at = there[start : start + triangulation.BATCH]
            rest = weight[:, at]
            rest[left_out] = 0.0
            views = triangulation.Views(cameras, xy.reshape(n_cameras, -1, 2)[:, at], rest)
            place = flat[at]
            for _ in range(STEPS):
                place = views.stepped(place, views.weight)
            moved[at] = np.fmax(moved[at], np.linalg.norm(place - flat[at], axis=1))
    return moved.reshape(points.xyz.shape[:-1])


def _length_errors(points: Keypoints3D) -> NDArray:
    """Return the largest difference (P, T, J) m of a joint's lines from their median in the take.

    Both sides share a median. Lines are limbs, the sides of the trunk, its upper and lower end.
    """
    joints = points.joints.tolist()
    kinds = [
        tuple((f"{side}_{start}", f"{side}_{stop}") for side in ("left", "right"))
        for chain in limbs.CHAINS
        for start, stop in pairwise(chain)
    ]
    error = np.zeros(points.xyz.shape[:-1])
    for person, kind in product(range(len(error)), (*kinds, TRUNK, *ACROSS)):
        ends = [[joints.index(joint) for joint in pair] for pair in kind if set(pair) <= {*joints}]
        xyz = points.xyz[person]
        lengths = [np.linalg.norm(xyz[:, start] - xyz[:, stop], axis=1) for start, stop in ends]
        usual = np.nanmedian(lengths) if lengths else np.nan
        for length, at in zip(lengths, ends, strict=True):
            off = np.nan_to_num(np.abs(length - usual))[:, None]
            error[person][:, at] = np.maximum(error[person][:, at], off)
    return error


def _jumps(points: Keypoints3D) -> NDArray:
    """Return the distance (P, T, J) m of joints from the median of their path."""
    reach = _frames(JUMP_S, points)
    found = np.empty(points.xyz.shape[:-1])
    # All joints, or all frames, at once need much memory.
    for person, joint in np.ndindex(len(points.xyz), len(points.joints)):
        path = points.xyz[person, :, joint]
        padded = np.pad(path, ((reach, reach), (0, 0)), constant_values=np.nan)
        windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis=0)
        for at in keypoints.blocks(len(path)):
            off = path[at] - np.nanmedian(windows[at], axis=-1)
            found[person, at, joint] = np.linalg.norm(off, axis=-1)
    return found


def _frames(seconds: float, points: Keypoints3D) -> int:
    return max(1, window(seconds, points.rate_hz)) if len(points.time_s) > 1 else 1


def _clear_views(cameras: Sequence[Camera], points: Keypoints3D) -> NDArray:
    """Return the number (P, T, J) of a joint's views in which no person's trunk hides it."""
    place = dict(zip(points.joints.tolist(), np.moveaxis(points.xyz, 2, 0), strict=True))
    top, bottom = (
        (place[f"left_{part}"] + place[f"right_{part}"]) / 2 for part in ("shoulder", "hip")
    )
    axis = [top + share * (bottom - top) for share in AXIS]
    clear = np.zeros(points.xyz.shape[:-1])
    for at, centre in enumerate(_centres(cameras)):
        ray = points.xyz - centre
        distance = np.linalg.norm(ray, axis=-1)
        way, hidden = ray / distance[..., None], np.zeros_like(distance)
        for part in (step[person] for step in axis for person in range(len(top))):
            trunk = (part - centre)[None, :, None]
            along = (trunk * way).sum(axis=-1)
            beside = np.linalg.norm(trunk - along[..., None] * way, axis=-1)
            before = np.clip((distance - along) / BEHIND_M, 0, 1)
            hidden = np.fmax(hidden, before * np.clip(1 - beside / TRUNK_M, 0, 1))
        clear += np.where(points.accepted[..., at], 1 - hidden, 0.0)
    return clear


def _mean_over_time(values: NDArray, known: NDArray, points: Keypoints3D) -> NDArray:
    """Return means (P, T, J) over the frames around each in which the joint is known."""
    reach = _frames(MEAN_S, points)
    padding = ((0, 0), (reach, reach), (0, 0))
    summed, count = (
        np.lib.stride_tricks.sliding_window_view(np.pad(part, padding), 2 * reach + 1, axis=1)
        for part in (np.where(known, values, 0.0), known.astype(float))
    )
    return summed.sum(axis=-1) / np.maximum(count.sum(axis=-1), 1)
