"""A simulated wand: its length and box, and what cameras see of it."""

import numpy as np
import pytest

from courtside.geometry import camera as cameras
from fixtures.cameras import corner_cameras
from virtualgym.devices import wand

RIG = corner_cameras.four_cameras()
BOX = np.array([-2.0, -2, 0.3]), np.array([2.0, 2, 2.2])


def swung():
    rng = np.random.default_rng(1)
    return wand.swing([0.0, 0.2, 0.6], *BOX, seconds=40, rate_hz=10, rng=rng)


def test_markers_keep_their_distances_and_fill_the_box():
    xyz = swung()
    assert xyz.shape == (400, 3, 3)
    np.testing.assert_allclose(np.linalg.norm(xyz[:, 2] - xyz[:, 0], axis=1), 0.6)
    np.testing.assert_allclose(np.linalg.norm(xyz[:, 1] - xyz[:, 0], axis=1), 0.2)
    middle = xyz.mean(axis=1)
    np.testing.assert_allclose([middle.min(axis=0), middle.max(axis=0)], BOX)
    assert np.linalg.norm(np.diff(middle, axis=0), axis=1).max() < 0.8  # m in 0.1 s


def test_cameras_see_markers_with_noise_gaps_and_wrong_spots():
    xyz, rng = swung(), np.random.default_rng(2)
    xy = wand.film(RIG, xyz, sigma_px=0.5, rate_hz=10, hidden=0.2, misread=0.05, rng=rng)
    off = np.linalg.norm(xy - np.stack([cameras.project(c, xyz) for c in RIG]), axis=-1)
    assert np.isnan(off).mean() == pytest.approx(0.2, abs=0.05)
    assert np.nanmedian(off) == pytest.approx(0.5 * 1.177, rel=0.1)  # of a normal vector in 2D
    assert (off > 5).sum() / np.isfinite(off).sum() == pytest.approx(0.05, abs=0.01)
