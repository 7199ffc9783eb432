"""Epipolar geometry of two calibrated cameras.

A straight pixel is what a lens without distortion would show, px about the principal point.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry.camera import Camera, undistort
from courtside.geometry.rotations import cross_matrices, unit

TINY = 1e-12  # keeps divisions finite; far below any distance in px


def straight_px(camera: Camera, xy: ArrayLike) -> NDArray:
    """Return the straight px (..., 2) of distorted px (..., 2), NaN where missing."""
    return undistort(camera, xy) * focal_px(camera)


def focal_px(camera: Camera) -> float:
    """Return the mean of a camera's two focal lengths, px."""
    return (camera.K[0, 0] + camera.K[1, 1]) / 2


def relative_pose(camera_a: Camera, camera_b: Camera) -> tuple[NDArray, NDArray]:
    """Return rotation (3, 3) and shift (3,) from the first camera's axes to the second's."""
    rotation = camera_b.cam_from_world[:, :3] @ camera_a.cam_from_world[:, :3].T
    return rotation, camera_b.cam_from_world[:, 3] - rotation @ camera_a.cam_from_world[:, 3]


def fundamental(camera_a: Camera, camera_b: Camera) -> NDArray:
    """Return the fundamental matrix (3, 3) for homogeneous straight px (x, y, 1): `b' F a = 0`.

    Hartley & Zisserman 2004, sec. 9.6.
    """
    b_from_a, shift = relative_pose(camera_a, camera_b)
    to_plane_a, to_plane_b = (
        np.diag([1 / focal_px(camera), 1 / focal_px(camera), 1.0])
        for camera in (camera_a, camera_b)
    )
    matrix = to_plane_b @ cross_matrices(shift) @ b_from_a @ to_plane_a
    return matrix / np.linalg.norm(matrix)


def ray_sines(rotation: NDArray, xy_a: NDArray, xy_b: NDArray) -> NDArray:
    """Return the sines (N,) of the angles between the rays of two cameras.

    Points (N, 2) are on the z = 1 planes; `rotation` leads from the first camera's axes to the
    second's.
    """
    first, second = (unit(np.pad(xy, ((0, 0), (0, 1)), constant_values=1.0)) for xy in (xy_a, xy_b))
    return np.linalg.norm(np.cross(first @ rotation.T, second), axis=1)


def lines(matrix: NDArray, xy: NDArray) -> NDArray:
    """Return the epipolar lines (..., 3) of straight px (..., 2) of the other camera.

    `matrix` is of `fundamental`; transpose it for lines in the first camera. Normals have length 1:
    `line @ (x, y, 1)` is the signed distance of a straight pixel, px.
    """
    line = xy @ matrix[:, :2].T + matrix[:, 2]
    return line / (np.hypot(line[..., 0], line[..., 1]) + TINY)[..., None]


def distance_px(matrix: NDArray, xy_a: NDArray, xy_b: NDArray) -> NDArray:
    """Return the signed Sampson distance (...) of two straight px (..., 2), px; NaN where missing.

    To first order the least movement of both pixels together that lets their rays meet. Its
    standard deviation is that of one coordinate if both pixels have equal noise.

    Hartley & Zisserman 2004, sec. 11.4.3.
    """
    in_b = xy_a @ matrix[:, :2].T + matrix[:, 2]
    in_a = xy_b @ matrix[:2, :2] + matrix[2, :2]
    algebraic = xy_b[..., 0] * in_b[..., 0] + xy_b[..., 1] * in_b[..., 1] + in_b[..., 2]
    squares = in_b[..., 0] ** 2 + in_b[..., 1] ** 2 + in_a[..., 0] ** 2 + in_a[..., 1] ** 2
    return algebraic / np.sqrt(squares + TINY**2)
