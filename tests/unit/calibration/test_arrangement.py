"""Errors of how cameras stand to each other: against draws, and none of a similarity itself."""

from itertools import combinations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.calibration import arrangement
from courtside.calibration.records.covariance import PARAMETERS, CameraCovariance
from courtside.geometry import similarity
from fixtures.cameras import scene

SIGMA = np.array([1e-3, 2e-3, 1e-3, 4e-3, 6e-3, 3e-3] + [0.0] * 8)  # rad, m, lens


def poses(cameras, step):
    """Return rotations and centres of cameras that are moved by a step of their parameters."""
    turns, centres = [], []
    for camera, own in zip(cameras, step.reshape(len(cameras), -1), strict=True):
        pose = Rotation.from_rotvec(own[:3]).as_matrix() @ camera.cam_from_world
        pose[:, 3] += own[3:6]
        turns.append(pose[:, :3])
        centres.append(-pose[:, :3].T @ pose[:, 3])
    return np.array(turns), np.array(centres)


def left(cameras, step):
    """Return squared errors of centres after the best similarity, and of angles (rad), means."""
    turns, centres = poses(cameras, np.zeros_like(step))
    moved_turns, moved = poses(cameras, step)
    off = similarity.umeyama(moved, centres).points(moved) - centres if len(cameras) > 2 else 0.0
    angles = [
        Rotation.from_matrix(
            turns[a] @ turns[b].T @ (moved_turns[a] @ moved_turns[b].T).T
        ).magnitude()
        for a, b in combinations(range(len(cameras)), 2)
    ]
    return np.sum(np.square(off)) / len(cameras), np.mean(np.square(angles))


def extent(cameras):
    _, centres = poses(cameras, np.zeros(len(cameras) * len(PARAMETERS)))
    return max(np.linalg.norm(a - b) for a, b in combinations(centres, 2))


@pytest.mark.parametrize("count", [2, 3, 5])
def test_errors_are_those_of_drawn_cameras(count):
    cameras, rng = scene.ring(count), np.random.default_rng(0)
    sigma = np.tile(SIGMA, count) * rng.uniform(0.5, 2, count * len(SIGMA))
    found = arrangement.expected(
        cameras, CameraCovariance([c.name for c in cameras], np.diag(sigma**2))
    )
    drawn = np.mean([left(cameras, rng.normal(0, sigma)) for _ in range(2000)], axis=0)
    place, angle = np.sqrt(drawn)
    assert found["expected_angle_deg"] == pytest.approx(np.degrees(angle), rel=0.03)
    if count == 2:
        assert "expected_extent_percent" not in found
    else:
        share = 100 * place / extent(cameras)
        assert found["expected_extent_percent"] == pytest.approx(share, rel=0.03)


def test_a_similarity_of_all_cameras_is_no_error():
    cameras = scene.ring(4)
    rows = []
    for camera in cameras:
        turn, shift = camera.cam_from_world[:, :3], camera.cam_from_world[:, 3]
        centre = -turn.T @ shift
        spins = -turn, turn @ np.cross(centre, np.eye(3)).T  # of the world about its origin
        grow = np.zeros(3), -turn @ centre
        move = np.zeros((3, 3)), -turn
        each = [np.vstack([a.reshape(3, -1), b.reshape(3, -1)]) for a, b in (spins, grow, move)]
        rows.append(np.vstack([np.hstack(each), np.zeros((8, 7))]))
    causes = np.vstack(rows)
    covariance = CameraCovariance([c.name for c in cameras], 1e-4 * causes @ causes.T)
    found = arrangement.expected(cameras, covariance)
    assert found == pytest.approx(dict.fromkeys(found, 0.0), abs=1e-4)


def test_one_camera_stands_to_no_other():
    (camera,) = scene.ring(1)
    assert arrangement.expected([camera], CameraCovariance(["c0"], np.eye(len(PARAMETERS)))) == {}
