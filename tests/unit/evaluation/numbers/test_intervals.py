"""Intervals over halls: wide where halls differ, narrow where trials do, known where they must."""

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation.numbers import intervals


def trials(halls, structures=3, draws=30, hall_sd=0.0, draw_sd=1.0, seed=1):
    rng = np.random.default_rng(seed)
    rows = [
        {"hall": hall, "structure": s, "value": shift + draw_sd * rng.normal()}
        for hall, shift in enumerate(hall_sd * rng.normal(size=halls))
        for s in range(structures)
        for _ in range(draws)
    ]
    return pd.DataFrame(rows)


def test_independent_trials_of_one_hall_have_the_interval_of_their_standard_error():
    values = trials(1, structures=1, draws=400)
    low, high = intervals.bootstrap(values, intervals.mean)
    assert high - low == pytest.approx(2 * 1.96 / 20, rel=0.15)
    assert low < values["value"].mean() < high


def test_halls_that_differ_widen_the_interval_however_many_trials_they_have():
    few, many = (trials(8, draws=n, hall_sd=1.0) for n in (10, 100))
    wide, alike = (
        np.ptp(intervals.bootstrap(t, intervals.mean, replicates=400))
        for t in (many, trials(8, draws=100))
    )
    assert wide > 3 * alike
    assert wide > 0.6 * np.ptp(intervals.bootstrap(few, intervals.mean, replicates=400))


def test_the_interval_over_halls_holds_the_true_mean_as_often_as_it_says():
    held = 0
    for seed in range(60):
        of = trials(16, structures=1, draws=3, hall_sd=1.0, seed=seed)
        low, high = intervals.bootstrap(of, intervals.mean, replicates=120)
        held += low <= 0 <= high
    assert 50 <= held <= 59


def test_failed_trials_are_left_out_and_one_value_gives_no_interval():
    one = pd.DataFrame({"hall": [0, 0], "structure": [0, 0], "value": [1.0, np.nan]})
    assert np.isnan(intervals.bootstrap(one, intervals.median)).all()
    same = pd.concat([one, one.assign(hall=1)])
    assert intervals.bootstrap(same, intervals.median) == (1.0, 1.0)


def test_a_median_over_halls_is_that_of_their_medians():
    halls = [np.array([1.0, 2.0, 9.0]), np.array([4.0]), np.array([5.0, 7.0])]
    assert intervals.median(halls) == 4.0
    assert intervals.mean(halls) == pytest.approx(14 / 3)
