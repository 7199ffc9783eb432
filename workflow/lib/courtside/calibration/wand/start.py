"""Cameras of a wand before they are adjusted: two first, then one after another.

Focal lengths that are not known are tried. Of two cameras those are taken with which the wand's
length varies least (Nistér 2004 for the pose), of each further one those with which most markers
agree (Terzakis & Lourakis 2020).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.wand.points import Seen, Wand
from courtside.geometry import rotations
from courtside.geometry.camera import Camera, undistort
from courtside.geometry.triangulation import triangulate_robust
from courtside.study.errors import InputError

# ASSUME: focal lengths over the picture's longer side, from action cameras to short telephoto
# lenses. The adjustment finds what lies between.
FOCAL_SHARES = (0.5, 0.6, 0.7, 0.84, 1.0, 1.2, 1.45, 1.75, 2.1, 2.5)
COARSE = 2  # of two cameras every other one is tried, of further cameras all
FEWEST_FRAMES = 20  # ASSUME: that two cameras share, with two markers or more in both
SAMPLE = 400  # markers that a pair of cameras is estimated from
REACH = 0.004  # ASSUME: of the picture's longer side: what unknown lenses bend and markers err
LEAST_SHARE = 0.5  # ASSUME: of two cameras' markers that agree
LEAST_AGREEING = 0.3  # ASSUME: of a further camera's, whose lens may not be known
STARTS, ENOUGH = 6, 0.8  # two cameras that are tried; share of markers with which no more are
LEAST_SINE = 0.05  # of the angle between rays, 3 degrees: less is no parallax
PAIRS = 3  # of two cameras that are tried, those that share most
CONFIDENCE, ROUNDS = 0.9999, 2000  # of the random samples
IDEAL = np.eye(3)  # the matrix of a camera whose pixels are rays
HOW = "move it through the views of all cameras, near and far, high and low, in all directions"


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two cameras in the axes of the first, in metres."""

    cameras: tuple[Camera, Camera]
    agreeing: int  # markers
    sine: float  # of the angle between rays, median
    spread: float  # of the wand's length, a share


@dataclass(frozen=True, eq=False)
class _Placed:
    """Cameras by name, and how well the worst of them agrees with those before it."""

    cameras: dict[str, Camera]
    agreeing: float  # share of its markers; less than 0 where one is missing
    fault: str = ""  # why


def guess(
    wand: Wand, seen: Seen, sizes: Mapping[str, tuple[int, int]], lenses: Mapping[str, Camera]
) -> list[Camera]:
    """Place cameras roughly, in the axes of one of them and in metres.

    `sizes` px by camera; `lenses` are those known. Raises `InputError` where the wand does not
    tell how cameras stand.
    """
    shared = _shared(seen)
    _check(seen, shared)
    cameras = [_candidates(name, sizes[name], lenses) for name in seen.cameras]
    best: _Placed | None = None
    for first in _first(wand, seen, cameras, shared):
        found = _completed(first, seen, cameras)
        if best is None or found.agreeing > best.agreeing:
            best = found
        if best.agreeing >= ENOUGH:
            break
    if best is None or best.fault:
        raise InputError(best.fault if best else "wand: expected cameras, found none")
    return [best.cameras[name] for name in seen.cameras]


def _completed(
    first: tuple[Camera, Camera], seen: Seen, cameras: Sequence[Sequence[Camera]]
) -> _Placed:
    """Return two cameras with all others, each placed by the markers that those before it place."""
    posed, least = {camera.name: camera for camera in first}, 1.0
    while len(posed) < len(cameras):
        xyz = _placed(list(posed.values()), seen)
        tried = [
            _resected(candidates, seen.xy[c], xyz)
            for c, candidates in enumerate(cameras)
            if candidates[0].name not in posed
        ]
        count, shown, camera = max(tried, key=lambda one: one[0])
        share = count / max(shown, 1)
        if count < max(FEWEST_FRAMES, LEAST_AGREEING * shown):
            fault = (
                f"camera {camera.name}: expected {FEWEST_FRAMES} markers or more, and "
                f"{100 * LEAST_AGREEING:.0f} %, to agree with the other cameras, found {count} of "
                f"{shown}; check its clock, which marker is which, and that its video is not "
                "mirrored"
            )
            return _Placed(posed, share - 1, fault)  # a start that places all is better
        posed[camera.name], least = camera, min(least, share)
    return _Placed(posed, least)


def _shared(seen: Seen) -> NDArray:
    """Return how many frames (C, C) show two markers or more to both cameras."""
    each = (np.isfinite(seen.xy[..., 0]).sum(axis=2) >= 2).astype(int)
    return each @ each.T


def _check(seen: Seen, shared: NDArray) -> None:
    """Raise an `InputError` where a group of cameras shares too few frames with the others."""
    names = seen.cameras
    inside = {0}
    while (
        more := {int(c) for at in inside for c in np.flatnonzero(shared[at] >= FEWEST_FRAMES)}
        - inside
    ):
        inside |= more
    outside = [c for c in range(len(names)) if c not in inside]
    if outside:
        most = shared[np.ix_(sorted(inside), outside)].max()
        raise InputError(
            f"wand: cameras {', '.join(names[c] for c in sorted(inside))} and "
            f"{', '.join(names[c] for c in outside)}: expected {FEWEST_FRAMES} frames or more in "
            f"which one of each sees two markers, found {most}; {HOW}"
        )


def _candidates(name: str, size: tuple[int, int], lenses: Mapping[str, Camera]) -> list[Camera]:
    """Return a camera at the origin with its known lens, or with each focal length."""
    if name in lenses:
        return [replace(lenses[name], name=name, cam_from_world=np.eye(3, 4))]
    width, height = size
    found = []
    for share in FOCAL_SHARES:
        f_px = share * max(size)
        matrix = np.array([[f_px, 0, (width - 1) / 2], [0, f_px, (height - 1) / 2], [0, 0, 1]])
        found.append(Camera(name, (width, height), matrix, np.zeros(5), np.eye(3, 4)))
    return found


def _coarse(candidates: Sequence[Camera]) -> Sequence[Camera]:
    return candidates[::COARSE]


def _reach(camera: Camera) -> float:
    """Return how far markers may be off, on the z = 1 plane."""
    return REACH * max(camera.size) / float(camera.K[1, 1])


def _first(
    wand: Wand, seen: Seen, cameras: Sequence[Sequence[Camera]], shared: NDArray
) -> list[tuple[Camera, Camera]]:
    """Return two cameras to start from, best first: whose wand has one length in every frame."""
    every = sorted(combinations(range(len(cameras)), 2), key=lambda two: -shared[two])
    found: list[_Pair] = []
    for two in every[:PAIRS]:
        of_pair = [
            one
            for lenses in product(*(_coarse(cameras[c]) for c in two))
            if (one := _related(wand, seen.xy[list(two)], lenses)) is not None
        ]
        most = max((one.agreeing for one in of_pair), default=0)
        found += [one for one in of_pair if one.agreeing >= 0.9 * most]
    wide = [one for one in found if one.sine >= LEAST_SINE]
    if not wide:
        widest = max((one.sine for one in found), default=None)
        what = (
            "none that agree" if widest is None else f"{np.degrees(np.arcsin(widest)):.1f} at most"
        )
        raise InputError(
            f"wand: expected two cameras whose rays to a marker meet at "
            f"{np.degrees(np.arcsin(LEAST_SINE)):.0f} degrees or more, found {what}; check that "
            f"the videos are synchronised and none is mirrored, and {HOW}"
        )
    return [one.cameras for one in sorted(wide, key=lambda one: one.spread)[:STARTS]]


def _related(wand: Wand, xy: NDArray, lenses: Sequence[Camera]) -> _Pair | None:
    """Return two cameras by the essential matrix of their markers (2, F, M, 2)."""
    rays = np.stack([undistort(camera, one) for camera, one in zip(lenses, xy, strict=True)])
    at = np.argwhere(np.isfinite(rays).all(axis=(0, 3)))
    at = at[np.linspace(0, len(at) - 1, min(len(at), SAMPLE)).astype(int)]
    one, other = (each[tuple(at.T)] for each in rays)
    if len(at) < FEWEST_FRAMES:
        return None
    reach = float(np.mean([_reach(camera) for camera in lenses]))
    matrix, inside = cv2.findEssentialMat(
        one, other, IDEAL, method=cv2.RANSAC, prob=CONFIDENCE, threshold=reach, maxIters=ROUNDS
    )
    if matrix is None or inside.sum() < LEAST_SHARE * len(at):
        return None
    inside = inside.ravel().astype(bool)
    _, rotation, shift, front = cv2.recoverPose(matrix[:3], one[inside], other[inside], IDEAL)
    if (front > 0).mean() < LEAST_SHARE:
        return None
    pose = np.column_stack([rotation, shift])
    pair = lenses[0], replace(lenses[1], cam_from_world=pose)
    lengths = _lengths(triangulated(pair, xy[:, :: max(1, xy.shape[1] // SAMPLE)]))
    if len(lengths) < FEWEST_FRAMES // 2:
        return None
    typical = float(np.median(lengths))
    scale = wand.length_m / typical
    pose[:, 3] *= scale
    return _Pair(
        (lenses[0], replace(lenses[1], cam_from_world=pose)),
        int(inside.sum()),
        _sine(rotation, one[inside], other[inside]),
        float(np.median(np.abs(lengths - typical))) / typical,
    )


def _sine(rotation: NDArray, one: NDArray, other: NDArray) -> float:
    """Return the median sine of the angles between rays of two cameras."""
    first, second = (
        rotations.unit(np.pad(xy, ((0, 0), (0, 1)), constant_values=1.0)) for xy in (one, other)
    )
    return float(np.median(np.linalg.norm(np.cross(first @ rotation.T, second), axis=1)))


def triangulated(cameras: Sequence[Camera], xy: NDArray) -> NDArray:
    """Return markers (F, M, 3) from views (C, F, M, 2) that agree; NaN of others."""
    flat = xy.reshape(len(xy), -1, 2)
    limit = REACH * max(max(camera.size) for camera in cameras)
    score = np.isfinite(flat[..., 0]).astype(float)
    with np.errstate(divide="ignore", invalid="ignore"):  # markers that one camera sees alone
        found = triangulate_robust(cameras, flat, score, sigma_px=1.0, max_error_px=limit)
    return found.xyz.reshape(*xy.shape[1:3], 3)


def _lengths(xyz: NDArray) -> NDArray:
    """Return the distances between the first marker and the last, those that are known."""
    apart = np.linalg.norm(xyz[:, -1] - xyz[:, 0], axis=1)
    return apart[np.isfinite(apart)]


def _placed(cameras: Sequence[Camera], seen: Seen) -> NDArray:
    at = [seen.cameras.index(camera.name) for camera in cameras]
    return triangulated(cameras, seen.xy[at])


def _resected(candidates: Sequence[Camera], xy: NDArray, xyz: NDArray) -> tuple[int, int, Camera]:
    """Return how many markers (F, M, 3) a camera agrees with, of how many, and the camera there."""
    at = np.argwhere(np.isfinite(xyz).all(axis=-1) & np.isfinite(xy[..., 0]))
    at = at[np.linspace(0, len(at) - 1, min(len(at), SAMPLE)).astype(int)]
    best = 0, len(at), candidates[0]
    if len(at) < 6:
        return best
    place, px = xyz[tuple(at.T)], xy[tuple(at.T)]
    for camera in candidates:
        fine, vector, shift, near = cv2.solvePnPRansac(
            place, undistort(camera, px), IDEAL, None, iterationsCount=ROUNDS,
            confidence=CONFIDENCE, reprojectionError=_reach(camera), flags=cv2.SOLVEPNP_SQPNP,
        )  # fmt: skip
        if not fine or near is None or len(near) <= best[0]:
            continue
        pose = np.column_stack([rotations.rotation_from_rodrigues(vector.ravel()), shift])
        if (place[near[:, 0]] @ pose[2, :3] + pose[2, 3] > 0).mean() > LEAST_SHARE:
            best = len(near), len(at), replace(camera, cam_from_world=pose)
    return best
