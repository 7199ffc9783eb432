"""Candidates over time: exact places with gaps, crossings, and exchanged pieces."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from courtside.reconstruction.association import candidates, linking
from courtside.reconstruction.association import rows as rows_module
from courtside.reconstruction.association.candidates import Candidates
from fixtures.cameras import scene
from fixtures.people import stick_figures

STEP_S = 0.1


def candidates_of(paths, owners=None, missing=()):
    """Return candidates, pieces and times of paths (P, N, 3), seen in two views, row = person.

    `missing` holds (person, instant) pairs; `owners` (P, N) the piece of each in both views.
    """
    count, n = paths.shape[:2]
    at = [(t, p) for t in range(n) for p in range(count) if (p, t) not in missing]
    instant, person = (np.array(column) for column in zip(*at, strict=True))
    owners = np.repeat(np.arange(count)[:, None], n, 1) if owners is None else owners
    row = np.stack([person, person], axis=1)
    found = Candidates(
        instant=instant,
        xyz=paths[person, instant],
        direction=np.zeros((len(instant), 3)),
        row=row,
        sigma_m=np.full(len(instant), 0.03),
        view_cost=np.full(row.shape, -3.0),
    )
    piece = np.stack([owners[person, instant]] * 2, axis=1)
    return found, piece, np.arange(n) * STEP_S, person


def lines(n, *ends):
    share = np.linspace(0, 1, n)[:, None]
    return np.stack([(1 - share) * a + share * b for a, b in np.array(ends, float)])


def persons_of(paths, person):
    """Return which person each followed path shows, as sets."""
    return [set(person[c[c >= 0]]) for c in paths if (c >= 0).any()]


def test_two_who_walk_apart_are_two_paths():
    found, piece, time_s, person = candidates_of(
        lines(30, ([0, 0, 1], [2, 0, 1]), ([0, 3, 1], [2, 3, 1]))
    )
    paths = linking.link(found, piece, time_s, 4)
    assert sorted(map(sorted, persons_of(paths, person))) == [[0], [1]]
    assert (paths >= 0).sum() >= 56  # a person is believed in after some instants


def test_all_of_a_team_are_known_at_the_first_instant():
    people = [([x, 0, 1], [x, 2, 1]) for x in range(0, 24, 2)]
    found, piece, time_s, person = candidates_of(lines(40, *people))
    paths = linking.link(found, piece, time_s, 14)
    assert sorted(person[paths[paths[:, 0] >= 0, 0]]) == list(range(12))


def test_who_joins_a_team_is_followed_though_each_of_it_may_be_placed_in_several_ways():
    people = [([x, 0, 1], [x, 2, 1]) for x in range(0, 24, 2)]
    absent = {(11, instant) for instant in range(40)}
    found, piece, time_s, person = candidates_of(lines(60, *people), missing=absent)
    ways = [  # of one piece, nearly as likely
        replace(found, xyz=found.xyz + 0.01 * k, view_cost=found.view_cost + 0.02 * k)
        for k in range(3)
    ]
    order = np.argsort(np.tile(found.instant, 3), kind="stable")
    paths = linking.link(candidates.concatenate(ways), np.tile(piece, (3, 1))[order], time_s, 14)
    who = np.where(paths >= 0, np.tile(person, 3)[order][paths], -1)
    assert (who[:, 45:] == 11).any(axis=0).all()  # half a second later


class Worn:
    """Looks in which the colour of a candidate is its row."""

    def middle(self, found):
        return np.repeat(found.row[:, :1].astype(float), 3, axis=1)

    def cost(self, off, more=0.0):
        return np.where(np.isfinite(off).all(axis=-1), 2.0 * (np.abs(off) > 0.5).any(axis=-1), 0.0)


def test_colours_tell_who_turned_round_while_nobody_was_seen():
    """Two walk towards each other and go back: by their motion alone they passed."""
    there = lines(20, ([-5, 0, 1], [-0.2, 0, 1]), ([5, 0.1, 1], [0.2, 0.1, 1]))
    paths = np.concatenate([there, there[:, ::-1]], axis=1)
    missing = {(p, t) for p in range(2) for t in range(18, 22)}
    own = np.arange(80).reshape(2, 40) + 10
    found, piece, time_s, person = candidates_of(paths, own, missing)
    without = linking.link(found, piece, time_s, 2)
    assert persons_of(without, person) == [{0, 1}, {0, 1}]
    known = linking.link(found, piece, time_s, 2, looks=Worn())
    assert sorted(map(sorted, persons_of(known, person))) == [[0], [1]]


def test_motion_carries_identity_through_a_gap_of_both():
    paths = lines(40, ([-3, 0, 1], [3, 0.2, 1]), ([3, 0.6, 1], [-3, 0.4, 1]))
    missing = {(p, t) for p in range(2) for t in (18, 19, 20)}
    own = np.arange(80).reshape(2, 40) + 10  # each instant a new piece: nothing but motion helps
    found, piece, time_s, person = candidates_of(paths, own, missing)
    result = linking.link(found, piece, time_s, 2)
    assert sorted(map(sorted, persons_of(result, person))) == [[0], [1]]


def test_an_uncut_piece_carries_identity_where_motion_would_not():
    # They exchange places while unseen: motion alone says that they stayed.
    one, other = [-1.0, 0, 1], [1.0, 0.3, 1]
    paths = np.repeat(np.array([[one, other], [other, one]]), 20, axis=1)
    missing = {(p, t) for p in range(2) for t in range(18, 22)}
    found, piece, time_s, person = candidates_of(paths, missing=missing)
    result = linking.link(found, piece, time_s, 2)
    assert sorted(map(sorted, persons_of(result, person))) == [[0], [1]]
    cut = np.where(np.arange(40) < 20, [[0], [1]], [[2], [3]])
    found, piece, time_s, person = candidates_of(paths, cut, missing)
    result = linking.link(found, piece, time_s, 2)
    assert sorted(map(sorted, persons_of(result, person))) == [[0, 1], [0, 1]]


def test_a_lost_person_is_found_again_rather_than_born_again():
    paths = lines(60, ([0, 0, 1], [1, 0, 1]))
    missing = {(0, t) for t in range(20, 40)}
    own = np.where(np.arange(60) < 30, 0, 1)[None]
    found, piece, time_s, person = candidates_of(paths, own, missing)
    result = linking.link(found, piece, time_s, 3)
    assert persons_of(result, person) == [{0}]
    assert (result >= 0).sum() >= 38


def test_a_row_is_not_counted_for_two():
    paths = lines(10, ([0, 0, 1], [0, 0, 1]), ([2, 0, 1], [2, 0, 1]))
    found, piece, time_s, person = candidates_of(paths)
    ghost = Candidates(
        np.arange(10),
        np.tile([1.0, 1.0, 1.0], (10, 1)),
        np.zeros((10, 3)),
        np.tile([0, 1], (10, 1)),
        np.full(10, 0.03),
        np.full((10, 2), -2.9),
    )
    order = np.argsort(np.concatenate([found.instant, ghost.instant]), kind="stable")
    both = candidates.concatenate([found, ghost])
    piece = np.concatenate([piece, ghost.row])[order]
    owner = np.concatenate([person, np.full(10, 9)])[order]
    result = linking.link(both, piece, time_s, 4)
    assert sorted(map(sorted, persons_of(result, owner))) == [[0], [1]]


def test_nothing_to_link_gives_empty_paths():
    found, _, _, _ = candidates_of(lines(5, ([0, 0, 1], [1, 0, 1])))
    none = found.subset(np.zeros(5, bool))
    result = linking.link(none, np.zeros((0, 2), int), np.arange(5) * STEP_S, 2)
    assert result.shape == (2, 5)
    assert (result == -1).all()


def test_players_rather_stay_in_their_half():
    # Both vanish before the net for a second, standing as far from one another as from themselves.
    before = np.tile([[[0.0, 6.2, 1]], [[0.0, 7.2, 1]]], (1, 10, 1))
    after = np.tile([[[0.72, 6.5, 1]], [[0.72, 6.9, 1]]], (1, 10, 1))
    nothing = np.zeros((2, 10, 3))
    paths = np.concatenate([before, nothing, after], axis=1)
    missing = {(p, t) for p in range(2) for t in range(10, 20)}
    own = np.arange(60).reshape(2, 30) + 10
    found, piece, time_s, person = candidates_of(paths, own, missing)
    result = linking.link(found, piece, time_s, 2, net_y_m=6.7)
    assert sorted(map(sorted, persons_of(result, person))) == [[0], [1]]


def test_a_ray_of_one_view_carries_a_person_through_a_turn():
    # Person 0 turns back while only one view sees it, and meets where person 1 was hidden all the
    # time.
    n, camera = 40, np.array([0.0, -20.0, 1.0])
    x = np.concatenate([np.linspace(-2, 0, 20), np.linspace(0, -2, 20)])
    paths = np.stack([np.stack([x, 0 * x, 0 * x + 1], axis=1), np.tile([2.0, 0, 1], (n, 1))])
    unseen = range(14, 30)
    own = np.arange(2 * n).reshape(2, n) + 10
    found, piece, time_s, person = candidates_of(
        paths, own, {(p, t) for p in range(2) for t in unseen}
    )
    toward = np.array([paths[0, t] - camera for t in unseen])
    rays = Candidates(
        instant=np.array(unseen),
        xyz=np.tile(camera, (len(toward), 1)),
        direction=toward / np.linalg.norm(toward, axis=1, keepdims=True),
        row=np.tile([0, -1], (len(toward), 1)),
        sigma_m=np.full(len(toward), 0.002),
        view_cost=np.tile([-1.0, 0.0], (len(toward), 1)),
    )
    order = np.argsort(np.concatenate([found.instant, rays.instant]), kind="stable")
    pieces = np.concatenate([piece, np.stack([own[0, 14:30], np.full(16, -1)], axis=1)])[order]
    owner = np.concatenate([person, np.zeros(16, int)])[order]
    result = linking.link(candidates.concatenate([found, rays]), pieces, time_s, 2)
    assert sorted(map(sorted, persons_of(result, owner))) == [[0], [1]]
    on_rays = [(c[14:30] >= 0).sum() for c in result]
    assert sorted(on_rays) == [0, 16]


def test_a_path_is_sure_at_its_instants_and_silent_far_from_them():
    time_s, at_s = np.arange(31) / 10, np.array([0.0, 0.2, 2.0])
    path, sigma_m = linking.along(time_s, at_s, np.outer(at_s, [1.0, 0, 0]))
    np.testing.assert_allclose(path[:21, 0], time_s[:21])
    assert (path[21:, 0] == 2.0).all()
    assert sigma_m[[0, 2, 20]].tolist() == [0, 0, 0]
    assert np.isinf(sigma_m[[10, 30]]).all()
    assert 0 < sigma_m[1] < sigma_m[4]


def test_each_row_is_cheapest_for_its_own_person():
    camera, time_s = scene.ring(1, radius_m=15)[0], np.arange(10) / 30
    places = [np.outer(time_s, [1.0, 0]) + start for start in ([0, 2], [0, -2])]
    people = np.stack([stick_figures.body(place, time_s) for place in places])
    xy = scene.opencv_projection(camera, people.reshape(-1, 3)).reshape(2, 10, 12, 2)
    xy[1, 4] = np.nan
    rows = rows_module.describe(xy, stick_figures.TRUNK)
    path = people[:, :, stick_figures.TRUNK].mean(axis=2)
    cost = linking.costs(camera, rows, path, np.zeros((2, 10)), np.array([True, False]))
    assert cost.shape == (2, 10, 3)
    own = np.delete(np.arange(10), 4)
    assert (cost[:, own].argmin(axis=2) == [[0], [1]]).all()
    assert (cost[1, 4] == 0).all()
    unsure = linking.costs(camera, rows, path, np.full((2, 10), np.inf), np.array([True, False]))
    assert (unsure[0, own].argmin(axis=1) == 0).all()  # the wanted one gets it, the other does not
    assert (unsure[0, own, 1] > unsure[0, own, 2]).all()


def test_noise_does_not_change_the_owner_and_a_cut_does():
    cost = np.zeros((1, 20, 3))
    cost[0, :, 1:] = 6.0
    cost[0, 10:, :] = [6.0, 0.0, 6.0]
    cost[0, [3, 15]] = [3.0, 1.0, 6.0]
    cut = np.zeros((1, 20), bool)
    cut[0, 10] = True
    owner = linking.follow(cost, cut, np.ones((1, 20), bool))
    assert owner[0].tolist() == [0] * 10 + [1] * 10


def test_the_cheapest_sequence_is_found():
    """Against all sequences tried one by one."""
    rng = np.random.default_rng(3)
    cost, cut = rng.uniform(0, 12, (1, 6, 3)), rng.random((1, 6)) < 0.4
    change = np.where(cut, linking.CHANGE_AT_CUT, linking.CHANGE)[0]

    def total(owners):
        moves = sum(change[t] for t in range(1, 6) if owners[t] != owners[t - 1])
        return moves + sum(cost[0, t, owner] for t, owner in enumerate(owners))

    best = min(itertools.product(range(3), repeat=6), key=total)
    owner = linking.follow(cost, cut, np.ones((1, 6), bool))[0]
    assert [2 if o == -1 else o for o in owner] == list(best)


def test_of_two_rows_the_better_one_is_the_person():
    owner = np.zeros((2, 30), int)
    owner[0, 20:] = -1
    cost = np.zeros((2, 30, 2))
    cost[0, :, 0], cost[1, :, 0] = 1.0, 2.0
    cost[0, 3::7, 0] = 4.0  # now and then the better row is worse: the rows do not take turns
    index = linking.one_row_each(owner, cost)
    assert index.tolist() == [[0] * 20 + [1] * 10]


@pytest.mark.parametrize("speed_m_s", [3.0, 5.0, 7.0])
def test_who_runs_at_the_first_instant_is_placed_from_there_on(speed_m_s):
    """Two run past each other and back; the take begins in the middle of their run."""
    x_m = 3 * np.sin(speed_m_s / 3 * STEP_S * np.arange(60))
    paths = np.stack(
        [np.stack([s * x_m, np.full(60, s * 1.5), np.ones(60)], axis=1) for s in (1, -1)]
    )
    own = np.arange(120).reshape(2, 60) + 10  # their motion alone carries them
    found, piece, time_s, person = candidates_of(paths, own)
    result = linking.link(found, piece, time_s, 4)
    assert sorted(map(sorted, persons_of(result, person))) == [[0], [1]]
    assert ((result >= 0).sum(axis=0) == 2).all()


@pytest.mark.parametrize("speed_m_s", [7.0, 9.0])
def test_who_runs_through_the_pictures_is_found_beside_who_stands(speed_m_s):
    """Never slower than this in sight, as in a sprint."""
    n = 15
    end_m = speed_m_s * STEP_S * (n - 1)
    found, piece, time_s, person = candidates_of(
        lines(n, ([3, 0, 1], [3, end_m, 1]), ([0, 4, 1], [0, 4, 1]))
    )
    found = replace(found, view_cost=2 * found.view_cost)  # as of four views
    result = linking.link(found, piece, time_s, 4)
    assert sorted(map(sorted, persons_of(result, person))) == [[0], [1]]
    assert ((result >= 0).sum(axis=0) == 2).all()


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("people", [2, 4, 8])
def test_all_are_known_in_takes_of_few_instants(people, n):
    found, piece, time_s, person = candidates_of(
        lines(n, *(([2 * x, 0, 1], [2 * x, 0.1 * n, 1]) for x in range(people)))
    )
    result = linking.link(found, piece, time_s, people + 2)
    assert sorted(map(sorted, persons_of(result, person))) == [[p] for p in range(people)]
    assert ((result >= 0).sum(axis=0) == people).all()
