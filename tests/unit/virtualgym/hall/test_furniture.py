"""Furniture: clear of players, walkers and views; posters are not mirrored."""

import dataclasses
import itertools
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court
from virtualgym.cameras import layouts
from virtualgym.hall import furniture, hall, painted_lines
from virtualgym.presets import PLAIN, RICH
from virtualgym.rendering import textured_quads

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
ROOM_M = hall.room(COURT)
CENTRE = COURT.size_m / 2


def rng(seed=0):
    return np.random.default_rng(seed)


def corners(quads):
    """Return the corners of quads, (Q, 4, 3) m."""
    return np.array(
        [[q.origin, q.origin + q.u, q.origin + q.v, q.origin + q.u + q.v] for q in quads]
    )


@pytest.fixture(scope="module")
def crates():
    many = dataclasses.replace(RICH, n_gear=400)
    return furniture.gear(COURT, ROOM_M, many, rng())


@pytest.fixture(scope="module")
def gear(crates):
    return corners(crates)


def test_gear_leaves_the_court_free(gear):
    outside = np.maximum(np.maximum(-gear[..., :2], gear[..., :2] - COURT.size_m), 0)
    assert len(gear) > 500
    assert np.hypot(*outside.T).min() > 1.0


@pytest.mark.parametrize("layout", sorted(layouts.LAYOUTS))
def test_no_point_of_the_court_is_hidden(crates, layout):
    surfaces = textured_quads.Surfaces(crates)
    for camera in layouts.fixed_cameras(layout, COURT, (1280, 720), RICH, rng()):
        eye = camera.centre_in_world
        direction = (COURT.xyz - eye).astype(np.float32)
        index = surfaces.hit(eye.astype(np.float32), direction)
        hit = np.flatnonzero(index >= 0)
        view = textured_quads.View(surfaces, eye, np.eye(3)[:2])
        assert (view.distance(index[hit], direction[hit].T, None) > 1).all(), camera.name


def test_gear_is_low_but_along_walls_behind_the_cameras(gear):
    top = gear[..., 2].max(axis=1)
    near_wall = (gear[..., :2] - ROOM_M[0, :2]).max(axis=1).min(axis=1) < 1.0
    assert top[~near_wall].max() <= furniture.LOW_M
    assert top[near_wall].max() > 0.8
    away = np.abs(gear[..., :2] - CENTRE).max(axis=2).min(axis=1)
    assert away[near_wall].min() > 21.5  # behind every camera
    # Cameras are 16 m away and more, those who walk with one as well.
    assert np.abs(gear[~near_wall][..., :2] - CENTRE).max() < 16


@pytest.mark.parametrize(
    "make", [furniture.posters, furniture.stands, furniture.stage, furniture.ceiling]
)
def test_everything_is_inside_the_hall_and_follows_its_seed(make):
    first, same = (make(ROOM_M, RICH, rng(1)) for _ in range(2))
    places = corners(first)
    assert (places >= ROOM_M[0] - 1e-9).all()
    assert (places <= ROOM_M[1] + 1e-9).all()
    for one, other in zip(first, same, strict=True):
        np.testing.assert_array_equal(one.texture, other.texture)
        np.testing.assert_array_equal(one.origin, other.origin)


def test_posters_face_the_court_and_read_from_left_to_right():
    posters = furniture.posters(ROOM_M, RICH, rng())
    assert 50 < len(posters) < 150
    for poster in posters:
        middle = poster.origin + (poster.u + poster.v) / 2
        inward = np.cross(poster.v, poster.u)
        assert inward[:2] @ (CENTRE - middle[:2]) > 0
        to_wall = np.abs(middle[:2] - ROOM_M[:, :2]).min()
        assert 0.01 < to_wall < 0.25
    assert len(furniture.posters(ROOM_M, PLAIN, rng())) < len(posters) / 4


def test_posts_and_tape_are_where_the_net_says():
    net = painted_lines.paint_court(COURT, PLAIN, rng()).net
    made = furniture.net(net)
    tops = [quad for quad in made if quad.light > 1 and np.allclose(quad.u[2] + quad.v[2], 0)]
    middles = np.array([top.origin + (top.u + top.v) / 2 for top in tops])
    np.testing.assert_allclose(middles, net.tips, atol=1e-12)
    tape = made[12:]
    np.testing.assert_allclose(tape[0].origin, net.tips[0])
    np.testing.assert_allclose(tape[-1].origin + tape[-1].u, net.tips[1], atol=1e-12)
    for before, after in itertools.pairwise(tape):
        np.testing.assert_allclose(before.origin + before.u, after.origin, atol=1e-12)
