"""Fusion of views into one 3D skeleton: all views, half bodies, and the cameras' part of the error."""

from dataclasses import replace

import numpy as np

from courtside.calibration import point_covariance
from courtside.calibration.bundle import selection
from courtside.geometry import triangulation as plain_dlt
from courtside.reconstruction import left_right, resampling
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D


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
        swapped[:, person] = left_right.swapped_views(
            cameras, xy[:, person], score[:, person], mirror, groups, max_error_px=max_error_px
        )
        xy[:, person] = left_right.apply_swaps(xy[:, person], swapped[:, person], mirror)
        score[:, person] = left_right.apply_swaps(score[:, person], swapped[:, person], mirror)
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
    reason = np.full(len(xyz), missing_reason.REJECTED, dtype=np.uint8)
    reason[np.isfinite(xyz).all(axis=-1)] = missing_reason.OK
    reason[n_usable < min_views] = missing_reason.LOW_SCORE
    reason[n_seen < min_views] = missing_reason.ONE_VIEW
    reason[n_seen == 0] = missing_reason.UNSEEN
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


SHARED = ("time_s", "joints", "person_id")


def merge(left, right, cameras):
    """Join the left half of one record with the right half of another.

    Parameters
    ----------
    left : Keypoints3D
        From the centre and the left camera.
    right : Keypoints3D
        From the centre and the right camera; same times, joints and persons.
    cameras : sequence of str
        Of the result.

    Returns
    -------
    merged : Keypoints3D
        Joints of the left side are those of `left`, of the right side those of `right`; joints of neither
        side are the mean of both, or the one that is there.

    Raises
    ------
    ValueError
        If the records differ in times, joints or persons.

    Notes
    -----
    [Shishido2020, section 4]. The paper does not say what becomes of head and neck; the mean is ours.
    """
    for key in SHARED:
        if not np.array_equal(getattr(left, key), getattr(right, key)):
            raise ValueError(f"expected halves of the same {key}, found others")
    cameras = np.array(cameras)
    parts = [_spread(part, cameras) for part in (left, right)]
    names = left.joints.astype(str)
    of_right, of_left = (np.char.startswith(names, side) for side in ("right_", "left_"))
    chosen = {
        key: _choose(getattr(parts[0], key), getattr(parts[1], key), of_left, of_right)
        for key in ("xyz", "covariance_2d", "covariance_camera", "reproj_error_px")
    }
    # The mean of two dependent points (they share a camera): its covariance is at most their mean.
    either = ~(of_left | of_right)
    views = np.where(of_right[:, None], parts[1].accepted, parts[0].accepted)
    views[:, :, either] = (parts[0].accepted | parts[1].accepted)[:, :, either]
    reason = np.where(of_right, right.reason, left.reason)
    reason[:, :, either] = np.minimum(left.reason, right.reason)[:, :, either]
    n_views = views.sum(axis=-1) * np.isfinite(chosen["xyz"][..., 0])
    return replace(left, cameras=cameras, accepted=views, n_views=n_views, reason=reason, **chosen)


def _spread(points, cameras):
    """Return a record with a column for each of more cameras."""
    at = [cameras.tolist().index(name) for name in points.cameras.tolist()]
    shape = (*points.reproj_error_px.shape[:-1], len(cameras))
    error, accepted = np.full(shape, np.nan), np.zeros(shape, dtype=bool)
    error[..., at], accepted[..., at] = points.reproj_error_px, points.accepted
    return replace(points, cameras=cameras, reproj_error_px=error, accepted=accepted)


def _choose(left, right, of_left, of_right):
    """Choose along the joints, the third axis; where a joint is of neither side, take the mean."""
    shape = (1, 1, -1) + (1,) * (left.ndim - 3)
    mean = np.where(np.isnan(left), right, np.where(np.isnan(right), left, (left + right) / 2))
    return np.where(of_left.reshape(shape), left, np.where(of_right.reshape(shape), right, mean))


def with_cameras(points, cameras, covariance):
    """Add the covariance that the cameras' own causes to a record.

    Parameters
    ----------
    points : Keypoints3D
    cameras : list of Camera
        Those of `points.cameras`.
    covariance : (K, K) float
        Of the columns of the network of these cameras, as
        `courtside.calibration.records.covariance.CameraCovariance.of_columns` returns it.

    Returns
    -------
    points : Keypoints3D
        With `covariance_camera`: that of a person's middle in each frame, the same for all joints; NaN
        where the person is missing.

    Notes
    -----
    # ASSUME: the error of a calibration changes little within the reach of a body, and little when single
    joints rest on fewer views than the person does.
    """
    placed = np.isfinite(points.xyz)
    count = placed.sum(axis=2)
    middle = np.where(placed, points.xyz, 0).sum(axis=2) / np.where(count, count, np.nan)
    flat = middle.reshape(-1, 3)
    known = np.isfinite(flat).all(axis=1)
    found = np.full((len(flat), 3, 3), np.nan)
    network = selection.of_cameras(cameras)
    found[known] = point_covariance.point_covariance(network, covariance, flat[known])
    found = found.reshape(*middle.shape, 3)[:, :, None]
    there = placed.all(axis=-1)[..., None, None]
    return replace(points, covariance_camera=np.where(there, found, np.nan))
