"""A view measures a stretch of a line as the camera that is off sees it."""

import numpy as np
import pytest

from courtside.calibration.click_proposals import line_profiles, refine_pose
from courtside.calibration.click_proposals.view import View
from courtside.calibration.court import line_edges
from courtside.geometry import camera
from fixtures.cameras import court_pictures


def test_the_shift_is_how_far_the_camera_is_off():
    court = court_pictures.badminton()
    true = court_pictures.pair()[0]
    grey = court_pictures.draw(true, court, noise=2).mean(axis=2).astype(np.float32)
    change = np.array([0.002, -0.0015, 0.004, 0, 0, 0, 0, 0])
    moved = refine_pose.moved(true, change)
    made = View(grey, moved, court, 0.7, 1)
    for line in (1, 4, 8):
        ends, half = line_edges.middle_line(court, line)
        stretch = ends[0] + np.array([[0.3], [0.6]]) * (ends[1] - ends[0])
        origin = stretch.mean(axis=0)
        found = made.shift(line, stretch, origin, 5.0)
        _, normal = line_profiles.tangent_and_normal(moved, origin[None], ends[1] - ends[0], half)
        exact = (camera.project(true, origin) - camera.project(moved, origin)) @ normal[0]
        assert abs(exact) > 0.3
        assert found.low_px == pytest.approx(exact, abs=0.12)


def test_a_line_that_is_out_of_the_picture_has_none():
    court = court_pictures.badminton()
    away = court_pictures.looking("away", (3, -9, 3), (3, -20, 3))
    made = View(np.zeros(away.size[::-1], np.float32), away, court, 0.7, 1)
    ends, _ = line_edges.middle_line(court, 0)
    assert made.shift(0, ends, ends[0], 3.0) is None
