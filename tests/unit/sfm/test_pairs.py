"""Pairs of a walk's frames: by their definition, few, and enough for any number of images."""

from itertools import pairwise

import numpy as np
import pytest

from courtside.sfm import bridging, pairs

G = 150


def missing_pairs(place_idx, n_grid, *, reach=1):
    """Return the pairs (M, 2) of neighbours up to `reach` apart that `pair_list` does not hold."""
    place_idx = np.asarray(place_idx, dtype=int)
    listed = set(map(tuple, pairs.pair_list(n_grid).tolist()))
    wanted = [
        pair
        for step in range(1, reach + 1)
        for pair in zip(place_idx[:-step].tolist(), place_idx[step:].tolist(), strict=True)
    ]
    return np.array(sorted(set(wanted) - listed), dtype=int).reshape(-1, 2)


def by_definition(n_grid):
    """Pairs of multiples of q = 1, 2, 4, ... that are up to 8 q apart."""
    found = set()
    q = 1
    while q < n_grid:
        places = range(0, n_grid, q)
        found |= {(i, j) for i in places for j in places if i < j <= i + 8 * q}
        q *= 2
    return sorted(found)


@pytest.mark.parametrize("n_grid", [1, 2, 9, 10, 33, G])
def test_the_list_is_its_definition(n_grid):
    found = pairs.pair_list(n_grid)
    assert found.shape[1] == 2
    assert list(map(tuple, found.tolist())) == by_definition(n_grid)


def test_the_list_is_about_12_pairs_per_frame():
    assert 10 < len(pairs.pair_list(G)) / G < 12
    assert 11.5 < len(pairs.pair_list(2000)) / 2000 < 12


def test_a_longer_walk_keeps_its_pairs():
    longer = set(map(tuple, pairs.pair_list(G + 7).tolist()))
    assert set(map(tuple, pairs.pair_list(G).tolist())) <= longer


@pytest.mark.parametrize("offset_idx", [0, 1, 2])
def test_neighbours_of_any_number_of_images_are_in_the_list(offset_idx):
    sharpness = np.random.default_rng(offset_idx).uniform(50, 150, G)
    second = []
    for n in range(5, G + 1):
        chosen = bridging.choose(np.arange(G), G, n, offset_idx, sharpness)
        assert len(missing_pairs(chosen, G)) == 0
        both = zip(chosen[:-2].tolist(), chosen[2:].tolist(), strict=True)
        missing = {tuple(pair) for pair in missing_pairs(chosen, G, reach=2).tolist()}
        second += [pair not in missing for pair in both]
    assert np.mean(second) > 0.95


def test_missing_pairs_are_those_that_the_list_lacks():
    listed = set(by_definition(60))
    chosen = [0, 1, 12, 24, 57]
    expected = [p for p in pairwise(chosen) if p not in listed]
    assert expected == [(1, 12), (24, 57)]
    assert missing_pairs(chosen, 60).tolist() == [list(p) for p in expected]
    further = [p for p in zip(chosen[:-2], chosen[2:], strict=True) if p not in listed]
    both = sorted(expected + further)
    assert list(map(tuple, missing_pairs(chosen, 60, reach=2).tolist())) == both
    assert missing_pairs([4], 60).shape == (0, 2)
