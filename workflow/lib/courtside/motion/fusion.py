"""Keypoints of all cameras of a take -> one metric skeleton per person."""

from dataclasses import replace

import numpy as np

from courtside.geometry import sides
from courtside.geometry import triangulation as plain_dlt
from courtside.motion import resampling, side_paths
from courtside.records import reasons
from courtside.records.keypoints import Keypoints3D
from courtside.records.sync import Clock


def triangulate_take(
    cameras,
    views,
    skeleton,
    person_id,
    *,
    min_score,
    min_views,
    max_error_px,
    fade_px,
    fix_sides,
    clocks=None,
    time_s=None,
    rule="robust",
):
    """Triangulate the persons of one take.

    Parameters
    ----------
    cameras : list of Camera, length C
        In the order of `views`.
    views : list of Keypoints2D, length C
        One tracklet per person, in the same order in every camera.
    skeleton : Skeleton
        Of the network that made `views`.
    person_id : list of str, length P
        Names of the tracklets' persons.
    min_score, min_views, max_error_px, fade_px
        As for `triangulation.triangulate_robust`.
    fix_sides : bool
        Whether to exchange left and right in views that contradict the others.
    clocks : list of Clock, length C, optional
        Of the cameras, in the order of `views`; clocks that agree by default.
    time_s : (T,) float, optional
        Of the result, on the reference clock; `resampling.common_times` of the views by default.
    rule : str
        "robust" weighs and leaves out views (`triangulation.triangulate_robust`); "dlt" takes all as they are
        (`triangulation.triangulate_plain`).

    Returns
    -------
    points : Keypoints3D
    swapped : (C, P, T, J) bool
        Where left and right changed places.

    Notes
    -----
    The keypoints' standard deviation is not assumed but measured: per joint, from the residuals of the
    accepted views, with the three coordinates of each point counted as spent degrees of freedom. It
    holds what the views disagree on; an error that all views share (a network that places every hip too
    low) is not in it.
    """
    clocks = clocks or [Clock()] * len(views)
    time_s = resampling.common_times(views, clocks) if time_s is None else time_s
    resampled = [
        resampling.resample(view, time_s, clock) for view, clock in zip(views, clocks, strict=True)
    ]
    xy, score = (np.stack(part) for part in zip(*resampled, strict=True))
    swapped = np.zeros(score.shape, dtype=bool)
    if fix_sides and rule == "robust":
        xy, score, swapped = _fix_sides(cameras, xy, score, skeleton, max_error_px)
    flat = score.reshape(len(cameras), -1)
    options = {"min_views": min_views, "min_score": min_score, "sigma_px": 1.0}
    solve = plain_dlt.triangulate_plain
    if rule == "robust":
        solve = plain_dlt.triangulate_robust
        options |= {"max_error_px": max_error_px, "fade_px": fade_px}
    found = solve(cameras, xy.reshape(len(cameras), -1, 2), flat, **options)
    points = _record(cameras, views[0], person_id, time_s, found, score.shape[1:])
    reason = why_missing(flat, found.xyz, min_score, min_views).reshape(points.xyz.shape[:-1])
    variance = keypoint_variance(points, score)
    covariance = points.covariance_2d * variance[:, None, None]
    return replace(points, reason=reason, covariance_2d=covariance), swapped


def _fix_sides(cameras, xy, score, skeleton, max_error_px):
    mirror = np.array(skeleton.mirror())
    groups = [[skeleton.index(j) for j in g] for g in skeleton.side_groups()]
    swapped = np.zeros(score.shape, dtype=bool)
    for person in range(score.shape[1]):
        swapped[:, person] = side_paths.swapped_views(
            cameras, xy[:, person], score[:, person], mirror, groups, max_error_px=max_error_px
        )
        xy[:, person] = sides.apply_swaps(xy[:, person], swapped[:, person], mirror)
        score[:, person] = sides.apply_swaps(score[:, person], swapped[:, person], mirror)
    return xy, score, swapped


def _record(cameras, view, person_id, time_s, found, shape):
    per_view = (len(cameras), *shape)
    accepted = np.moveaxis(found.accepted.reshape(per_view), 0, -1)
    covariance = found.covariance.reshape(*shape, 3, 3)
    return Keypoints3D(
        cameras=np.array([camera.name for camera in cameras]),
        model=view.model,
        joints=view.joints,
        person_id=np.array(person_id),
        time_s=time_s,
        xyz=found.xyz.reshape(*shape, 3),
        covariance_2d=covariance,
        covariance_camera=np.full_like(covariance, np.nan),
        n_views=accepted.sum(axis=-1),
        reproj_error_px=np.moveaxis(found.error_px.reshape(per_view), 0, -1),
        accepted=accepted,
        reason=np.zeros(shape, dtype=np.uint8),
    )


def why_missing(score, xyz, min_score, min_views):
    """Return the reason code of each point, (N,) uint8.

    Parameters
    ----------
    score : (C, N) float
        NaN where unseen.
    xyz : (N, 3) float
        NaN where not triangulated.
    min_score, min_views
        As used for triangulation.
    """
    n_seen = np.isfinite(score).sum(axis=0)
    n_usable = (np.nan_to_num(score, nan=-1.0) >= max(min_score, 1e-12)).sum(axis=0)
    reason = np.full(len(xyz), reasons.REJECTED, dtype=np.uint8)
    reason[np.isfinite(xyz).all(axis=-1)] = reasons.OK
    reason[n_usable < min_views] = reasons.LOW_SCORE
    reason[n_seen < min_views] = reasons.ONE_VIEW
    reason[n_seen == 0] = reasons.UNSEEN
    return reason


def keypoint_variance(points, score):
    """Measure each joint's keypoint variance for score 1, px^2, from how far the views disagree.

    Parameters
    ----------
    points : Keypoints3D
    score : (C, P, T, J) float

    Returns
    -------
    variance : (J,) float
        Per axis; NaN for a joint that never has a degree of freedom.

    Notes
    -----
    Each point has 2 n residuals and spends 3 of them on its coordinates.
    """
    weight = np.where(points.accepted, np.nan_to_num(np.moveaxis(score, 0, -1)), 0.0)
    squares = (weight * np.nan_to_num(points.reproj_error_px) ** 2).sum(axis=(0, 1, 3))
    freedom = np.maximum(2 * points.n_views - 3, 0).sum(axis=(0, 1))
    return np.where(freedom > 0, squares / np.maximum(freedom, 1), np.nan)
