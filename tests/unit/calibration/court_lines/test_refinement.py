"""A camera brought back by the ridges of a drawn picture, and how surely."""

import numpy as np
import pytest

from courtside.calibration.court_lines import evidence, refinement, ridges, views
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures


@pytest.mark.parametrize("seed", range(2))
def test_lines_bring_the_camera_back(court, seen, seed):
    camera, along = court_pictures.pair()[1], views.samples(court, 0.3)
    change = np.random.default_rng(seed).normal(0, 0.3, 8) * refinement.STEPS
    start = refinement.moved(court_pictures.view_of(camera), change)
    found = refinement.refine(seen, start, along)
    floor = court.xyz[court.xyz[:, 2] == 0]
    exact = cameras.project(camera, floor)
    inside = ((exact > 0) & (exact < np.array(camera.size))).all(axis=1)
    before, after = (
        np.linalg.norm(one.project(floor[:, :2])[0] - exact, axis=1)[inside]
        for one in (start, found)
    )
    assert np.median(before) > 2 and np.median(after) < 0.6
    sure = refinement.uncertainty(seen, found, along, np.array([3.05, 6.7, 0]))
    assert abs(np.log(found.f_px[0] / 900)) < 5 * sure.f_share < 0.03
    assert abs(found.centre[0, 2] - 3.0) < 5 * sure.height_m < 0.15
    assert 0 < sure.distance_m < 1


def test_without_ridges_there_is_no_camera(court):
    empty = evidence.fields(ridges.Ridges(np.zeros((540, 960), bool), np.zeros((540, 960))))
    view, along = court_pictures.view_of(court_pictures.pair()[1]), views.samples(court, 0.3)
    assert refinement.refine(empty, view, along) is None
    assert refinement.uncertainty(empty, view, along, np.zeros(3)) is None
