"""Cameras found in drawn pictures of a court, with nothing known of them."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.click_proposals import proposals
from courtside.calibration.court_lines import floor_frames, search, verdict, views
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures


@pytest.mark.parametrize("view", [0, 1])
def test_the_camera_is_found_without_a_click(few, court, view):
    camera = court_pictures.pair()[view]
    found = search.find(court_pictures.draw(camera, court, noise=3, seed=view), court)
    best = found.candidates[0]
    floor = court.xyz[court.xyz[:, 2] == 0]
    exact = cameras.project(camera, floor)
    ways = best.view, views.half_turned(best.view, court)
    off = [np.linalg.norm(way.project(floor[:, :2])[0] - exact, axis=1) for way in ways]
    assert min(np.median(way) for way in off) < 1.0
    assert best.score > 4 * search.LEAST_SCORE and np.nanmin(best.lines) > 0.3
    assert all(one.score < 0.8 * best.score for one in found.candidates[1:])
    assert abs(best.view.centre[0, 2] - camera.centre_in_world[2]) < 0.15


def test_a_wide_lens_is_found(few, court, monkeypatch):
    """The lens is of a real hall camera: 23 % barrel in the corners, by k1 and k2."""
    monkeypatch.setattr(floor_frames, "FOCAL_WIDTHS", np.array([0.5, 0.565]))
    lens = {"f": 510.0, "dist": (-0.325, 0.106, 0, 0, 0)}
    camera = court_pictures.looking("wide", (-4.0, 3.0, 4.5), (3.0, 6.0, 0.0), **lens)
    found = search.find(court_pictures.draw(camera, court, noise=3), court)
    floor = court.xyz[court.xyz[:, 2] == 0]
    exact = cameras.project(camera, floor)
    ways = found.candidates[0].view, views.half_turned(found.candidates[0].view, court)
    off = [np.linalg.norm(way.project(floor[:, :2])[0] - exact, axis=1) for way in ways]
    assert min(np.median(way) for way in off) < 0.5
    assert search.fault(found.candidates[0], court) == ""


def test_lenses_are_tried_until_one_is_accepted_and_all_of_them_twice(court, monkeypatch):
    """A high score is not enough: the lines of the court have to be seen."""
    tried, view = [], court_pictures.view_of(court_pictures.pair()[0])
    seen, accepted = np.ones(len(court.lines_m)), (search.BARREL[1], 1)

    def of_lens(fields, court, barrel, seed):
        tried.append((barrel, seed))
        lines = seen if tried[-1] == accepted else 0.1 * seen
        return [search.Candidate(view, 5 * search.LEAST_SCORE + len(tried), lines)]

    monkeypatch.setattr(search, "_of_lens", of_lens)
    monkeypatch.setattr(search, "_different", lambda found, *_: found[::-1])
    found = search.find(np.full((540, 960, 3), 120, np.uint8), court)
    first_round = [(barrel, 0) for barrel in search.BARREL]
    assert tried == [*first_round, (search.BARREL[0], 1), accepted]
    assert search.fault(found.candidates[0], court) == ""


def test_a_court_without_lines_is_not_searched_for(court):
    camera, bare = court_pictures.pair()[0], replace(court, lines_m=np.zeros((0, 4)))
    image = court_pictures.draw(camera, court)
    limits = {"search_share": 0.006, "max_sigma_px": 1.0}
    judged, proposed = verdict.examine(image, bare, "a", lines="light", **limits)
    assert (judged.outcome, judged.reason) == (verdict.NOT_FOUND, proposals.NO_LINES)
    assert np.isnan(proposed.xy).all()
    assert set(proposals.propose(camera, image, bare, search_px=6.0).reason) == {proposals.NO_LINES}


def test_a_picture_without_lines_has_no_candidates(few, court):
    image = np.full((540, 960, 3), 120, np.uint8)
    assert search.find(image, court).candidates == []


def test_large_pictures_are_made_smaller(few, court):
    found = search.find(np.full((300, 2400, 3), 120, np.uint8), court)
    assert found.image.shape[1] == search.WIDEST_PX and found.scale == 1.5
