"""The field of a turning camera's picture: fitted to points that a lens projects, among wrong ones."""

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.video import camera_movement
from fixtures.recordings.turned_pictures import CENTRE, DIST, SIZE, K, true_movement, undistorted

HALF = SIZE[0] / 2
VECTORS = np.array([[0.001, -0.0012, 0.0005], [0.006, 0.007, -0.004], [0, 0, 0.02]])


def tracked(vector, sigma_px, n_wrong=0, seed=0, n=220):
    """Return places, movements in px by OpenCV's projection, with noise; the first `n_wrong` on a walker."""
    rng = np.random.default_rng(seed)
    xy = rng.uniform([20, 20], np.array(SIZE) - 20, (n, 2))
    seen = undistorted(xy)
    rotated = np.column_stack([seen, np.ones(n)]) @ Rotation.from_rotvec(vector).as_matrix().T
    after = cv2.projectPoints(rotated[:, None], np.zeros(3), np.zeros(3), K, DIST)[0][:, 0]
    by = after - xy + rng.normal(0, sigma_px, (n, 2))
    by[:n_wrong] = rng.normal([-3.0, 1.0], 1, (n_wrong, 2))
    return (xy - CENTRE) / HALF, by


@pytest.mark.parametrize("vector", VECTORS)
def test_a_turn_is_found_among_wrong_points(vector):
    places, by = tracked(vector, sigma_px=0.2, n_wrong=60)
    found = camera_movement.fit_turn(places, by, SIZE[::-1], len(places))
    shift, turn = true_movement(vector)
    assert found.known and 120 < found.n_matches <= 170
    np.testing.assert_allclose(found.model[:2] * HALF, shift, atol=0.08)
    linear = complex(1 + found.model[2], found.model[3])
    assert np.degrees(np.angle(linear)) == pytest.approx(turn, abs=0.01)


def test_the_stated_sigma_is_the_scatter():
    off = []
    for seed in range(60):
        places, by = tracked(VECTORS[0], sigma_px=0.2, n_wrong=30, seed=seed)
        found = camera_movement.fit_turn(places, by, SIZE[::-1], len(places))
        off.append((found.model[:2] * HALF - true_movement(VECTORS[0])[0]) / (found.sigma * HALF))
    assert 0.75 < np.sqrt(np.mean(np.square(off))) < 1.3


def test_the_derivative_is_that_of_the_field():
    places, model = tracked(VECTORS[0], 0)[0], np.array([0.01, -0.02, 0.003, 0.004, -0.05, 0.4])
    step = 1e-6
    numeric = [
        (camera_movement.moved(places, model + row) - camera_movement.moved(places, model - row))
        / (2 * step)
        for row in step * np.eye(6)
    ]
    np.testing.assert_allclose(
        camera_movement._jacobian(places, model), np.moveaxis(numeric, 0, -1), atol=1e-8
    )


def test_too_few_or_bunched_points_tell_nothing():
    places, by = tracked(VECTORS[0], 0.1)
    bunched = 0.05 * places + [0.5, 0.2]
    assert not camera_movement.fit_turn(bunched, by, SIZE[::-1], len(places)).known
    assert not camera_movement.fit_turn(places[:15], by[:15], SIZE[::-1], 15).known
    assert not camera_movement.fit_turn(places[:40], by[:40], SIZE[::-1], 300).known
    scattered = np.random.default_rng(5).uniform(-40, 40, by.shape)
    assert not camera_movement.fit_turn(places, scattered, SIZE[::-1], len(places)).known
