"""Verdicts on drawn pictures: right ones found, others refused, like ones ambiguous."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from courtside.calibration.court_lines import evidence, ridges, search, verdict, views
from courtside.geometry import camera as cameras
from courtside.records.cameras.click_proposals import EITHER
from fixtures.cameras import court_pictures

CAMERA = court_pictures.pair()[1]


@pytest.fixture(scope="module", autouse=True)
def _one_lens(few):
    few.setattr(search, "BARREL", (0.0,))


def judged(image, court, lines="light"):
    return verdict.judge(search.find(image, court, lines), court, "one", CAMERA.size, lines)


def made(image, court, shifts):
    """Return what a search would give that found the true camera moved by some m along x."""
    seen = evidence.fields(ridges.find(image, "light"))
    view, found = court_pictures.view_of(CAMERA), []
    for shift in shifts:
        moved = replace(view, centre=view.centre + np.array([shift, 0, 0]))
        found.append(search._candidate(seen, court, views.samples(court, 0.3), moved))
    best = sorted(found, key=lambda one: -one.score)
    return search.Found(best, seen, image, 1.0)


def test_the_court_s_points_are_proposed_for_either_end(court):
    image = court_pictures.draw(CAMERA, court, noise=3, seed=5)
    said = judged(image, court)
    assert (said.outcome, said.reason, said.symmetric) == (verdict.FOUND, "", True)
    assert said.rival < verdict.MOST_RIVAL * said.score
    found = verdict.proposed(said, image, court, search_px=6.0)
    given = np.isfinite(found.xy[:, 0])
    assert given.sum() > 11
    turned = np.array([*court.size_m, 0]) + court.xyz * [-1, -1, 1]
    ways = [cameras.project(CAMERA, xyz) for xyz in (court.xyz, turned)]
    error = min(np.nanmax(np.linalg.norm(way - found.xy, axis=1)) for way in ways)
    assert error < 1.5
    assert {found.reason[at] for at in np.flatnonzero(given)} == {EITHER}
    table = verdict.report(said, found)
    assert table["outcome"] == "found" and table["either_end"] is True
    assert abs(table["f_px"] - 900) < 5 * table["f_sigma_px"] < 30
    assert table["n_proposed"] == given.sum()
    assert verdict.in_words(said, found) == f"court found: {given.sum()} of {len(given)} points"
    none = replace(found, xy=found.xy * np.nan, reason=("a misfit",) * len(given))
    assert verdict.in_words(said, none) == "court found: no point is proposed: a misfit"


@pytest.mark.parametrize("what", ["noise", "another court", "one line"])
def test_other_pictures_are_refused(court, what):
    if what == "noise":
        image = np.random.default_rng(0).normal(120, 9, (540, 960, 3)).astype(np.uint8)
    elif what == "another court":
        other = court_files.read(court_pictures.ROOT / "config" / "courts" / "rectangle-10x5.yaml")
        image = court_pictures.draw(CAMERA, other, noise=3)
    else:
        image = court_pictures.draw(CAMERA, replace(court, lines_m=court.lines_m[:1], net=None))
    said = judged(image, court)
    assert said.outcome != verdict.FOUND and said.reason
    found = verdict.proposed(said, image, court, search_px=6.0)
    assert np.isnan(found.xy).all() and said.reason in found.reason[0]
    assert verdict.in_words(said, found) == f"court {said.outcome}: {said.reason}"
    assert (said.outcome == verdict.AMBIGUOUS) or "lines: any" in said.reason
    assert "f_px" not in verdict.report(said, found)


@pytest.mark.parametrize(("colour", "outcome"), [(None, "ambiguous"), ((120, 205, 225), "found")])
def test_like_courts_are_told_apart_by_their_colour(court, colour, outcome, monkeypatch):
    monkeypatch.setattr(court_pictures, "WALL", court_pictures.FLOOR)
    beside = replace(court, lines_m=court.lines_m + np.array([6.8, 0, 6.8, 0]))
    both = replace(court, lines_m=np.concatenate([court.lines_m, beside.lines_m]))
    image = court_pictures.draw(CAMERA, both)
    if colour:
        own = court_pictures.draw(CAMERA, court)
        image = np.where((image == own).all(axis=2, keepdims=True), image, image * 0.7 + 20)
        image = image.astype(np.uint8)
    said = verdict.judge(made(image, court, (0.0, -6.8)), court, "one", CAMERA.size, "light")
    assert said.outcome == outcome
    if outcome == "found":
        np.testing.assert_allclose(said.camera.centre_in_world, CAMERA.centre_in_world)


def test_a_near_rival_makes_a_place_ambiguous(court):
    image = court_pictures.draw(CAMERA, court)
    found = made(image, court, (0.0,))
    (best,) = found.candidates
    elsewhere = replace(best.view, f_px=best.view.f_px * 1.5)
    for share, outcome in ((0.95, "ambiguous"), (0.6, "found")):
        rival = replace(best, score=share * best.score, view=elsewhere)
        both = replace(found, candidates=[best, rival])
        said = verdict.judge(both, court, "one", CAMERA.size, "any")
        assert (said.outcome, bool(said.reason)) == (outcome, outcome == "ambiguous")
