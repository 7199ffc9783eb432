"""Colours of clothes: how cameras differ, and who is told from whom."""

import numpy as np
import pytest

from courtside.reconstruction.association import appearance
from courtside.reconstruction.association.candidates import Candidates

SIGMA = np.array([3, 2, 2, 3, 2, 2.0])
OFFSETS = np.array([[8, 0, 0, 8, 0, 0], [-8, 3, -2, -8, 3, -2], [0, -3, 2, 0, -3, 2.0]])
WORN = np.array([[40, 60, 40, 20, 0, 0], [70, -30, 20, 60, 5, 5], [30, 10, -50, 80, 0, 0.0]])
INSTANTS = np.arange(60)


def clothing(worn=WORN, seed=0):
    """Return the colours (P, T, 2, 3) that each of three cameras sees; row = person."""
    rng = np.random.default_rng(seed)
    shape = (len(worn), len(INSTANTS), 6)
    return [
        (worn[:, None] + offset + SIGMA * rng.normal(size=shape)).reshape(*shape[:2], 2, 3)
        for offset in OFFSETS
    ]


def candidates(rows):
    """Return one candidate of the rows (M, C) at each instant."""
    row = np.repeat(np.asarray(rows)[None], len(INSTANTS), axis=0).reshape(-1, 3)
    m = len(row)
    instant = np.repeat(INSTANTS, len(rows))
    return Candidates(
        instant, np.zeros((m, 3)), np.zeros((m, 3)), row, np.ones(m), np.zeros((m, 3))
    )


def learned(worn=WORN):
    together = np.repeat(np.arange(len(worn))[:, None], 3, axis=1)
    return appearance.learn(clothing(worn), INSTANTS, candidates(together))


def test_offsets_of_cameras_scatter_and_spread_of_people_are_learned():
    looks = learned()
    for person, worn in enumerate(WORN):
        seen = np.stack([colours[person].mean(axis=0) for colours in looks.colours])
        np.testing.assert_allclose(np.ptp(seen, axis=0), 0, atol=2)
        np.testing.assert_allclose(seen.mean(axis=0), worn, atol=2)
    np.testing.assert_allclose(looks.sigma, SIGMA, rtol=0.35)
    np.testing.assert_allclose(looks.spread, WORN.std(axis=0), rtol=0.05, atol=2)


def test_views_of_one_person_agree_and_the_view_of_another_stands_out():
    looks = learned()
    found = candidates([[0, 0, 0], [0, 0, 1], [1, 1, -1], [2, 1, -1]])
    cost = looks.view_cost(found.instant, found.row).reshape(-1, 4, 3)
    right, mixed, pair, wrong = cost.mean(axis=0)
    assert (right < -0.4).all()
    assert mixed[2] > 1 and (mixed[2] > mixed[:2] + 0.5).all()
    assert (pair[:2] < -0.3).all() and pair[2] == 0
    assert (wrong[:2] > 0.5).all() and wrong[2] == 0


def test_people_who_dress_alike_are_neither_told_apart_nor_taken_apart():
    looks = learned(np.repeat(WORN[:1], 3, axis=0))
    found = candidates([[0, 0, 0], [0, 1, 2]])
    cost = looks.view_cost(found.instant, found.row).reshape(-1, 2, 3)
    assert np.abs(cost.mean(axis=0)).max() < 0.15
    assert np.quantile(np.abs(cost), 0.95) < 0.3


def test_one_hidden_part_is_no_proof_of_another_person():
    looks = learned()
    off = np.zeros(6)
    off[:3] = 200
    assert -np.log(appearance.HIDDEN) - 1 < looks.cost(off) < -np.log(appearance.HIDDEN)
    assert looks.cost(np.full(6, np.nan)) == 0


def test_rows_cost_what_their_colours_differ_from_people():
    looks = learned()
    worn = looks.worn(np.arange(180).reshape(60, 3).T, candidates([[0] * 3, [1] * 3, [2] * 3]))
    np.testing.assert_allclose(worn, WORN, atol=2)
    cost = looks.row_cost(1, worn)
    assert cost.shape == (3, 60, 4)
    assert (cost[..., 3] == 0).all()
    assert (np.argmin(cost, axis=2) == np.arange(3)[:, None]).mean() > 0.95


@pytest.mark.parametrize("n", [0, appearance.FEWEST - 1])
def test_too_few_places_teach_nothing(n):
    every = candidates([[0, 0, 0]])
    assert appearance.learn(clothing(), INSTANTS, every.subset(np.arange(n))) is None
