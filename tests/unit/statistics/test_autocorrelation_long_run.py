"""The uncertainty of sums: autoregressions whose long-run variance is known."""

import numpy as np
import pytest
from scipy.signal import lfilter

from courtside.statistics import autocorrelation


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
