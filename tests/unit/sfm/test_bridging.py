"""Bridging images: blur and standing still are seen, the chosen are even, sharp, and enough."""

from itertools import combinations

import numpy as np
import pytest

from courtside.sfm import bridging
from courtside.study import methods
from courtside.study.errors import InputError

G = 150


@pytest.mark.parametrize("offset_idx", [0, 1, 2])
def test_images_are_even_and_on_multiples_of_a_power_of_two(offset_idx):
    for n in range(5, G + 1):
        chosen = bridging.choose(np.arange(G), G, n, offset_idx, np.ones(G))
        spacing = (G - 1) / (n - 1)
        q = max([1] + [2**k for k in range(8) if 2**k <= 0.4 * spacing])
        assert len(chosen) == n and np.all(np.diff(chosen) > 0) and np.all(chosen % q == 0)
        assert np.diff(chosen[:-1]).max() < spacing + 1.01 * q
        assert chosen[0] < spacing and chosen[-1] > G - 1 - spacing


def test_offsets_give_other_images():
    sets = [set(bridging.choose(np.arange(G), G, 20, o, np.ones(G)).tolist()) for o in (0, 1, 2)]
    for one, other in combinations(sets, 2):
        assert len(one & other) <= 2  # the ends meet


def test_a_clearly_sharper_neighbour_wins_and_a_slightly_sharper_one_does_not():
    sharpness = np.full(G, 100.0)
    plain = bridging.choose(np.arange(G), G, 20, 0, sharpness)
    q, at = 2, plain[7]
    sharpness[at + q] = 120.0
    np.testing.assert_array_equal(bridging.choose(np.arange(G), G, 20, 0, sharpness), plain)
    sharpness[at + q] = 130.0
    found = bridging.choose(np.arange(G), G, 20, 0, sharpness)
    assert found[7] == at + q
    np.testing.assert_array_equal(np.delete(found, 7), np.delete(plain, 7))


def test_unusable_frames_are_never_chosen():
    rng = np.random.default_rng(0)
    for n in (5, 10, 20, 40, 75, 100):
        kept_idx = np.flatnonzero(rng.random(G) > 0.2)
        chosen = bridging.choose(kept_idx, G, n, 1, rng.uniform(50, 150, G))
        assert set(chosen.tolist()) <= set(kept_idx.tolist())
        assert len(chosen) == n and np.all(np.diff(chosen) > 0)


def test_all_usable_frames_are_taken_when_all_are_wanted():
    kept_idx = np.flatnonzero(np.arange(G) % 3)
    for rule in ("even", "interval"):
        found = bridging.choose(kept_idx, G, len(kept_idx), 0, np.ones(G), rule)
        np.testing.assert_array_equal(found, kept_idx)


@pytest.mark.parametrize("seed", range(3))
def test_places_are_settled_at_the_least_cost(seed):
    """Against every choice of three places of thirteen."""
    rng = np.random.default_rng(seed)
    costs = rng.uniform(0, 100, (3, 13))
    costs[:, rng.integers(0, 13, 3)] = np.inf
    costs[2, :11] += 5e5  # so that wide gaps are worth their price at times

    def cost(places):
        wide = np.count_nonzero(np.diff(places) > 8)
        return costs[range(3), places].sum() + wide * bridging.GAP_COST

    best = min(combinations(range(13), 3), key=cost)
    assert tuple(bridging._settle(costs).tolist()) == best


def test_a_long_unusable_stretch_is_crossed():
    kept_idx = np.r_[0:30, 120:150]
    chosen = bridging.choose(kept_idx, G, 40, 0, np.ones(G))
    assert len(chosen) == 40 and set(chosen.tolist()) <= set(kept_idx.tolist())


@pytest.mark.parametrize(
    ("offset_idx", "n", "expected"),
    [(0, 4, [0, 3, 6, 9]), (1, 4, [1, 4, 7, 10]), (2, 4, [2, 5, 8, 11]), (0, 5, [0, 2, 4, 6, 8])],
)
def test_the_plain_interval_takes_every_dth(offset_idx, n, expected):
    found = bridging.choose(np.arange(14), 14, n, offset_idx, np.ones(14), "interval")
    assert found.tolist() == expected
    shifted = bridging.choose(np.arange(14) + 3, 17, n, offset_idx, np.ones(17), "interval")
    assert shifted.tolist() == [place + 3 for place in expected]


@pytest.mark.parametrize("rule", ["even", "interval"])
def test_too_few_usable_frames_are_said(rule):
    with pytest.raises(InputError) as caught:
        bridging.choose(np.arange(0, 30, 3), 30, 11, 0, np.ones(30), rule, walk="walk1")
    message = "walk1: expected at least 11 usable frames, found 10 of 30"
    assert str(caught.value).startswith(message) and "n_images: [" in str(caught.value)


@pytest.mark.parametrize(
    "change",
    [{"n": 1}, {"offset_idx": 3}, {"rule": "best"}, {"kept_idx": [3, 2, 5]}, {"kept_idx": [1, 30]}],
)
def test_wrong_arguments_are_faults(change):
    arguments = {"kept_idx": np.arange(30), "n": 2, "offset_idx": 0, "rule": "even"} | change
    with pytest.raises(ValueError, match=r"offset|ascend") as caught:
        bridging.choose(n_grid=30, sharpness=np.ones(30), **arguments)
    assert not isinstance(caught.value, InputError)


@pytest.mark.parametrize(("n", "n_grid"), [(40, 150), (40, 80), (11, 11), (20, 40), (5, 80)])
def test_choices_are_alike_where_the_study_takes_one_of_them(n, n_grid):
    sharpness = np.random.default_rng(n).uniform(50, 150, n_grid)
    chosen = [tuple(bridging.choose(np.arange(n_grid), n_grid, n, o, sharpness)) for o in (0, 1, 2)]
    kept = methods.distinct_offsets(n, n_grid, 3)
    assert len({chosen[offset] for offset in kept}) == len(kept)
    assert set(chosen) == {chosen[offset] for offset in kept}
