"""Intervals over halls: wide where halls differ, narrow where trials do, known where they must."""

import numpy as np
import pandas as pd
import pytest

from courtside.statistics import intervals


def trials(halls, structures=3, draws=30, *, hall_sd=0.0, person_sd=0.0, draw_sd=1.0, seed=1):
    """Return made-up trials: sums of effects of a hall, of a person in it, and of the trial."""
    rng = np.random.default_rng(seed)
    persons = hall_sd * rng.normal(size=(halls, 1)) + person_sd * rng.normal(size=(halls, draws))
    rows = [
        {"hall": hall, "session": f"s{hall}", "structure": s, "draw": draw, "value": value}
        for hall in range(halls)
        for s in range(structures)
        for draw, value in enumerate(persons[hall] + draw_sd * rng.normal(size=draws))
    ]
    return pd.DataFrame(rows)


def share_held(**made):
    """Return in how many of 100 repeats the 95 % interval of the mean holds the true one, 0."""
    held = 0
    for seed in range(100):
        low, high = intervals.bootstrap(trials(seed=seed, **made), np.nanmean, replicates=200)
        held += low <= 0 <= high
    return held


def test_independent_trials_of_one_hall_have_the_interval_of_their_standard_error():
    values = trials(1, structures=1, draws=400)
    low, high = intervals.bootstrap(values, np.nanmean)
    assert high - low == pytest.approx(2 * 1.96 / 20, rel=0.15)
    assert low < values["value"].mean() < high


def test_halls_that_differ_widen_the_interval_however_many_trials_they_have():
    few, many = (trials(8, draws=n, hall_sd=1.0) for n in (10, 100))
    wide, alike = (
        np.ptp(intervals.bootstrap(t, np.nanmean, replicates=400))
        for t in (many, trials(8, draws=100))
    )
    assert wide > 3 * alike
    assert wide > 0.6 * np.ptp(intervals.bootstrap(few, np.nanmean, replicates=400))


def test_the_interval_over_halls_holds_the_true_mean_as_often_as_it_says():
    assert 84 <= share_held(halls=16, structures=1, draws=3, hall_sd=1.0) <= 98


def test_persons_who_click_for_every_structure_do_not_count_as_independent():
    assert 86 <= share_held(halls=1, person_sd=1.0, draw_sd=0.2) <= 98


def test_persons_of_two_sessions_in_one_hall_are_others():
    of = trials(1, structures=2, draws=200)
    others = of.assign(session=of["structure"].map({0: "one", 1: "two"}))
    wide = np.ptp(intervals.bootstrap(of.assign(value=of["draw"] % 2), np.nanmean))
    narrow = np.ptp(intervals.bootstrap(others.assign(value=of["draw"] % 2), np.nanmean))
    assert wide > 1.1 * narrow


def test_failed_trials_are_left_out_and_one_value_gives_no_interval():
    one = trials(1, structures=1, draws=2).assign(value=[1.0, np.nan])
    assert np.isnan(intervals.bootstrap(one, np.nanmedian)).all()
    same = pd.concat([one, one.assign(hall=1)])
    assert intervals.bootstrap(same, np.nanmedian) == (1.0, 1.0)
    apart = trials(1, structures=2, draws=2).assign(value=[1.0, np.nan, np.nan, 1.0])
    assert intervals.bootstrap(apart, np.nanmedian) == (1.0, 1.0)


def test_the_middle_of_an_interval_of_medians_is_that_of_the_halls_medians():
    halls = [trials(1, 1, 200).assign(hall=hall, value=hall) for hall in range(20)]
    halls.append(trials(1, 1, 5000).assign(hall=20, value=50.0))
    low, high = intervals.bootstrap(pd.concat(halls), np.nanmedian)
    assert low < 10 < high < 20
