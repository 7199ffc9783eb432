"""The badminton paper's rule for three cameras: each half of the body from the two cameras that see it."""

from dataclasses import replace

import numpy as np

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
