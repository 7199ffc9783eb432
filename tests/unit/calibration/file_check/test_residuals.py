"""Residuals of views: those of least squares, of points left out, of people over time."""

import numpy as np
import pytest

from courtside.calibration.file_check import faults, residuals
from courtside.geometry import camera as cameras
from courtside.geometry import triangulation
from fixtures.cameras import corner_cameras as hall


def test_residuals_are_close_to_those_of_least_squares():
    seen_by = hall.four_cameras()
    xy = hall.seen_points(seen_by, 60, 2.0, seed=0)
    xy[0, :20] = np.nan
    found = residuals.Rays(xy).residuals(seen_by)
    xyz = triangulation.triangulate_all(seen_by, xy)
    exact = np.stack([cameras.project(one, xyz) for one in seen_by]) - xy
    assert np.isnan(found[0, :20]).all() and np.isfinite(found[1:]).all()
    assert residuals.rms_px(found) == pytest.approx(residuals.rms_px(exact), rel=0.02)
    assert residuals.rms_px(exact) == pytest.approx(2 * np.sqrt(1 - 3 / 8), rel=0.15)


def test_perfect_views_have_no_residuals_and_one_view_has_none():
    seen_by = hall.four_cameras()
    xy = hall.seen_points(seen_by, 5, 0.0, seed=1)
    assert residuals.rms_px(residuals.Rays(xy).residuals(seen_by)) < 1e-6
    xy[1:] = np.nan
    assert np.isnan(residuals.Rays(xy).residuals(seen_by)).all()
    assert np.isnan(residuals.rms_px(residuals.Rays(xy).residuals(seen_by)))
    assert np.isnan(residuals.typical_px(residuals.Rays(xy).residuals(seen_by)))


def test_a_point_behind_a_camera_counts_much():
    seen_by = hall.four_cameras()
    xy = hall.seen_points(seen_by, 8, 0.5, seed=2)
    seen_by[0] = faults.turned_picture(seen_by[0], 2)
    seen_by[1] = cameras.turned(seen_by[1], [0, np.pi, 0])
    assert residuals.rms_px(residuals.Rays(xy).residuals(seen_by)) > 100


def test_a_camera_left_out_shows_its_own_shift():
    seen_by = hall.four_cameras()
    xy = hall.seen_points(seen_by, 8, 0.0, seed=3)
    xy[2] += (7.0, -3.0)
    found = residuals.left_out(seen_by, xy)
    np.testing.assert_allclose(found[2], np.broadcast_to((7.0, -3.0), (8, 2)), atol=1e-3)
    assert np.isnan(residuals.left_out(seen_by[:2], xy[:2])).all()


def test_a_typical_residual_does_not_see_outliers():
    away = np.full((3, 100, 2), 2.0)
    away[:, :30] = 400.0
    away[0, 50] = np.nan
    assert residuals.typical_px(away) == pytest.approx(2.0)
    assert residuals.rms_px(away) > 100


def test_joints_are_taken_evenly_over_time():
    views = [np.arange(2 * 50 * 12, dtype=float).reshape(50, 12, 2) for _ in range(3)]
    found = residuals.of_people(views)
    assert found.shape == (3, residuals.MOST_POINTS, 2)
    assert found[0, 0, 0] == 0 and found[0, -1, 0] == 50 * 12 * 2 - 2
    views = [np.full((50, 12, 2), np.nan) for _ in range(3)]
    views[0][:] = 1.0
    assert residuals.of_people(views).shape == (3, 0, 2)


def test_the_height_is_that_of_whole_people():
    view = np.zeros((10, 12, 2))
    view[..., 1] = np.linspace(100, 400, 12)
    view[:3, 5] = np.nan
    assert residuals.height_px([view], np.full((1, 10), 900.0)) == pytest.approx(300)
    nobody = np.full((4, 12, 2), np.nan)
    assert residuals.height_px([nobody], np.full((1, 4), 20.0)) == np.inf


def test_the_height_of_people_whose_feet_are_hidden_is_that_of_standing_people():
    view = np.zeros((10, 12, 2))
    view[:, 10:] = view[7:] = np.nan
    standing_px = np.where(np.arange(10) < 7, 400.0, 20.0)
    assert residuals.height_px([view], standing_px[None]) == pytest.approx(312)
