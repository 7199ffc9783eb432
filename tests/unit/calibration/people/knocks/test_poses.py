"""Cameras with one more pose after each step."""

from dataclasses import replace

import numpy as np

from courtside.calibration.people import prior
from courtside.calibration.people.knocks import poses
from courtside.calibration.people.knocks.steps import Step
from courtside.calibration.people.views import Limits
from courtside.geometry import camera as cameras
from fixtures.cameras import corner_cameras, walkers

TRUE = corner_cameras.four_cameras()
LIMITS = Limits(score=0.05, limit=0.05, fade=0.067)
KNOWN = prior.stated(TRUE, **corner_cameras.STATED)
SEEN = walkers.seen(TRUE, walkers.joints(80))
TURN = np.radians([0.25, -0.3, 0.1])


def test_a_rough_turn_is_measured_to_its_stated_deviation():
    xy, after = SEEN.xy.copy(), SEEN.time_s >= 4.5
    xy[2, after] = cameras.turned_back(TRUE[2], xy[2, after], -TURN)
    step = Step(2, 4.5, 0.6 * TURN, 99.0)
    ((turn, sigma),) = poses.measured(TRUE, KNOWN, replace(SEEN, xy=xy), LIMITS, [step])
    assert (np.abs(turn - TURN) < 3 * sigma).all()
    assert np.degrees(sigma[:2]).max() < 0.03


def test_each_step_has_a_pose_of_its_own_that_sees_what_came_after_it():
    steps = [Step(2, 3.0, TURN, 99.0), Step(2, 6.0, TURN, 99.0), Step(1, 4.0, TURN, 99.0)]
    found = poses.adjusted(TRUE, KNOWN, SEEN, LIMITS, steps).cameras
    assert len(found) == len(TRUE) + len(steps)
    parts = poses._split(SEEN, steps)
    seen = np.isfinite(parts.xy).any(axis=(-1, -2))
    for first, second, third in zip(seen[2], seen[4], seen[5], strict=True):
        assert first + second + third == 1
    assert SEEN.time_s[seen[4]].min() >= 3 and SEEN.time_s[seen[5]].min() >= 6
    assert (seen[1] ^ seen[6]).all() and SEEN.time_s[seen[6]].min() >= 4
