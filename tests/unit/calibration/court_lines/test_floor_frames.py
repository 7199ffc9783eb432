"""Floor frames of exact straight pieces of a court's lines."""

import numpy as np
import pytest

from courtside.calibration.court import line_edges
from courtside.calibration.court_lines import floor_frames
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures


def pieces(camera, court):
    """Return the ends of a court's lines (N, 4) px from the principal point."""
    _, ends = line_edges.stretches(court, 2.0)
    xy = cameras.project(camera, ends) - camera.K[:2, 2]
    return xy.reshape(-1, 4)


@pytest.mark.parametrize("dist", [(0, 0, 0, 0, 0)])
@pytest.mark.parametrize("centre", [(3.4, -9.0, 3.2), (-5.5, -4.0, 3.0)])
def test_the_floor_is_found_at_the_focal_length_that_is_right(court, centre, dist):
    camera = court_pictures.looking("one", centre, (3.1, 6.0, 0.1), dist=dist)
    ends = pieces(camera, court)
    far = np.random.default_rng(0).uniform(-400, 400, (15, 4))  # other things
    found = floor_frames.find(np.vstack([ends, far]), 960, np.random.default_rng(1))
    off = []
    for frame in found:
        assert np.linalg.det(frame.axes) == pytest.approx(1)
        turn = np.abs(frame.axes @ camera.cam_from_world[:, :3])
        angle = np.rad2deg(np.arccos(min(turn[2, 2], 1)))
        off.append((abs(np.log(frame.f_px / 900)), angle))
    assert min(angle for zoom, angle in off if zoom < 0.07) < 1.0


def test_too_few_pieces_give_nothing():
    assert floor_frames.find(np.ones((3, 4)), 960, np.random.default_rng(0)) == []
