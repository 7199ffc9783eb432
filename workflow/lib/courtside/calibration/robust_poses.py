"""Poses of cameras by RANSAC (Fischler & Bolles 1981) from points on their z = 1 planes.

Relative poses of two cameras by the essential matrix (Nistér 2004), poses by points at known places
(SQPnP, Terzakis & Lourakis 2020), which raises an error where they are nearly one view, or on a
line: any pose fits them, and none is returned.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.geometry import rotations

CONFIDENCE, ROUNDS = 0.9999, 2000
IDEAL = np.eye(3)  # the camera matrix of points on the z = 1 plane


def essential(one: NDArray, other: NDArray, limit: float) -> tuple[NDArray, NDArray] | None:
    """Return the essential matrix (3, 3) of points (N, 2) of two cameras, and inliers (N,) bool.

    `limit` is the largest distance of an inlier from its epipolar line. None if no matrix is found.
    """
    matrix, inside = cv2.findEssentialMat(
        one, other, IDEAL, method=cv2.RANSAC, prob=CONFIDENCE, threshold=limit, maxIters=ROUNDS
    )
    return None if matrix is None else (matrix[:3], inside.ravel().astype(bool))


def relative(matrix: NDArray, one: NDArray, other: NDArray) -> tuple[NDArray, float]:
    """Return the pose (3, 4) of an essential matrix, and the share of points before both cameras.

    It leads from the first camera's axes to the second's; its shift has length 1.
    """
    _, rotation, shift, front = cv2.recoverPose(matrix, one, other, IDEAL)
    return np.column_stack([rotation, shift]), float((front > 0).mean())


def resected(
    xyz: NDArray, rays: NDArray, limit: float, least_in_front: float
) -> tuple[int, NDArray] | None:
    """Return how many points (N, 3) agree with their views (N, 2), and the pose (3, 4).

    None if no pose is found, or if a smaller share than `least_in_front` is in front of it.
    """
    try:
        fine, vector, shift, near = cv2.solvePnPRansac(
            xyz, rays, IDEAL, None, iterationsCount=ROUNDS, confidence=CONFIDENCE,
            reprojectionError=limit, flags=cv2.SOLVEPNP_SQPNP,
        )  # fmt: skip
    except cv2.error:
        return None
    if not fine or near is None:
        return None
    pose = np.column_stack([rotations.rotation_from_rodrigues(vector.ravel()), shift])
    depth = xyz[near[:, 0]] @ pose[2, :3] + pose[2, 3]
    return (len(near), pose) if (depth > 0).mean() >= least_in_front else None


def placed(
    xyz: NDArray,
    xy: NDArray,
    matrix: NDArray,
    dist: NDArray | None,
    method: int = cv2.SOLVEPNP_SQPNP,
) -> list[NDArray]:
    """Return the poses (3, 4) by all points (N, 3) and their views (N, 2), px of such a lens.

    Several fit points in one plane; none is found where any pose fits.
    """
    try:
        count, turns, shifts, _ = cv2.solvePnPGeneric(xyz, xy, matrix, dist, flags=method)
    except cv2.error:
        return []
    return [
        np.column_stack([rotations.rotation_from_rodrigues(turns[at].ravel()), shifts[at].ravel()])
        for at in range(count)
    ]
