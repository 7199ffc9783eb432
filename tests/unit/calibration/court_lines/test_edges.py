"""Stretches of lines measured in drawn pictures: where they are drawn, and none where none are."""

from dataclasses import replace

import numpy as np

from courtside.calibration.click_proposals.proposals import Registered
from courtside.calibration.court_lines import edges
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures

CAMERA = court_pictures.pair()[1]


def test_edges_are_where_lines_are_drawn_though_the_camera_is_a_few_px_off(court):
    image = court_pictures.draw(CAMERA, court, noise=2, seed=1)
    matrix = CAMERA.K.copy()
    matrix[:2, 2] += [2.5, -1.5]
    seen, reason = edges.measure(replace(CAMERA, K=matrix), image, court, search_px=6.0)
    assert not reason and len(seen.line) > 60 and set(seen.line) == set(range(len(court.lines_m)))
    exact = cameras.project(CAMERA, seen.xyz)
    off = np.sum((seen.xy - exact) * seen.normal, axis=1)
    assert np.sqrt(np.mean(off**2)) < 0.2 and abs(off.mean()) < 0.05
    towards = cameras.project(CAMERA, seen.xyz + 0.01 * seen.across) - exact
    assert (np.sum(towards * seen.normal, axis=1) > 0).all()
    assert (seen.sigma_px > 0).all()


def test_a_picture_without_lines_gives_a_reason(court):
    image = court_pictures.draw(CAMERA, replace(court, lines_m=court.lines_m[:1], net=None))
    seen, reason = edges.measure(CAMERA, image, court, search_px=6.0)
    assert seen is None and "too few painted lines" in reason


def test_lines_that_are_not_seen_once_the_camera_is_moved_give_a_reason(court, monkeypatch):
    width, height = CAMERA.size
    monkeypatch.setattr(edges.proposals, "register", lambda view, _: Registered(view))
    image = np.full((height, width, 3), 100, dtype=np.uint8)
    seen, reason = edges.measure(CAMERA, image, court, search_px=6.0)
    assert seen is None and reason.startswith("no painted line is seen")
