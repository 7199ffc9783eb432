"""True depth of halls and moving bodies, against the geometry of planes and balls."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.geometry import camera as cameras
from fixtures.cameras import balls, small_hall
from virtualgym.devices import depth_camera
from virtualgym.hall import painted_lines
from virtualgym.rendering.hall_renderer import Renderer

SIZE = (320, 180)
CAMERA = replace(small_hall.camera(size=SIZE), dist=np.zeros(5))
PLACE = np.array([4.0, 4.5, 1.2])
SIDES_M = np.array([1.6, 1.2, 1.8])


@pytest.fixture(scope="module")
def renderer():
    return Renderer(small_hall.scene())


def directions(camera=CAMERA):
    """Return the ray of each pixel in the world, of depth 1, (H, W, 3)."""
    column, row = np.meshgrid(*map(np.arange, camera.size))
    xy = cameras.undistort(camera, np.stack([column, row], axis=-1).astype(float))
    ahead = np.concatenate([xy, np.ones((*xy.shape[:2], 1))], axis=-1)
    return ahead @ camera.cam_from_world[:, :3]


def ball_depth(place, radius, camera=CAMERA):
    """Return the depth of a ball (H, W); inf where it is not seen."""
    ways, eye = directions(camera), camera.centre_in_world
    a, b = (ways**2).sum(-1), ways @ (eye - place)
    c = (eye - place) @ (eye - place) - radius**2
    inside = b**2 - a * c
    with np.errstate(invalid="ignore"):
        return np.where(inside > 0, (-b - np.sqrt(inside)) / a, np.inf)


@pytest.mark.parametrize("camera", [CAMERA, small_hall.camera(size=SIZE)])
def test_an_empty_room_is_as_deep_as_its_planes(renderer, camera):
    found = depth_camera.of_hall(renderer, camera)
    ways, eye = directions(camera), camera.centre_in_world
    low, high = np.asarray(small_hall.ROOM_M, float)
    with np.errstate(divide="ignore"):
        away = np.where(ways > 0, (high - eye) / ways, (low - eye) / ways)
    np.testing.assert_allclose(found, away.min(axis=-1), rtol=2e-5)


def test_the_net_is_not_seen(renderer):
    net = painted_lines.Net.__new__(painted_lines.Net)  # never asked for anything
    with_net = Renderer(small_hall.scene(net=net))
    expected = depth_camera.of_hall(renderer, CAMERA)
    np.testing.assert_array_equal(depth_camera.of_hall(with_net, CAMERA), expected)


def test_a_still_ball_has_its_depth():
    found = depth_camera.of_athletes([balls.Ball(PLACE)], CAMERA, 0.0, 0.02)
    true = ball_depth(PLACE, 0.3)
    both = np.isfinite(found) & np.isfinite(true)
    assert both.sum() > 500 and (np.isfinite(found) != np.isfinite(true)).sum() < 0.06 * both.sum()
    inner = np.isfinite(ball_depth(PLACE, 0.27))
    # The mesh has 24 rings: flat pieces lie up to 0.3 (1 - cos(pi / 24)) = 2.6 mm inside the ball, along the
    # ray up to twice that.
    error = found[inner] - true[inner]
    assert error.min() > -1e-4 and error.max() < 0.008 and np.median(error) < 0.003


def test_a_flat_side_is_exact_between_its_corners():
    low = np.array([3.0, 4.0, 0.4])
    plate = balls.Plate(low, low + SIDES_M)
    found = depth_camera.of_athletes([plate], CAMERA, 0.0, 0.0)
    ways, eye = directions(), CAMERA.centre_in_world
    planes = (np.stack([low, low + SIDES_M]) - eye)[:, None, None] / ways
    entry = planes.min(axis=0).max(axis=-1)
    seen = np.isfinite(found)
    assert seen.sum() > 2000
    np.testing.assert_allclose(found[seen], entry[seen], rtol=1e-4)


def test_each_row_has_its_own_time():
    readout_s, velocity = 0.4, np.array([0.6, 0.9, 0.0])
    moving = balls.Ball(PLACE + np.array([0, 0, 0.8]), velocity)
    found = depth_camera.of_athletes([moving], CAMERA, 0.3, readout_s)
    rows = np.flatnonzero(np.isfinite(found).sum(axis=1) > 10)
    assert rows.mean() < 70, "well above the middle"
    for row in rows[3:-3:5]:
        own_s = 0.3 + ((row + 0.5) / SIZE[1] - 0.5) * readout_s
        true = ball_depth(moving.centre(own_s), 0.3)[row]
        both = np.isfinite(found[row]) & np.isfinite(true)
        assert np.median(np.abs(found[row][both] - true[both])) < 0.004
    late = ball_depth(moving.centre(0.3), 0.3)[rows]
    both = np.isfinite(found[rows]) & np.isfinite(late)
    assert np.median(np.abs(found[rows][both] - late[both])) > 0.02


def test_the_nearer_of_two_hides_the_other_and_what_is_behind_is_not_seen():
    eye = CAMERA.centre_in_world
    near = eye + 0.6 * (PLACE - eye)
    both = depth_camera.of_athletes(
        [balls.Ball(PLACE), balls.Ball(near), balls.Ball(eye - (PLACE - eye))], CAMERA, 0.0, 0.0
    )
    alone = depth_camera.of_athletes([balls.Ball(near)], CAMERA, 0.0, 0.0)
    seen = np.isfinite(alone)
    np.testing.assert_array_equal(both[seen], alone[seen])
    assert not np.isfinite(
        depth_camera.of_athletes([balls.Ball(eye - (PLACE - eye))], CAMERA, 0.0, 0.0)
    ).any()
