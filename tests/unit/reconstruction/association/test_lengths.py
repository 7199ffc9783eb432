"""Lengths of bones of followed people, against people made of sticks of known size."""

import numpy as np

from courtside.reconstruction.association import lengths
from courtside.reconstruction.association.candidates import Candidates
from courtside.reconstruction.association.identity import Followed
from fixtures.cameras import scene
from fixtures.people import stick_figures

TIMES = np.arange(10) * 0.1


def test_bones_are_those_whose_joints_are_there():
    assert len(lengths.bones(stick_figures.NAMES)) == 8
    assert lengths.bones(["left_hip", "left_knee", "right_hip"]) == [(0, 1)]


def test_lengths_are_those_of_the_bodies_and_nothing_without_two_views():
    cameras = scene.ring(3, radius_m=12)
    places = [np.tile(place, (10, 1)) + np.outer(TIMES, [0.4, 0]) for place in ([0, 1], [0, -1])]
    people = np.stack(
        [stick_figures.body(p, TIMES, s) for p, s in zip(places, (1, 0.9), strict=True)]
    )
    flat = [scene.opencv_projection(c, people.reshape(-1, 3)) for c in cameras]
    xy = [view.reshape(2, 10, 12, 2) for view in flat]
    row = np.tile(np.repeat([0, 1], 10)[:, None], (1, 3))
    row[:5, 1:] = -1
    found = Candidates(
        instant=np.tile(np.arange(10), 2), xyz=np.zeros((20, 3)), direction=np.zeros((20, 3)),
        row=row, sigma_m=np.zeros(20), view_cost=np.zeros((20, 3)),
    )  # fmt: skip
    chosen = np.arange(20).reshape(2, 10)
    followed = Followed(chosen, np.full((2, 10), -1), found, np.zeros((20, 3), int))
    pairs = lengths.bones(stick_figures.NAMES)
    sizes = lengths.of_people(cameras, xy, np.arange(10), followed, pairs)
    true = np.stack(
        [np.linalg.norm(people[:, :, a] - people[:, :, b], axis=-1) for a, b in pairs], axis=-1
    )
    assert np.isnan(sizes[0, :5]).all()
    np.testing.assert_allclose(sizes[0, 5:], true[0, 5:], atol=1e-6)
    np.testing.assert_allclose(sizes[1], true[1], atol=1e-6)
    assert lengths.of_people(cameras, xy, np.arange(10), followed, []).shape == (2, 10, 0)
