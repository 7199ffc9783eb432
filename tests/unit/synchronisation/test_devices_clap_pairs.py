"""Claps are paired by their intervals, by the motion where these fit twice, or not at all."""

import pytest

from courtside.events.claps import Clap
from courtside.study.errors import InputError
from courtside.synchronisation import devices


def claps(*times_s, uncertainty_s=0.005):
    return [Clap(at_s, uncertainty_s, 0, 0.1, 2.5, 0.0, False) for at_s in times_s]


def nothing(offset_s):
    return 0.0


def times(pairs):
    return [(a.time_s, b.time_s) for a, b in pairs]


def test_intervals_decide():
    pairs = devices.pair(claps(3.0, 20.0, 55.0), claps(13.01, 30.0, 65.02), nothing, "b")
    assert times(pairs) == [(3.0, 13.01), (20.0, 30.0), (55.0, 65.02)]
    assert devices.offset_s(pairs) == pytest.approx(10.01)


def test_a_clap_that_only_one_shows_is_left_out():
    pairs = devices.pair(claps(3.0, 20.0, 55.0), claps(30.0, 65.0), nothing, "b")
    assert times(pairs) == [(20.0, 30.0), (55.0, 65.0)]


def test_a_fast_clock_still_pairs():
    pairs = devices.pair(claps(0.0, 600.0), claps(5.0, 605.0 + 600 * 3e-4), nothing, "b")
    assert len(pairs) == 2


def test_the_motion_decides_where_intervals_do_not():
    def likeness(offset_s):
        return 0.8 if abs(offset_s - 47.0) < 0.1 else 0.1

    pairs = devices.pair(claps(3.0), claps(15.0, 50.0), likeness, "b")
    assert times(pairs) == [(3.0, 50.0)]


def test_what_nothing_decides_is_an_error_that_names_the_times():
    with pytest.raises(InputError, match=r"2 ways .*15\.00, 50\.00 s against 3\.00 s") as caught:
        devices.pair(claps(3.0), claps(15.0, 50.0), nothing, "mocopi against rgb")
    assert str(caught.value).startswith("mocopi against rgb")


def test_surer_claps_count_more():
    pairs = [*zip(claps(0.0), claps(1.0), strict=True)]
    pairs += zip(claps(9.0, uncertainty_s=0.0), claps(10.05, uncertainty_s=0.001), strict=True)
    assert devices.offset_s(pairs) == pytest.approx(1.049, abs=0.001)
