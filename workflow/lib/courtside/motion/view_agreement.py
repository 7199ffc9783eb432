"""How well bodies of two views agree: distances of joints from epipolar lines, robust over joints."""

import numpy as np


def of_pairs(cameras, plane, sigma_px, mirror=None):
    """Return the robust distances between all rows of all pairs of views.

    Parameters
    ----------
    cameras : list of Camera, length C
    plane : list of (P, N, J, 2) float, length C
        Keypoints on the undistorted, normalised plane; NaN where missing.
    sigma_px : list of (P,) float, length C
        Standard deviation of a joint of each row.
    mirror : list of int, length J, optional
        The same joint of the other side: then the closer of both readings counts.

    Returns
    -------
    distance : dict of (int, int) to (P, Q, N) float
        By pair of views, in standard deviations.
    """
    found = {}
    for c in range(len(cameras)):
        for d in range(c + 1, len(cameras)):
            spread_px = (sigma_px[c][:, None] + sigma_px[d]) / 2
            distance = epipolar_distance(cameras[c], cameras[d], plane[c], plane[d])
            if mirror is not None:
                turned = plane[d][:, :, mirror]
                other = epipolar_distance(cameras[c], cameras[d], plane[c], turned)
                distance = np.minimum(distance, other)
            found[c, d] = distance / np.maximum(spread_px, 1e-9)[..., None]
    return found


def epipolar_distance(first, second, one, other):
    """Return the robust distance between bodies of two views.

    Parameters
    ----------
    first, second : Camera
    one, other : (P, N, J, 2), (Q, N, J, 2) float
        Keypoints on the undistorted, normalised plane; NaN where missing.

    Returns
    -------
    distance_px : (P, Q, N) float
        Median over joints of the mean distance to the other view's epipolar lines; inf where fewer than
        three joints are seen in both.

    Notes
    -----
    Hartley & Zisserman 2004, sec. 9.1 and 11.1.
    """
    rotation = second.cam_from_world[:, :3] @ first.cam_from_world[:, :3].T
    x, y, z = second.cam_from_world[:, 3] - rotation @ first.cam_from_world[:, 3]
    essential = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ rotation
    in_second = (
        one @ essential[:, :2].T + essential[:, 2]
    )  # lines of one's joints in the second view
    in_first = other @ essential[:2] + essential[2]
    scale_second = focal_px(second) / np.hypot(in_second[..., 0], in_second[..., 1])
    scale_first = focal_px(first) / np.hypot(in_first[..., 0], in_first[..., 1])
    product = np.abs(
        in_second[:, None, ..., 0] * other[None, ..., 0]
        + in_second[:, None, ..., 1] * other[None, ..., 1]
        + in_second[:, None, ..., 2]
    )
    distance = product * (scale_second[:, None] + scale_first[None]) / 2
    return _median(distance)


def focal_px(camera):
    """Return the mean of both focal lengths, px."""
    return (camera.K[0, 0] + camera.K[1, 1]) / 2


def _median(distance):
    """Return the median over the last axis without NaN, inf where fewer than three are known."""
    ordered = np.sort(distance, axis=-1)
    count = np.isfinite(ordered).sum(axis=-1)
    middle = np.take_along_axis(ordered, np.maximum(count - 1, 0)[..., None] // 2, axis=-1)[..., 0]
    return np.where(count >= 3, middle, np.inf)


def of_views(pairs, instant, row, most):
    """Return how far each view of a candidate is from its other views on the average.

    Parameters
    ----------
    pairs : dict of (int, int) to (P, Q, N) float
        From `of_pairs`.
    instant : (M,) int
    row : (M, C) int
        Row of each camera, -1 for none.
    most : float
        Distances are cut off here.

    Returns
    -------
    distance : (M, C) float
        Zero for a view without a row.
    """
    total, count = np.zeros(row.shape), np.zeros(row.shape)
    for (c, d), distance in pairs.items():
        both = (row[:, c] >= 0) & (row[:, d] >= 0)
        value = np.minimum(distance[row[both, c], row[both, d], instant[both]], most)
        for view in (c, d):
            total[both, view] += value
            count[both, view] += 1
    return total / np.maximum(count, 1)
