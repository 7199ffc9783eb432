"""Adjust a camera slightly so that the projected court lines match those in the picture."""

from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.geometry import rotations
from courtside.geometry.camera import Camera, project

# ASSUME: how far a roughly known camera is off, standard deviation: of its rotation (3, rad),
# centre (3, m), relative focal length, and k1.
PRIOR_SIGMA = np.array([0.01] * 3 + [0.15] * 3 + [0.01] + [0.01])
FLOOR_PX = 0.3  # ASSUME: painted lines are some mm from where the court's model has them


def moved(camera: Camera, change: NDArray) -> Camera:
    """Return a camera rotated, moved, zoomed and with another k1.

    `change` (8,) is the rotation about its own axes (rad), the shift of its centre along them (m),
    the natural logarithm of the relative focal length, and what is added to k1.
    """
    turn = rotations.rotation_from_rodrigues(change[:3])
    rotation = turn @ camera.cam_from_world[:, :3]
    shift = turn @ (camera.cam_from_world[:, 3] - change[3:6])
    K = camera.K.copy()
    K[[0, 1], [0, 1]] *= np.exp(change[6])
    dist = camera.dist.copy()
    dist[0] += change[7]
    return replace(camera, K=K, dist=dist, cam_from_world=np.column_stack([rotation, shift]))


def refine(
    camera: Camera, xyz: NDArray, normal: NDArray, offset_px: NDArray, sigma_px: NDArray
) -> Camera:
    """Adjust a camera so that points on lines shift across these lines by the measured offsets.

    The given camera is the start and the prior. The points `xyz` (M, 3) m lie on lines, `normal`
    (M, 2) is across these in the picture, of unit length. `offset_px` (M,) is along the normal,
    from where the camera expects the line to where it is seen, with a standard deviation of
    `sigma_px` (M,).
    """
    sigma = np.hypot(sigma_px, FLOOR_PX)

    def residuals(scaled: NDArray) -> NDArray:
        rest = offset_px - shifts(camera, moved(camera, scaled * PRIOR_SIGMA), xyz, normal)
        return np.concatenate([np.nan_to_num(rest, nan=1e3) / sigma, scaled])

    found = scipy.optimize.least_squares(
        residuals, np.zeros(len(PRIOR_SIGMA)), loss="cauchy", f_scale=2.0, x_scale=1.0
    )
    return moved(camera, found.x * PRIOR_SIGMA)


def shifts(camera: Camera, other: Camera, xyz: NDArray, normal: NDArray) -> NDArray:
    """Return how far points (M, 3) m shift along `normal` (M, 2) from a camera to another, px."""
    return np.sum((project(other, xyz) - project(camera, xyz)) * normal, axis=1)
