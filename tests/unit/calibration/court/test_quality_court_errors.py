"""Errors of cameras in the study's terms: known displacements give known numbers."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from scipy.spatial.transform import Rotation

from courtside.calibration.court import court, quality
from fixtures.cameras import scene

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
CAMERAS = scene.ring(3, dist=(-0.05, 0.01, 1e-3, 0, 0))


def test_the_volume_is_a_grid_over_the_court():
    grid = quality.volume(COURT)
    assert grid.shape == (4 * 7 * 5, 3)
    np.testing.assert_allclose(grid.min(axis=0), [0, 0, 0])
    np.testing.assert_allclose(grid.max(axis=0), [6.1, 13.4, 3])
    np.testing.assert_allclose(grid[:6, 0], [0, 1.525, 3.05, 4.575, 6.1, 0])
    np.testing.assert_allclose(grid[[0, 5, 35], 1], [0, 13.4 / 6, 0])
    assert len(np.unique(grid.round(9), axis=0)) == len(grid)
    assert quality.volume(COURT, [0.5], 2, 3)[:, 2].tolist() == [0.5] * 6


def test_published_errors_are_those_of_the_ends_of_x_and_y():
    xyz = COURT.xyz + 0.0
    xyz[1] += [0.03, 0, 0.04]
    xyz[2] += [0, -0.02, 0]
    xyz[7] += 1.0  # no part of it
    found = quality.court_points(COURT, xyz)
    assert found == pytest.approx({"xo_cm": 5.0, "yo_cm": 2.0, "xy_cm": 3.5})


def test_errors_of_cameras_are_means_over_cameras():
    changed = []
    for camera, shift_m, turn_deg, focal in zip(
        CAMERAS, [0.01, 0.02, 0.06], [0.5, 0, 1.0], [1.01, 0.98, 1.0], strict=True
    ):
        turn = Rotation.from_euler("y", turn_deg, degrees=True).as_matrix()
        rotation = turn @ camera.cam_from_world[:, :3]
        centre = camera.centre_in_world + np.array([0, shift_m, 0])
        pose = np.column_stack([rotation, -rotation @ centre])
        K = camera.K * [[focal, 1, 1], [1, focal, 1], [1, 1, 1]]
        changed.append(replace(camera, cam_from_world=pose, K=K))
    found = quality.poses(changed, CAMERAS)
    expected = {"camera_position_cm": 3.0, "camera_rotation_deg": 0.5, "focal_percent": 1.0}
    assert found == pytest.approx(expected, rel=1e-6)


def test_numbers_over_the_volume():
    error = np.zeros((101, 3))
    error[:, 2] = np.arange(101) / 100
    found = quality.over_volume(error)
    assert found["volume_p95_cm"] == pytest.approx(95)
    assert found["volume_rms_cm"] == pytest.approx(np.sqrt((np.arange(101) ** 2).mean()))


def test_coverage_of_gaussian_errors_is_their_level():
    rng = np.random.default_rng(0)
    root = rng.normal(size=(20000, 3, 3)) * 0.01
    covariance = root @ root.transpose(0, 2, 1)
    error = np.einsum("nij,nj->ni", root, rng.normal(size=(20000, 3)))
    found = quality.coverage(error, covariance)
    for level in (50, 90, 95):  # four standard deviations of a share of 20000
        share = level / 100
        assert found[f"coverage{level}"] == pytest.approx(
            share, abs=4 * np.sqrt(share * (1 - share) / 20000)
        )
    expected = 100 * np.sqrt((error**2).sum(axis=1).mean())
    assert found["predicted_volume_cm"] == pytest.approx(expected, rel=0.03)


def test_errors_twice_as_large_as_stated_are_seen():
    error = 0.02 * np.random.default_rng(1).normal(size=(5000, 3))
    found = quality.coverage(error, np.tile(1e-4 * np.eye(3), (5000, 1, 1)))
    share = stats.chi2.cdf(stats.chi2.ppf(0.95, 3) / 4, 3)
    assert found["coverage95"] == pytest.approx(share, abs=4 * np.sqrt(share * (1 - share) / 5000))
    assert share < 0.5
