"""Places of cameras from exact lines, with the floor's frame known."""

import numpy as np
import pytest

from courtside.calibration.court import line_edges
from courtside.calibration.court_lines import placements, views
from courtside.calibration.court_lines.floor_frames import FloorFrame
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures

CENTRES = [(3.4, -9.0, 3.2), (-5.5, -4.0, 3.0)]


@pytest.mark.parametrize("centre", CENTRES)
def test_the_right_place_is_among_those_found(court, centre):
    camera = court_pictures.looking("one", centre, (3.1, 6.0, 0.1), dist=(0, 0, 0, 0, 0))
    _, ends = line_edges.stretches(court, 20.0)
    pieces = (cameras.project(camera, ends) - camera.K[:2, 2]).reshape(-1, 4)
    pieces = pieces[np.isfinite(pieces).all(axis=1)]
    frame = FloorFrame(900.0, camera.cam_from_world[:, :3].T)
    found = views.join(placements.find(frame, pieces, court, 960, 0.0, camera.K[:2, 2]))
    assert np.linalg.norm(found.centre - centre, axis=1).min() < 0.1
    assert (found.centre[:, 2] > 0.5).all()


def test_without_lines_there_is_no_place(court):
    camera = court_pictures.pair()[0]
    frame = FloorFrame(900.0, camera.cam_from_world[:, :3].T)
    assert placements.find(frame, np.zeros((0, 4)), court, 960, 0.0, np.zeros(2)) == []
