"""Rows named frame by frame by the paths they follow."""

import itertools

import numpy as np

from courtside.reconstruction.association import associate, linking
from fixtures.cameras import scene
from fixtures.people import stick_figures


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
    rows = associate.describe(xy, stick_figures.TRUNK)
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
