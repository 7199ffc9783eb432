"""Normal errors: ellipsoids and factors against draws from the normal distribution."""

import numpy as np
import pytest

from courtside.statistics import normal_errors

DRAWS = np.random.default_rng(3).normal(size=(200_000, 3))


def test_mahalanobis_counts_sigmas():
    covariance = np.stack([np.diag([1.0, 4, 9]), np.array([[2.0, 1, 0], [1, 2, 0], [0, 0, 1]])])
    found = normal_errors.mahalanobis(np.array([[1.0, 2, 3], [1, 1, 0]]), covariance)
    assert found == pytest.approx([3.0, 2 / 3])


@pytest.mark.parametrize("share", [0.5, 0.9, 0.99])
def test_an_ellipsoid_holds_its_share_of_normal_errors(share):
    squares = normal_errors.mahalanobis(DRAWS, np.tile(np.eye(3), (len(DRAWS), 1, 1)))
    assert np.mean(squares <= normal_errors.ellipsoid(share)) == pytest.approx(share, abs=0.003)


def test_numbers_end_with_two_digits_of_their_error():
    errors = {120.0: 0, 9.4: 1, 0.38: 2, 0.017: 3, 0.0001: 3}
    assert {error: normal_errors.decimals(error) for error in errors} == errors


def test_factors_of_a_standard_deviation_are_those_of_normal_errors():
    sizes = np.abs(DRAWS[:, 0])
    assert np.mean(sizes <= normal_errors.WITHIN_90) == pytest.approx(0.9, abs=0.003)
    assert np.median(sizes) * normal_errors.MEDIAN_TO_SIGMA == pytest.approx(1, abs=0.01)
    lengths = np.linalg.norm(DRAWS[:, :2], axis=1)
    assert np.median(lengths) == pytest.approx(normal_errors.MEDIAN_2D, abs=0.01)


@pytest.mark.parametrize("n", [2, 3, 20])
def test_one_more_value_lies_within_the_deviations_of_the_others(n):
    values = np.random.default_rng(n).normal(5, 2, (100_000, n + 1))
    others = values[:, :n]
    away = np.abs(values[:, n] - others.mean(axis=1)) / others.std(axis=1, ddof=1)
    assert np.mean(away <= normal_errors.one_more(n, 0.9)) == pytest.approx(0.9, abs=0.004)
