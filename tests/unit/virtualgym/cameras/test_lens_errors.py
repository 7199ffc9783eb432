"""Lens errors: what remains after the best fit of all that the calibration estimates."""

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from courtside.geometry import camera as cameras
from virtualgym.cameras import layouts, lens_errors

WIDTH, HEIGHT = 1280, 720
FOCAL_PX = layouts.FOCAL_WIDTHS * WIDTH


def places():
    across, down = (np.linspace(-0.5, 0.5, n) * side for n, side in ((25, WIDTH), (15, HEIGHT)))
    return np.stack(np.meshgrid(across, down), axis=-1).reshape(-1, 2) / FOCAL_PX


def best_fit_px(dist):
    """Return the distances (N,) px from a lens of eight numbers and a rotation fitted to `dist`."""
    seen = places()
    true_px = cameras.distort(dist, seen) * FOCAL_PX

    def residuals(q):
        turned = np.column_stack([seen, np.ones(len(seen))])
        turned = turned @ Rotation.from_rotvec(q[8:]).as_matrix().T
        own = cameras.distort(np.array([*q[4:8], 0.0]), turned[:, :2] / turned[:, 2:])
        focal = FOCAL_PX * (1 + q[0]) * np.array([1 + q[1], 1.0])
        return (own * focal + q[2:4] - true_px).ravel()

    scale = [1e-3, 1e-3, 1, 1, 1e-2, 1e-2, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3]
    start = np.array([0, 0, 0, 0, *layouts.LENS[:4], 0, 0, 0])
    found = least_squares(residuals, start, x_scale=scale)
    return np.hypot(*residuals(found.x).reshape(-1, 2).T)


def added(strength, seed=0):
    return lens_errors.added(layouts.LENS, strength, np.random.default_rng(seed))


def test_a_lens_is_as_it_was_without_errors():
    assert added(0.0) is layouts.LENS
    assert best_fit_px(layouts.LENS).max() < 1e-6


@pytest.mark.parametrize("seed", range(3))
def test_the_calibrations_lens_leaves_as_much_as_is_stated(seed):
    once, twice = best_fit_px(added(1.0, seed)), best_fit_px(added(2.0, seed))
    assert np.sqrt((once**2).mean()) == pytest.approx(0.145, abs=0.03)
    assert 0.5 < once.max() < 1.2
    assert np.sqrt((twice**2).mean()) == pytest.approx(2 * np.sqrt((once**2).mean()), rel=0.2)
