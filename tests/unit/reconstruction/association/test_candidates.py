"""Places where rows of several views meet, against exact scenes and OpenCV's epipolar lines."""

import numpy as np
import pytest

from courtside.reconstruction.association import associate, candidates
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
    rows = [associate.describe(view, stick_figures.TRUNK) for view in xy]
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
    rows = [associate.describe(view, stick_figures.TRUNK) for view in xy]
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
    rows = [associate.describe(view, stick_figures.TRUNK) for view in xy]
    rays = candidates.rays(cameras, [(r.centre, r.sigma_px) for r in rows], find(cameras, xy))
    assert len(rays.instant) == 0
