"""Expected errors of how cameras stand to each other, where scale and frame are arbitrary."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.records.covariance import PARAMETERS, CameraCovariance
from courtside.geometry.camera import Camera

OF_POSE = 6  # of a pose: its place, and its rotation in axes of the world


def expected(cameras: Sequence[Camera], covariance: CameraCovariance) -> dict[str, float]:
    """Return for a JSON file what similarities leave of the expected errors of cameras, rms.

    `expected_extent_percent`: of their centres after the best similarity, as a share of the largest
    distance between two; not of two cameras, whose centres any similarity brings together.
    `expected_angle_deg`: of the rotation between two cameras. Empty for one camera.
    """
    if len(cameras) < 2:
        return {}
    centres = np.array([camera.centre_in_world for camera in cameras])
    by_pose = _by_pose(cameras)
    errors = by_pose @ covariance.covariance @ by_pose.T
    found = {"expected_angle_deg": _rounded(np.degrees(_between(errors, len(cameras))))}
    if len(cameras) > 2:
        extent = max(np.linalg.norm(one - other) for one, other in combinations(centres, 2))
        left = _without_similarity(centres)
        places = errors.reshape(len(cameras), OF_POSE, len(cameras), OF_POSE)[:, :3, :, :3]
        spread = left @ places.reshape(left.shape) @ left.T
        error = np.sqrt(max(np.trace(spread) / len(cameras), 0.0))
        found |= {"expected_extent_percent": _rounded(100 * error / extent)}
    return found


def _by_pose(cameras: Sequence[Camera]) -> NDArray:
    """Return the derivatives of places and rotations by the covariance's parameters.

    The rotation of a camera is about its own centre, which it does not move.
    """
    size = len(PARAMETERS)
    found = np.zeros((OF_POSE * len(cameras), size * len(cameras)))
    for at, camera in enumerate(cameras):
        back = camera.cam_from_world[:, :3].T
        row, column = OF_POSE * at, size * at
        found[row : row + 3, column + 3 : column + 6] = -back
        found[row + 3 : row + 6, column : column + 3] = back
    return found


def _without_similarity(centres: NDArray) -> NDArray:
    """Return what takes the best small similarity out of moves of centres (C, 3), (3 C, 3 C)."""
    arms = centres - centres.mean(axis=0)
    moves = [np.hstack([np.eye(3), np.cross(np.eye(3), arm), arm[:, None]]) for arm in arms]
    similarities = np.vstack(moves)
    return np.eye(len(similarities)) - similarities @ np.linalg.pinv(similarities)


def _between(errors: NDArray, n_cameras: int) -> float:
    """Return the error of the rotation between two cameras, rad, rms of all pairs."""
    each = errors.reshape(n_cameras, OF_POSE, n_cameras, OF_POSE)[:, 3:, :, 3:]
    traces = np.trace(each, axis1=1, axis2=3)
    pairs = list(combinations(range(n_cameras), 2))
    squares = [traces[a, a] + traces[b, b] - 2 * traces[a, b] for a, b in pairs]
    return float(np.sqrt(max(np.mean(squares), 0.0)))


def _rounded(value: float) -> float:
    return round(float(value), 4)
