"""Simulated ties: on the hall's surfaces, in the pictures, as many as a session's."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from courtside.calibration.bundle import problem, selection
from courtside.calibration.planning import cameras, tie_points
from courtside.calibration.planning.tie_points import Texture
from fixtures.cameras import hall_plan, scene

PRIOR = (hall_plan.LENS_MEAN, hall_plan.LENS_SIGMA)


def made(count, texture=hall_plan.PLAIN, seed=0):
    fixed, walked = hall_plan.fixed(), hall_plan.walked(count)
    rng = np.random.default_rng(seed)
    return [*fixed, *walked], tie_points.network(
        fixed, walked, hall_plan.HALL_M, texture, PRIOR, rng
    )


@pytest.fixture(scope="module")
def twenty():
    return made(20)


def test_points_are_on_walls_and_floor():
    xyz = tie_points.points_on_surfaces(
        [[0, 0, 0], [30, 10, 5]], 20000, 0.25, np.random.default_rng(0)
    )
    x, y, z = xyz.T
    on_floor = z == 0
    on_wall = (x == 0) | (x == 30) | (y == 0) | (y == 10)
    assert (on_floor | on_wall).all()
    assert on_floor.mean() == pytest.approx(0.25, abs=0.01)
    # By area: the long walls are three times the short ones.
    assert ((y == 0) | (y == 10)).sum() / on_wall.sum() == pytest.approx(0.75, abs=0.02)
    assert xyz.min(axis=0) == pytest.approx([0, 0, 0], abs=0.01)
    assert xyz.max(axis=0) == pytest.approx([30, 10, 5], abs=0.01)


def test_observations_are_where_opencv_sees_the_points(twenty):
    images, found = twenty
    for at in (0, 1, 7):
        mine = found.image_idx == at
        xy = scene.opencv_projection(images[at], found.xyz[found.point_idx[mine]])
        assert found.xy[mine] == pytest.approx(xy, abs=1e-6)
        assert ((xy >= -0.5) & (xy <= np.array(images[at].size) - 0.5)).all()
    assert np.bincount(found.point_idx).min() >= 2
    assert np.abs(problem.residuals(found)).max() < 1e-9


def test_fixed_cameras_have_their_own_lenses_and_the_walk_one(twenty):
    _, found = twenty
    assert found.lens_of_image.tolist() == [0, 1] + [2] * 20
    assert found.lens.shape == (3, 8)


def test_as_many_ties_as_the_study_counted():
    """Of plain-a after thinning (`results/plain-a/sfm/global-n*-o0`): images per point too."""
    for count, per_image, length in ((20, 311, 4.7), (40, 383, 6.8)):
        _, found = made(count)
        found = selection.thin(found, **hall_plan.THINNING | {"max_points": 10**6})
        assert np.median(np.bincount(found.image_idx)) == pytest.approx(per_image, rel=0.15)
        assert len(found.xy) / len(found.xyz) == pytest.approx(length, rel=0.25)


def test_lives_limit_the_angle_under_which_a_point_is_tied():
    short = Texture(300, (0.5, 3.0), (0.5, 0.5), 0.3, 0.0)
    long = Texture(300, (0.5, 30.0), (0.5, 0.5), 0.3, 0.0)
    views = [np.bincount(made(20, texture)[1].point_idx).mean() for texture in (short, long)]
    assert views[1] > 1.8 * views[0]


def test_the_walk_decides_the_order(twenty):
    images, _ = twenty
    order = tie_points.path_order(images[:2], images[2:], np.mean(hall_plan.HALL_M, axis=0))
    assert order.tolist() == [0, *range(2, 22), 1]


@pytest.mark.parametrize(
    "places",
    [
        [(-20, 0), (-20, 1), (0, 20), (1, 20)],  # two pairs
        [(-6, 20), (-2, 20), (2, 20), (6, 20)],  # along one side
        [(20, -5), (-20, -5), (-20, 5), (20, 5)],
    ],
)
def test_without_a_walk_neighbours_follow_each_other_however_cameras_are_listed(places):
    aim = (0.0, 0.0, 1.0)
    fixed = [cameras.camera("c", (*xy, 2.0), aim, (1280, 720), fov_deg=60.0) for xy in places]
    for listed in permutations(range(4)):
        order = tie_points.path_order([fixed[at] for at in listed], [], np.zeros(3))
        path = np.array(places)[[listed[at] for at in order]]
        steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
        shortest = min(
            np.linalg.norm(np.diff(np.array(one), axis=0), axis=1).sum()
            for one in permutations(places)
        )
        assert steps.sum() == pytest.approx(shortest)


def test_a_turned_camera_has_as_many_features():
    fixed, walked = hall_plan.fixed(), hall_plan.walked(10)
    counts = []
    for turned in ((), fixed, [*fixed, *walked]):
        images = [scene.quarter_turned(c) if c in turned else c for c in [*fixed, *walked]]
        rng = np.random.default_rng(0)
        found = tie_points.network(
            images[:2], images[2:], hall_plan.HALL_M, hall_plan.PLAIN, PRIOR, rng
        )
        counts.append(np.bincount(found.image_idx, minlength=12).tolist())
    assert counts[0] == counts[1] == counts[2]


def test_a_smaller_picture_has_fewer_features():
    fixed, walked = hall_plan.fixed(), hall_plan.walked(10)
    K = walked[0].K / 2
    K[2, 2] = 1
    small = [replace(camera, size=(640, 360), K=K) for camera in walked]
    counts = []
    for images in (walked, small):
        rng = np.random.default_rng(0)
        found = tie_points.network(fixed, images, hall_plan.HALL_M, hall_plan.PLAIN, PRIOR, rng)
        counts.append(np.bincount(found.image_idx, minlength=12)[2:].mean())
    assert 0.25 < counts[1] / counts[0] < 0.6  # half the features, and fewer of them meet another
