"""Fusion of views into one 3D skeleton: all views, half bodies, covariance of the cameras."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.geometry import triangulation
from courtside.geometry.camera import Camera
from courtside.reconstruction import left_right, person_height, resampling
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints2D, Keypoints3D, unknown_errors
from courtside.records.keypoints.skeleton import Skeleton

# ASSUME: a joint with a larger standard deviation needs views of low scores, too. With 0.08 to 0.16
# m the joints of the development sessions are as near the truth (docs/measured/joints.md).
WEAK_M = 0.12
OPEN_M = 1.0  # ASSUME: a joint with a larger one is nowhere: rays that are nearly parallel


def triangulate_take(
    cameras: Sequence[Camera],
    views: Sequence[Keypoints2D],
    skeleton: Skeleton,
    person_id: Sequence[str],
    *,
    min_score: float,
    min_views: int,
    fix_sides: bool,
    max_error_share: float,
    fade_share: float,
    max_error_px: float | None = None,
    fade_px: float | None = None,
    clocks: Sequence[Clock] | None = None,
    time_s: NDArray | None = None,
    rule: str = "robust",
) -> Keypoints3D:
    """Triangulate the persons of one take; the result tells where sides were exchanged (`swapped`).

    `cameras`, `views` and `clocks` are in one order; without clocks, all agree. Each view has one
    tracklet per person, in the order of `person_id` (P,), by the network of `skeleton`. `fix_sides`
    exchanges left and right in views that contradict the others. `time_s` (T,) is of the result, on
    the reference clock; by default `resampling.common_times` of the views. The `rule` "robust"
    weights and excludes views (`triangulation.triangulate_robust`, which the limits are of), and
    leaves out joints that their views leave open; "dlt" uses all
    (`triangulation.triangulate_plain`). `max_error_share` and `fade_share` are in heights of the
    person in each picture (`person_height.in_pictures`); `max_error_px` and `fade_px`, the same
    everywhere, have precedence. A point needs `min_views` views, or all where there are fewer.

    The keypoints' standard deviation is measured per joint from the residuals of the accepted
    views, three degrees of freedom less per point: in heights of the person in each picture, as the
    limits are, or with "dlt" in px. It contains what the views disagree on, but not an error that
    all views share, such as a network that places every hip too low.
    """
    clocks = clocks or [Clock()] * len(views)
    time_s = resampling.common_times(views, clocks) if time_s is None else time_s
    xy, score = resampling.resample_all(views, clocks, time_s)
    swapped = np.zeros(score.shape, dtype=bool)
    min_views = min(min_views, max(len(cameras), 2))
    options: dict[str, Any] = {"min_views": min_views, "min_score": min_score}
    solve: Callable[..., triangulation.Triangulated] = triangulation.triangulate_plain
    if rule == "robust":
        solve = triangulation.triangulate_robust
        options["weak_m"] = WEAK_M
        stated = {"share": (max_error_share, fade_share), "px": (max_error_px, fade_px)}
        limits = _limits(cameras, xy, score, skeleton.joints, **stated)
        options |= {key: _per_joint(px, score) for key, px in limits.items()}
        if fix_sides:
            swapped = _fix_sides(cameras, xy, score, skeleton, limits["max_error_px"])
    flat = score.reshape(len(cameras), -1)
    found = solve(cameras, xy.reshape(len(cameras), -1, 2), flat, **options)
    points = _record(cameras, views[0], person_id, time_s, found, swapped)
    reason = why_missing(flat, found.xyz, min_score, min_views).reshape(points.xyz.shape[:-1])
    _scale_covariance(points, found.weight.reshape(score.shape), options.get("max_error_px", 1.0))
    del xy, score, flat, found  # for the memory of what follows
    points = replace(points, reason=reason)
    return _without_open(points) if rule == "robust" else points


def _limits(cameras, xy, score, joints, share, px) -> dict[str, NDArray]:
    """Return the limit and where a view fades, (C, P, T) px, from (limit, fade) in shares or px."""
    if not px[0]:
        height_px = person_height.in_pictures(cameras, xy, score, joints)
    limit_px = np.full(score.shape[:3], float(px[0])) if px[0] else share[0] * height_px
    if px[1]:
        fade_px = np.full(score.shape[:3], float(px[1]))
    elif px[0]:
        fade_px = triangulation.FADE * limit_px
    else:
        fade_px = share[1] * height_px
    return {"max_error_px": limit_px, "fade_px": fade_px}


def _per_joint(values: NDArray, score: NDArray) -> NDArray:
    """Return a view of values (C, P, T) for each joint of scores (C, P, T, J)."""
    return np.broadcast_to(values[..., None], score.shape)


def _fix_sides(cameras, xy, score, skeleton, limit_px) -> NDArray:
    """Exchange sides in `xy` and `score`; return where."""
    mirror = np.array(skeleton.mirror())
    groups = [[skeleton.index(j) for j in g] for g in skeleton.side_groups()]
    swapped = np.zeros(score.shape, dtype=bool)
    for person in range(score.shape[1]):
        most_px = np.median(limit_px[:, person], axis=1)
        swapped[:, person] = left_right.swapped_views(
            cameras, xy[:, person], score[:, person], mirror, groups, max_error_px=most_px
        )
    for each in (xy, score):
        left_right.exchange(each, swapped, mirror)
    return swapped


def _record(cameras, view, person_id, time_s, found, swapped) -> Keypoints3D:
    per_view, shape = swapped.shape, swapped.shape[1:]
    accepted = np.moveaxis(found.accepted.reshape(per_view), 0, -1)
    xyz = found.xyz.reshape(*shape, 3)
    errors = unknown_errors(xyz) | {"covariance_2d": found.covariance.reshape(*shape, 3, 3)}
    return Keypoints3D(
        cameras=np.array([camera.name for camera in cameras]),
        model=view.model,
        joints=view.joints,
        person_id=np.array(person_id),
        time_s=time_s,
        xyz=xyz,
        **errors,
        n_views=accepted.sum(axis=-1),
        reproj_error_px=np.moveaxis(found.error_px.reshape(per_view), 0, -1),
        accepted=accepted,
        swapped=np.moveaxis(swapped, 0, -1),
        reason=np.zeros(shape, dtype=np.uint8),
    )


def _without_open(points: Keypoints3D) -> Keypoints3D:
    """Leave out joints whose views leave them open: the standard deviation exceeds `OPEN_M`."""
    variance = np.trace(points.covariance_2d, axis1=-2, axis2=-1)
    is_open = np.isfinite(points.xyz[..., 0]) & ~(np.abs(variance) <= OPEN_M**2)
    return points.without(is_open)


def why_missing(score: NDArray, xyz: NDArray, min_score: float, min_views: int) -> NDArray:
    """Return the reason code (N,) uint8 of each point.

    `score` (C, N) is NaN where unseen, `xyz` (N, 3) NaN where not triangulated; `min_score` and
    `min_views` are those of the triangulation.
    """
    n_seen = np.isfinite(score).sum(axis=0)
    n_usable = (np.nan_to_num(score, nan=-1.0) >= max(min_score, 1e-12)).sum(axis=0)
    reason = np.full(len(xyz), missing_reason.REJECTED, dtype=np.uint8)
    reason[np.isfinite(xyz).all(axis=-1)] = missing_reason.OK
    reason[n_usable < min_views] = missing_reason.LOW_SCORE
    reason[n_seen < min_views] = missing_reason.ONE_VIEW
    reason[n_seen == 0] = missing_reason.UNSEEN
    return reason


def _scale_covariance(points: Keypoints3D, weight: NDArray, sigma_px: NDArray | float) -> None:
    """Multiply the covariance of points by the measured variance of keypoints.

    `weight` (C, P, T, J) is overwritten; `sigma_px` is the standard deviation of a keypoint that
    the covariance is of.
    """
    weight /= sigma_px
    weight /= sigma_px
    covariance = points.covariance_2d
    covariance *= keypoint_variance(points, weight)[:, None, None]


def keypoint_variance(points: Keypoints3D, weight: NDArray) -> NDArray:
    """Measure each joint's keypoint variance (J,) per axis, for weight 1, from the residuals.

    `weight` (C, P, T, J), px^-2, is that of a squared residual. Each point has 2 n residuals and
    uses 3 of them for its coordinates. The result is NaN for a joint without a degree of freedom.
    """
    squares = np.nan_to_num(points.reproj_error_px)
    squares *= squares
    squares *= np.moveaxis(weight, 0, -1)
    squares[~points.accepted] = 0.0
    summed = squares.sum(axis=(0, 1, 3))
    freedom = np.maximum(2 * points.n_views - 3, 0).sum(axis=(0, 1))
    return np.where(freedom > 0, summed / np.maximum(freedom, 1), np.nan)


SHARED = ("time_s", "joints", "person_id")  # fields that both halves must have in common


def merge(left: Keypoints3D, right: Keypoints3D, cameras: Sequence[str]) -> Keypoints3D:
    """Join the left half of one record with the right half of another [Shishido2020, section 4].

    `left` is from the centre and the left camera, `right` from the centre and the right camera;
    `cameras` are those of the result. Left joints are those of `left`, right joints those of
    `right`; joints of neither side are the mean of both, or the one that exists. The paper does not
    state how head and neck are merged; the mean is our choice. A `ValueError` if the records differ
    in times, joints or persons.
    """
    for key in SHARED:
        if not np.array_equal(getattr(left, key), getattr(right, key)):
            raise ValueError(f"expected halves of the same {key}, found different ones")
    names = np.array(cameras)
    parts = [_with_columns(part, names) for part in (left, right)]
    joints = left.joints.astype(str)
    of_right, of_left = (np.char.startswith(joints, side) for side in ("right_", "left_"))
    chosen: dict[str, Any] = {  # Any: mypy cannot match the fields that `replace` gets by `**`
        key: _choose(getattr(parts[0], key), getattr(parts[1], key), of_left, of_right)
        for key in ("xyz", "covariance_2d", "covariance_camera", "reproj_error_px")
    }
    # The mean of two dependent points (they share a camera): its covariance is at most their mean.
    either = ~(of_left | of_right)
    for key in ("accepted", "swapped"):
        halves = [getattr(part, key) for part in parts]
        chosen[key] = np.where(of_right[:, None], halves[1], halves[0])
        chosen[key][:, :, either] = (halves[0] | halves[1])[:, :, either]
    reason = np.where(of_right, right.reason, left.reason)
    reason[:, :, either] = np.minimum(left.reason, right.reason)[:, :, either]
    n_views = chosen["accepted"].sum(axis=-1) * np.isfinite(chosen["xyz"][..., 0])
    return replace(left, cameras=names, n_views=n_views, reason=reason, **chosen)


def _with_columns(points: Keypoints3D, cameras: NDArray) -> Keypoints3D:
    """Return a record with a column for each of more cameras."""
    at = [cameras.tolist().index(name) for name in points.cameras.tolist()]
    shape = (*points.reproj_error_px.shape[:-1], len(cameras))
    filled: dict[str, Any] = {"reproj_error_px": np.full(shape, np.nan)}
    filled |= {key: np.zeros(shape, dtype=bool) for key in ("accepted", "swapped")}
    for key, values in filled.items():
        values[..., at] = getattr(points, key)
    return replace(points, cameras=cameras, **filled)


def _choose(left: NDArray, right: NDArray, of_left: NDArray, of_right: NDArray) -> NDArray:
    """Choose along the joints, the third axis; for joints of neither side take the mean."""
    shape = (1, 1, -1) + (1,) * (left.ndim - 3)
    mean = np.where(np.isnan(left), right, np.where(np.isnan(right), left, (left + right) / 2))
    return np.where(of_left.reshape(shape), left, np.where(of_right.reshape(shape), right, mean))


def with_cameras(
    points: Keypoints3D, cameras: Sequence[Camera], covariance: NDArray
) -> Keypoints3D:
    """Add the covariance caused by the cameras, those of `points.cameras`, to a record.

    `covariance` (K, K) is of the columns of the network of these cameras
    (`CameraCovariance.of_columns` of `courtside.calibration.records.covariance`).
    `covariance_camera` becomes that at a person's middle in each frame, by the views that one of
    the joints rests on, the same for all joints; NaN where the person is missing.

    # ASSUME: the error of a calibration varies little over a body, and little if single joints use
    fewer views than the person does.
    """
    placed = np.isfinite(points.xyz)
    count = placed.sum(axis=2)
    middle = np.where(placed, points.xyz, 0).sum(axis=2) / np.where(count, count, np.nan)
    flat = middle.reshape(-1, 3)
    known = np.isfinite(flat).all(axis=1)
    seen = points.accepted.any(axis=2).reshape(len(flat), -1)
    found = np.full((len(flat), 3, 3), np.nan)
    network = conversion.network_of(cameras)
    found[known] = point_covariance.point_covariance(network, covariance, flat[known], seen[known])
    found = found.reshape(*middle.shape, 3)[:, :, None]
    there = placed.all(axis=-1)[..., None, None]
    return replace(points, covariance_camera=np.where(there, found, np.nan))
