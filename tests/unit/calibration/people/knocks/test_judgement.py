"""What held-out joints say of a step."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.people import held_out
from courtside.calibration.people.knocks import judgement
from courtside.calibration.people.knocks.steps import Step
from fixtures.cameras import corner_cameras, walkers

SEEN = walkers.seen(corner_cameras.four_cameras(), walkers.joints(80))
TURN = np.radians([0.25, -0.3, 0.1])


def test_a_side_of_one_block_does_not_tell_of_a_knock():
    before = held_out.Score(dict(enumerate([0.02] * 8)))
    seen = replace(SEEN, time_s=np.arange(80) / 10)
    for first, taken in ((7.0, False), (6.0, True)):
        shares = [0.005 if block >= first else 0.02 for block in range(8)]
        ((kept, _), (gone, said)) = judgement._by_side(
            before, held_out.Score(dict(enumerate(shares))), seen, Step(2, first, TURN, 99)
        )
        assert kept == 0 and gone == pytest.approx(-0.75)
        assert held_out.better(said) is taken


def test_steps_that_are_taken_come_first_and_those_for_good_before_those_put_back():
    better, worse = {"joints": "better"}, judgement.NOT_BETTER
    for_good, back = Step(2, 3.0, TURN, 40.0), Step(2, 3.0, TURN, 90.0, until_s=5.0)
    taken, refused = judgement.Judged(-0.5, better), judgement.Judged(-0.9, worse)
    assert taken.order(for_good) < taken.order(back) < refused.order(back)
    assert judgement.Judged(-0.6, better).order(back) < taken.order(for_good)
    assert refused.order(back) < refused.order(for_good)
