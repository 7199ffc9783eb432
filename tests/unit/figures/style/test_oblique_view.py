"""The oblique drawing is a parallel projection to scale, and shows the court's own lines."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from courtside.calibration.court import court
from courtside.figures.style import oblique_view
from fixtures.cameras import scene

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")


def test_known_directions_of_sight():
    points = np.eye(3)
    from_the_front = oblique_view.Sight(azimuth_deg=-90, elevation_deg=0).seen(points)
    np.testing.assert_allclose(from_the_front, [[1, 0], [0, 0], [0, 1]], atol=1e-12)
    from_above = oblique_view.Sight(azimuth_deg=-90, elevation_deg=90).seen(points)
    np.testing.assert_allclose(from_above, [[1, 0], [0, 1], [0, 0]], atol=1e-12)


def test_lengths_across_the_sight_are_true_and_along_it_vanish():
    sight = oblique_view.Sight(azimuth_deg=-50, elevation_deg=30)
    azimuth, elevation = np.radians([-50, 30])
    towards = np.array(
        [
            np.cos(azimuth) * np.cos(elevation),
            np.sin(azimuth) * np.cos(elevation),
            np.sin(elevation),
        ]
    )
    np.testing.assert_allclose(sight.seen(towards), 0, atol=1e-12)
    across = np.cross(towards, [0, 0, 1.0])
    assert np.linalg.norm(sight.seen(across)) == pytest.approx(np.linalg.norm(across))
    assert sight.seen([0, 0, 1.0])[1] == pytest.approx(np.cos(elevation))


def test_the_courts_lines_are_drawn_at_their_middles():
    axis, sight = Figure().subplots(), oblique_view.Sight(azimuth_deg=-90, elevation_deg=90)
    oblique_view.floor(axis, sight, (0, 0), COURT.size_m, COURT)
    lines = [line.get_xydata() for line in axis.lines][1:]
    assert len(lines) == len(COURT.lines_m)
    drawn = sorted(np.mean(line, axis=0).round(6).tolist() for line in lines)
    middles = sorted(
        [round((x0 + x1) / 2, 6), round((y0 + y1) / 2, 6)] for x0, y0, x1, y1 in COURT.lines_m
    )
    np.testing.assert_allclose(drawn, middles)
    longest = max(np.ptp(line, axis=0).max() for line in lines)
    assert longest == pytest.approx(max(COURT.size_m))


def test_only_lines_in_the_part_are_drawn_and_none_beyond_it():
    axis, sight = Figure().subplots(), oblique_view.Sight(azimuth_deg=-90, elevation_deg=90)
    oblique_view.floor(axis, sight, (0.5, 0.5), (3.5, 3.0), COURT)
    places = np.concatenate([line.get_xydata() for line in axis.lines])
    assert (places >= 0.5 - 1e-9).all() and (places <= [3.5 + 1e-9, 3 + 1e-9]).all()
    assert 1 < len(axis.lines) < len(COURT.lines_m)


def test_without_a_court_there_is_a_grid_of_a_metre():
    axis, sight = Figure().subplots(), oblique_view.Sight(azimuth_deg=-90, elevation_deg=90)
    oblique_view.floor(axis, sight, (-0.5, 0.2), (1.5, 1.2))
    xs = [line.get_xdata()[0] for line in axis.lines[1:] if np.ptp(line.get_xdata()) < 1e-9]
    np.testing.assert_allclose(xs, [0, 1], atol=1e-12)


def test_a_camera_stands_at_its_centre_and_opens_where_it_looks():
    camera = scene.ring(1)[0]
    axis, sight = Figure().subplots(), oblique_view.Sight(azimuth_deg=-90, elevation_deg=90)
    oblique_view.camera(axis, sight, camera, 2.0)
    np.testing.assert_allclose(axis.lines[0].get_xydata()[0], camera.centre_in_world[:2])
    middle = axis.lines[-1].get_xydata()[:4].mean(axis=0)
    ahead = camera.centre_in_world + 2.0 * camera.cam_from_world[2, :3]
    np.testing.assert_allclose(middle, ahead[:2], atol=2e-3)  # the middle pixel is half a pixel off
    assert axis.texts[0].get_text() == camera.name


def test_limits_hold_every_known_point():
    low, high = oblique_view.limits([[0.1, 0.4, 1.9], [1.1, -0.6, 0.0], [np.nan] * 3])
    np.testing.assert_allclose(low, [-0.5, -1.0, -0.5])
    np.testing.assert_allclose(high, [1.5, 1.0, 2.5])
    assert np.isfinite(oblique_view.limits(np.full((2, 3), np.nan))).all()


def test_the_net_has_the_courts_height():
    axis, sight = Figure().subplots(), oblique_view.Sight(azimuth_deg=-90, elevation_deg=0)
    oblique_view.net(axis, sight, COURT)
    assert axis.lines[0].get_ydata().max() == pytest.approx(COURT.net["post_height_m"])
    oblique_view.net(axis, sight, None)
    assert len(axis.lines) == 1
