"""Places where rows of several views meet, against exact scenes and OpenCV's epipolar lines."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from courtside.geometry import camera as camera_models
from courtside.reconstruction.association import candidates
from courtside.reconstruction.association import rows as rows_module
from fixtures.cameras import scene
from fixtures.people import stick_figures

TIMES = np.arange(6) / 30


def bodies(*places):
    """Return (P, T, 12, 3) people who walk slowly at places."""
    return np.stack(
        [
            stick_figures.body(np.array(place) + np.outer(TIMES, [0.5, 0.2]), TIMES, phase=0.1 * at)
            for at, place in enumerate(places)
        ]
    )


def seen(cameras, people):
    flat = [scene.opencv_projection(camera, people.reshape(-1, 3)) for camera in cameras]
    return [xy.reshape(*people.shape[:3], 2) for xy in flat]


def find(cameras, xy):
    rows = [rows_module.describe(view, stick_figures.TRUNK) for view in xy]
    return candidates.find(
        cameras, xy, [(r.centre, r.sigma_px) for r in rows], [r.height_px for r in rows]
    )


def test_two_people_are_found_at_their_places_in_all_views():
    cameras, people = scene.ring(4, radius_m=12), bodies([0.5, 0.5], [-1, 0])
    found = find(cameras, seen(cameras, people))
    cost = found.view_cost.sum(axis=1)
    for person in range(2):
        middle = people[person][:, stick_figures.TRUNK].mean(axis=1)
        for t in range(len(TIMES)):
            here = np.flatnonzero((found.instant == t) & (found.row == person).all(axis=1))
            assert len(here) == 1
            # A mean of joints is not quite projected to the mean of their projections.
            assert np.linalg.norm(found.xyz[here[0]] - middle[t]) < 0.02
            assert cost[here[0]] == pytest.approx(-4 * candidates.VIEW_GAIN, abs=0.1)


@pytest.mark.parametrize("elevation_deg", [30, 60, 80])
def test_a_camera_above_agrees_with_a_level_one(elevation_deg):
    """From above, a person who stands is much shorter in the picture."""
    level, _ = scene.ring(2, radius_m=8, height_m=1.0)
    up = np.radians(elevation_deg)
    centre = [0.0, 8 * np.cos(up), 1 + 8 * np.sin(up)]
    above = replace(level, name="above", cam_from_world=scene.look_at(centre, (0, 0, 1.0)))
    found = find([level, above], seen([level, above], bodies([0.0, 0.0])))
    assert found.instant.tolist() == list(range(len(TIMES)))
    # The place is worth more than a row that no other view confirms.
    assert (found.view_cost.sum(axis=1) < -candidates.RAY_GAIN).all()


@pytest.mark.parametrize("height_m", [0.3, 1.0, 2.5])
def test_who_lies_on_the_floor_is_found(height_m):
    x, y, z = np.moveaxis(bodies([0.0, 0.0]), -1, 0)
    lying = np.stack([z - 0.8, y, 0.2 + 0.3 * x], axis=-1)
    cameras = scene.ring(3, radius_m=6, height_m=height_m)
    found = find(cameras, seen(cameras, lying))
    every = (found.row == 0).all(axis=1)
    assert found.instant[every].tolist() == list(range(len(TIMES)))


def test_ghosts_cost_more_than_people():
    cameras, people = scene.ring(3, radius_m=12), bodies([0.5, 0.5], [-1, 0])
    found = find(cameras, seen(cameras, people))
    true = np.array([len(set(row[row >= 0])) == 1 for row in found.row])
    cost = found.view_cost.sum(axis=1)
    assert true.any()
    assert cost[true & (found.row >= 0).all(axis=1)].max() < cost[~true].min(initial=np.inf) - 3


def test_views_from_opposite_sides_are_unsure_along_their_line():
    cameras, people = scene.ring(4, radius_m=12), bodies([0.0, 0.0])
    xy = seen(cameras, people)
    across = find(cameras[:2], xy[:2])
    opposite = find([cameras[0], cameras[2]], [xy[0], xy[2]])
    assert len(across.instant) == len(TIMES)
    assert across.sigma_m.max() < 0.1
    assert len(opposite.instant) == 0 or opposite.sigma_m.min() > 5 * across.sigma_m.max()


def test_a_person_hidden_in_one_view_is_found_without_it():
    cameras, people = scene.ring(3, radius_m=12), bodies([0.5, 0.5], [-1, 0])
    xy = seen(cameras, people)
    xy[1][0] = np.nan
    found = find(cameras, xy)
    wanted = (found.row == [0, -1, 0]).all(axis=1)
    assert sorted(set(found.instant[wanted])) == list(range(len(TIMES)))


def test_rays_lead_from_the_camera_through_what_it_sees():
    cameras, people = scene.ring(2, radius_m=12), bodies([0.5, 0.5])
    xy = seen(cameras, people)
    rows = [rows_module.describe(view, stick_figures.TRUNK) for view in xy]
    centres = [(r.centre, r.sigma_px) for r in rows]
    found = find(cameras, xy)
    rays = candidates.rays(cameras, centres, found)
    assert len(rays.instant) == 2 * len(TIMES)  # two views are not enough to be sure
    assert rays.is_ray.all()
    assert not found.is_ray.any()
    middle = people[0][:, stick_figures.TRUNK].mean(axis=1)[rays.instant]
    toward = middle - rays.xyz
    off = np.linalg.norm(np.cross(toward, rays.direction), axis=1)
    assert off.max() < 0.02
    assert ((toward * rays.direction).sum(axis=1) > 10).all()
    camera = np.argmax(rays.row >= 0, axis=1)
    for c in range(2):
        np.testing.assert_allclose(rays.xyz[camera == c] - cameras[c].centre_in_world, 0, atol=1e-9)


def test_what_three_views_agree_on_needs_no_ray():
    cameras, people = scene.ring(3, radius_m=12), bodies([0.5, 0.5])
    xy = seen(cameras, people)
    rows = [rows_module.describe(view, stick_figures.TRUNK) for view in xy]
    rays = candidates.rays(cameras, [(r.centre, r.sigma_px) for r in rows], find(cameras, xy))
    assert len(rays.instant) == 0


MIRROR = [1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10]


def test_epipolar_distance_is_opencvs():
    one, other = scene.ring(2)
    rng = np.random.default_rng(1)
    first, second = rng.uniform(300, 900, (1, 1, 7, 2)), rng.uniform(300, 900, (1, 1, 7, 2))
    rotation = other.cam_from_world[:, :3] @ one.cam_from_world[:, :3].T
    x, y, z = other.cam_from_world[:, 3] - rotation @ one.cam_from_world[:, 3]
    inverse = np.linalg.inv(one.K)
    fundamental = inverse.T @ np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ rotation @ inverse
    distances = []
    for which, here, there in ((1, first, second), (2, second, first)):
        lines = cv2.computeCorrespondEpilines(here.reshape(-1, 1, 2), which, fundamental)[:, 0]
        distances.append(np.abs((lines[:, :2] * there[0, 0]).sum(axis=1) + lines[:, 2]))
    plane = [(xy - [959.5, 539.5]) / scene.FOCAL_PX for xy in (first, second)]
    found = candidates.epipolar_distance(one, other, *plane)
    assert found.shape == (1, 1, 1)
    assert found[0, 0, 0] == pytest.approx(np.median(np.mean(distances, axis=0)), rel=1e-6)


def test_two_joints_in_common_say_nothing():
    one, other = scene.ring(2)
    xy = np.full((1, 1, 5, 2), np.nan)
    xy[..., :2, :] = 0.1
    assert np.isinf(candidates.epipolar_distance(one, other, xy, xy)).all()


def planes(cameras):
    """Return what cameras see of two people, on the normalised plane."""
    time_s = np.arange(5) / 30
    people = np.stack(
        [
            stick_figures.body(np.outer(time_s, [1.0, 0.3]) + start, time_s)
            for start in ([0.5, 0.5], [-1, 0])
        ]
    )
    flat = [scene.opencv_projection(camera, people.reshape(-1, 3)) for camera in cameras]
    return [
        camera_models.undistort(camera, xy.reshape(2, 5, 12, 2))
        for camera, xy in zip(cameras, flat, strict=True)
    ]


def test_rows_of_one_body_agree_and_others_do_not():
    cameras = scene.ring(3)
    pairs = candidates.pair_distances(cameras, planes(cameras), [np.full(2, 4.0)] * 3)
    assert sorted(pairs) == [(0, 1), (0, 2), (1, 2)]
    for distance in pairs.values():
        assert distance.shape == (2, 2, 5)
        assert distance[[0, 1], [0, 1]].max() < 1e-6
        assert distance[[0, 1], [1, 0]].min() > 1
    row = np.array([[0, 0, 0], [0, 0, 1], [1, -1, 1]])
    off = candidates.view_distances(pairs, np.zeros(3, int), row, 8.0)
    assert off[0].max() < 1e-6
    assert off[1, 2] > off[1, 0] > 0.5
    assert off[2].tolist() == pytest.approx([0, 0, 0], abs=1e-6)
    assert off[1, 2] <= 8


def test_a_view_that_takes_left_for_right_still_agrees():
    cameras = scene.ring(2, radius_m=5)
    one, other = planes(cameras)
    sigma = [np.full(2, 4.0)] * 2
    turned = [one, other[:, :, MIRROR]]
    plain = candidates.pair_distances(cameras, turned, sigma)[0, 1]
    either = candidates.pair_distances(cameras, turned, sigma, MIRROR)[0, 1]
    assert plain[[0, 1], [0, 1]].min() > 0.5
    assert either[[0, 1], [0, 1]].max() < 1e-6
