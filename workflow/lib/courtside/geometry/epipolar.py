"""Epipolar geometry of two calibrated cameras: how far two pixels are from showing one point."""

import numpy as np

from courtside.geometry import camera as camera_models

TINY = 1e-12


def straight_px(camera, xy):
    """Return pixels (..., 2) as a lens without distortion shows them, about the principal point, px.

    Parameters
    ----------
    camera : Camera
    xy : (..., 2) float
        Distorted px; NaN where missing.
    """
    return camera_models.undistort(camera, xy) * focal_px(camera)


def focal_px(camera):
    """Return the mean of a camera's two focal lengths, px."""
    return (camera.K[0, 0] + camera.K[1, 1]) / 2


def fundamental(camera_a, camera_b):
    """Return the matrix of two cameras whose straight pixels fulfil `b' F a = 0`.

    Parameters
    ----------
    camera_a, camera_b : Camera

    Returns
    -------
    fundamental : (3, 3) float
        For homogeneous straight pixels (x, y, 1) in px about the principal points.

    Notes
    -----
    Hartley & Zisserman 2004, sec. 9.6.
    """
    b_from_a = camera_b.cam_from_world[:, :3] @ camera_a.cam_from_world[:, :3].T
    shift = camera_b.cam_from_world[:, 3] - b_from_a @ camera_a.cam_from_world[:, 3]
    cross = np.array([[0, -shift[2], shift[1]], [shift[2], 0, -shift[0]], [-shift[1], shift[0], 0]])
    to_plane_a, to_plane_b = (
        np.diag([1 / focal_px(camera), 1 / focal_px(camera), 1.0])
        for camera in (camera_a, camera_b)
    )
    matrix = to_plane_b @ cross @ b_from_a @ to_plane_a
    return matrix / np.linalg.norm(matrix)


def lines(matrix, xy):
    """Return the epipolar lines (..., 3) of straight pixels (..., 2), with a unit normal.

    Parameters
    ----------
    matrix : (3, 3) float
        Of `fundamental`; transposed for lines in the first camera.
    xy : (..., 2) float
        Straight px of the other camera.

    Returns
    -------
    lines : (..., 3) float
        `line @ (x, y, 1)` is the signed distance of a straight pixel, px.
    """
    line = xy @ matrix[:, :2].T + matrix[:, 2]
    return line / (np.hypot(line[..., 0], line[..., 1]) + TINY)[..., None]


def distance_px(matrix, xy_a, xy_b):
    """Return by how much two straight pixels miss one another, with a sign, px.

    Parameters
    ----------
    matrix : (3, 3) float
        Of `fundamental`.
    xy_a, xy_b : (..., 2) float
        Straight px; NaN where missing.

    Returns
    -------
    distance_px : (...) float
        To first order the least movement of both pixels together that lets their rays meet; its
        standard deviation is the one of a coordinate where both pixels have equal noise.

    Notes
    -----
    Sampson's distance: Hartley & Zisserman 2004, sec. 11.4.3.
    """
    in_b = xy_a @ matrix[:, :2].T + matrix[:, 2]
    in_a = xy_b @ matrix[:2, :2] + matrix[2, :2]
    algebraic = xy_b[..., 0] * in_b[..., 0] + xy_b[..., 1] * in_b[..., 1] + in_b[..., 2]
    squares = in_b[..., 0] ** 2 + in_b[..., 1] ** 2 + in_a[..., 0] ** 2 + in_a[..., 1] ** 2
    return algebraic / np.sqrt(squares + TINY**2)
