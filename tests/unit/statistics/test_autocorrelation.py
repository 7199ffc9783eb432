"""Shares and sums of correlated frames: closed forms, coverage of intervals, known variances."""

import numpy as np
import pytest
from scipy.signal import lfilter

from courtside.statistics import autocorrelation


def chain(rng, n, stay):
    """Return a symmetric two-state Markov chain, whose autocorrelation is (2 stay - 1)^k."""
    changes = rng.random(n) > stay
    return (np.cumsum(changes) + rng.integers(2)) % 2 == 1


def test_correlated_frames_count_as_the_theory_says():
    rng = np.random.default_rng(0)
    for stay in (0.5, 0.8, 0.95):
        rho = 2 * stay - 1
        found = np.mean(
            [autocorrelation.frames_per_trial(chain(rng, 4000, stay)) for _ in range(20)]
        )
        # The positive sequence errs towards too few trials, by some tenths at most.
        assert 0.95 < found / ((1 + rho) / (1 - rho)) < 1.25


def test_frames_that_are_alike_count_as_the_least():
    assert autocorrelation.frames_per_trial(np.ones(90, bool)) == 1.0
    found = autocorrelation.share(np.ones(90, bool), least_frames=6)
    assert found["n_effective"] == pytest.approx(15)
    # Wilson's interval of k = n is n / (n + z^2) to 1.
    assert found["low"] == pytest.approx(15 / (15 + 1.959964**2), rel=1e-6)
    assert found["high"] == 1.0


def test_the_interval_solves_wilsons_equation():
    for share, n in ((0.3, 20), (0.5, 7.5), (0.05, 100)):
        for limit in autocorrelation.interval(share, n):
            assert abs(share - limit) == pytest.approx(
                1.959964 * np.sqrt(limit * (1 - limit) / n), rel=1e-6
            )


def test_intervals_hold_the_truth_as_often_as_stated():
    rng = np.random.default_rng(1)
    held = 0
    for _ in range(400):
        found = autocorrelation.share(chain(rng, 300, 0.85))
        held += found["low"] <= 0.5 <= found["high"]
    assert 0.88 < held / 400 < 0.99


def test_no_frames_say_nothing():
    found = autocorrelation.share(np.zeros(0, bool))
    assert np.isnan(found["share"]) and (found["low"], found["high"]) == (0.0, 1.0)


def series(rng, ratio, count):
    return lfilter([1.0], [1.0, -ratio], rng.normal(0, 1, count))


@pytest.mark.parametrize("ratio", [0.0, 0.5, 0.8])
def test_an_autoregression_has_its_known_variance(ratio):
    rng = np.random.default_rng(0)
    found = [
        autocorrelation.covariance_of_sum(series(rng, ratio, 500)[:, None])[0, 0] / 500
        for _ in range(60)
    ]
    # White noise through 1 / (1 - ratio z) has the long-run variance 1 / (1 - ratio)^2.
    assert np.mean(found) == pytest.approx((1 - ratio) ** -2, rel=0.15)


def test_equal_columns_are_wholly_correlated():
    column = series(np.random.default_rng(1), 0.5, 400)
    found = autocorrelation.covariance_of_sum(np.column_stack([column, -2 * column]))
    np.testing.assert_allclose(found, found[0, 0] * np.array([[1, -2], [-2, 4]]), rtol=1e-9)


def test_a_mean_above_zero_counts_in_standard_deviations():
    rng = np.random.default_rng(2)
    found = [autocorrelation.distinct(series(rng, 0.6, 400)) for _ in range(400)]
    assert np.std(found) == pytest.approx(1.0, abs=0.12)
    shifted = [autocorrelation.distinct(series(rng, 0.6, 400) + 0.5) for _ in range(100)]
    # 0.5 against 1 / (1 - 0.6) / sqrt(400)
    assert np.median(shifted) == pytest.approx(4.0, abs=0.5)


def test_too_short_a_series_says_nothing():
    assert autocorrelation.distinct(np.array([5.0, 5.0])) == 0.0
