"""Similarities of court points: wrong, missing, scattered, mirrored and collinear ones."""

import numpy as np
import pytest

from courtside.geometry import robust_similarity, similarity
from courtside.study.errors import InputError
from fixtures.cameras.scene import points
from fixtures.cameras.similarities import TRUE, assert_same


@pytest.mark.parametrize("n_wrong", [0, 1, 3, 6])
def test_wrong_points_are_left_out(n_wrong):
    rng = np.random.default_rng(n_wrong)
    x_in_a = points(18)
    x_in_b = TRUE.points(x_in_a) + rng.normal(0, 0.002, (18, 3))
    x_in_b[:n_wrong] += rng.uniform(0.5, 2, (n_wrong, 3))
    found, accepted = robust_similarity.fit(x_in_a, x_in_b, 0.002)
    assert accepted.tolist() == [False] * n_wrong + [True] * (18 - n_wrong)
    assert_same(found, similarity.umeyama(x_in_a[n_wrong:], x_in_b[n_wrong:]))
    again, _ = robust_similarity.fit(x_in_a, x_in_b, 0.002)
    assert again.scale == found.scale and (again.rotation == found.rotation).all()


def test_points_that_scatter_more_than_stated_are_kept_all_the_same():
    rng = np.random.default_rng(1)
    x_in_a = points(18)
    x_in_b = TRUE.points(x_in_a) + rng.normal(0, 0.1, (18, 3))
    _, accepted = robust_similarity.fit(x_in_a, x_in_b, 0.002)
    assert accepted.sum() >= 16


def test_missing_points_are_no_obstacle():
    x_in_a, x_in_b = points(8), TRUE.points(points(8))
    x_in_a[2], x_in_b[5, 1] = np.nan, np.nan
    found, accepted = robust_similarity.fit(x_in_a, x_in_b, 0.01)
    assert np.flatnonzero(~accepted).tolist() == [2, 5]
    assert_same(found, TRUE)


def test_mirrored_and_collinear_points_are_refused():
    x_in_b = TRUE.points(points(12))
    with pytest.raises(InputError, match=r"right-handed world .* exchange the names"):
        robust_similarity.fit(points(12) * [-1, 1, 1], x_in_b, 0.005)
    line = np.outer(range(6), [1, 2, 3])
    with pytest.raises(
        InputError, match=r"court points: expected three or more that are not on one line"
    ):
        robust_similarity.fit(line, line, 0.005)
    with pytest.raises(InputError, match="found 2 that two cameras see"):
        robust_similarity.fit(points(2), points(2), 0.005)
