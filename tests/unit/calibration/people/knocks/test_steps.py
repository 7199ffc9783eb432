"""Turns in place that epipolar residuals show."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.people.knocks import steps
from courtside.geometry import camera as cameras
from fixtures.cameras import corner_cameras, walkers

TRUE = corner_cameras.four_cameras()
SEEN = walkers.seen(TRUE, walkers.joints(80))
TURN = np.radians([0.25, -0.3, 0.1])
SCORE = 0.05


def turned(first_s, until_s=np.inf):
    """Return what is seen where c2 is turned from one time to another."""
    xy = SEEN.xy.copy()
    during = (SEEN.time_s >= first_s) & (SEEN.time_s < until_s)
    xy[2, during] = cameras.turned_back(TRUE[2], xy[2, during], -TURN)
    return replace(SEEN, xy=xy)


def test_the_clearest_step_is_the_turned_cameras_at_its_time():
    found = steps.clearest(TRUE, turned(4.5), SCORE, None)
    best = max((one for one in found if not one.put_back), key=lambda one: one.gain)
    assert best.camera == 2 and best.time_s == pytest.approx(4.5, abs=0.2)
    assert np.degrees(np.abs(best.turn - TURN)).max() < 0.1


def test_a_camera_put_back_is_turned_between_two_times_alone():
    best = max(steps.clearest(TRUE, turned(2.5, 5.5), SCORE, None), key=lambda one: one.gain)
    assert best.camera == 2 and best.put_back
    assert (best.time_s, best.until_s) == (pytest.approx(2.5, abs=0.2), pytest.approx(5.5, abs=0.2))
    assert best.during(np.array([0.0, 3.0, 5.0, 7.0])).tolist() == [False, True, True, False]


def test_steps_at_given_times_are_looked_for_there_alone():
    found = steps.clearest(TRUE, turned(4.5), SCORE, [3.0, 4.5])
    assert {one.time_s for one in found} <= {3.0, 4.5} and not any(one.put_back for one in found)
    assert max(found, key=lambda one: one.gain).time_s == 4.5


def test_cameras_that_stayed_make_no_step():
    assert steps.clearest(TRUE, SEEN, SCORE, None) == []


def test_blocks_are_a_second_long_and_never_of_two_tracks():
    track = np.where(SEEN.time_s < 3.5, 0, 1)
    block = steps.blocks(replace(SEEN, track=track), fewest=1)
    for one in np.unique(block):
        assert np.ptp(SEEN.time_s[block == one]) < steps.BLOCK_S
        assert len(np.unique(track[block == one])) == 1
