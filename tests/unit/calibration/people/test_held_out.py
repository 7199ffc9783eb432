"""Verdicts by what a fit did not see: better, worse, and no difference where there is none."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.people import held_out, prior
from courtside.calibration.people.adjustment import Clicks
from courtside.calibration.people.held_out import Points
from courtside.calibration.people.views import Limits
from courtside.geometry import camera as cameras
from fixtures.cameras import corner_cameras, walkers

TRUE = corner_cameras.four_cameras()
LIMITS = Limits(score=0.05, limit=0.05, fade=0.067)
KNOWN = prior.stated(
    TRUE, rotation_deg=0.3, position_m=0.03, focal_percent=0.5, principal_point_percent=0.3, k1=0.01
)
WRONG = walkers.disturbed(TRUE, KNOWN, 1)
STATIC = corner_cameras.seen_points(TRUE, 8, 0.5, seed=2)
PLACES = np.array([[x, y, 0.0] for x in (-2, 0, 2) for y in (-2, 0, 2)])


def court():
    xy = np.stack([cameras.project(one, PLACES) for one in TRUE])
    return Clicks(PLACES, np.full(9, 1e-3), xy, np.ones((4, 1, 1)), np.zeros(4), 4.0)


@pytest.fixture(scope="module")
def scores():
    seen = walkers.seen(TRUE, walkers.joints(64))
    points = Points(STATIC, court())
    ways = {"true": TRUE, "wrong": WRONG}
    return {
        name: held_out.score(lambda *_, way=way: way, seen, points, LIMITS)
        for name, way in ways.items()
    }


def test_a_block_in_which_no_joint_is_shared_does_not_count():
    score = held_out.Score(share={0: 0.01, 1: float("nan"), 2: 0.03, 3: 0.02})
    assert score.typical() == 0.02


def test_true_cameras_are_better_and_wrong_ones_worse(scores):
    better = held_out.verdicts(scores["wrong"], scores["true"])
    assert better == dict.fromkeys(("joints", "court", "static"), "better")
    assert held_out.better(better)
    worse = held_out.verdicts(scores["true"], scores["wrong"])
    assert set(worse.values()) == {"worse"} and not held_out.better(worse)


def test_the_same_cameras_are_not_better(scores):
    same = held_out.verdicts(scores["true"], scores["true"])
    assert set(same.values()) == {"not better"} and not held_out.better(same)


def test_blocks_that_only_one_of_both_knows_say_nothing():
    before, after = (held_out.Score() for _ in range(2))
    before.share |= {0: 0.02, 1: 0.04, 2: np.nan, 3: 0.02}
    after.share |= {0: 0.01, 2: 0.01, 3: 0.01, 4: 0.01}
    assert held_out.change(before, after)[0] == pytest.approx(np.log(0.5))


def test_one_verdict_against_is_enough():
    assert not held_out.better({"joints": "better", "court": "not better"})
    assert held_out.better({"joints": "better"})


def test_residuals_are_per_axis_and_court_points_are_at_their_places(scores):
    assert scores["true"].rms_px("court") == pytest.approx(0, abs=1e-9)
    assert 0.2 < scores["true"].rms_px("static") < 0.6  # 0.5 px, less three unknowns of 8
    assert np.median(list(scores["true"].share.values())) == pytest.approx(0.0032, rel=0.25)
    assert (scores["true"].accepted_percent() > 99).all()


def test_few_court_points_say_nothing():
    seen = walkers.seen(TRUE, walkers.joints(64))
    few = court().of(np.arange(9) < 5)
    found = held_out.score(lambda *_: TRUE, seen, Points(court=few), LIMITS)
    assert np.isnan(found.rms_px("court"))


def test_views_of_joints_that_no_other_camera_shows_are_not_judged():
    seen, cameras = walkers.seen(TRUE[:3], walkers.joints(200)), TRUE[:3]
    gone = np.arange(200) % 10 >= 4
    score = seen.score.copy()
    score[1:, gone] = np.nan
    xy = np.where(np.isfinite(score)[..., None], seen.xy, np.nan)
    alone = replace(seen, xy=xy, score=score)
    found = held_out.score(lambda *_: cameras, alone, Points(), LIMITS)
    assert (found.accepted_percent() > 99).all()


def test_half_of_all_blocks_and_court_points_are_held_out_in_turn():
    seen, given = walkers.seen(TRUE, walkers.joints(64)), []

    def fit(part, clicks):
        given.append((len(part.track), np.isfinite(clicks.xy[0, :, 0])))
        return TRUE

    held_out.score(fit, seen, Points(court=court(), fitted=True), LIMITS)
    assert [rows for rows, _ in given] == [32, 32]
    assert (given[0][1] ^ given[1][1]).all()
