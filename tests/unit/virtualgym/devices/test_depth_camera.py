"""The virtual depth camera: its place, true depth by geometry, pictures that show the truth."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.geometry import camera as cameras
from courtside.geometry import rotations
from fixtures.cameras import balls, small_hall
from virtualgym.devices import depth_camera
from virtualgym.devices.depth_camera import DepthCamera
from virtualgym.hall import painted_lines
from virtualgym.rendering.hall_renderer import Renderer

SMALL = DepthCamera(distance_m=2.5, size_px=(320, 180), depth_size_px=(256, 144), azimuth_deg=30.0)
EXACT = {"subpixel_px": 0.0, "holes": 0.0, "edge_holes": 0.0, "noise_sigma": 0.0}


class Stance:
    pelvis = np.array([4.0, 4.0, 0.9])
    # Left, up and ahead: faces along y.
    world_from_pelvis = np.array([[-1.0, 0, 0], [0, 0, 1], [0, 1, 0]]).T


class Standing(balls.Ball):
    """A red ball where a player would be, who faces along y."""

    class motion:
        @staticmethod
        def stance(time_s):
            return Stance


PLAYER = Standing((4.1, 4.2, 1.1), bgr=(0, 0, 255), radius_m=0.35)


def recorder(settings=SMALL, player=PLAYER, seed=3):
    colour, depth = settings.place("cam", player)
    renderer = Renderer(small_hall.scene(texture=np.full((4, 4, 3), (30, 180, 30), np.uint8)))
    made = depth_camera.Recorder(
        settings, colour, depth, renderer, [player], np.random.SeedSequence(seed)
    )
    return colour, depth, made


@pytest.fixture(scope="module")
def exact():
    return recorder(DepthCamera(**{**vars(SMALL), **EXACT}))


def test_a_depth_camera_stands_where_told_and_looks_at_the_player():
    colour, depth = SMALL.place("cam", PLAYER)
    away = depth.centre_in_world - [4.0, 4.0, 1.0]
    np.testing.assert_allclose(away[2], 0, atol=1e-9)
    assert np.hypot(*away[:2]) == pytest.approx(2.5)
    left, ahead = Stance.world_from_pelvis[:, 0], Stance.world_from_pelvis[:, 2]
    assert np.degrees(np.arctan2(away @ left, away @ ahead)) == pytest.approx(30.0)
    middle = cameras.project(depth, np.array([4.0, 4.0, 1.0]))
    np.testing.assert_allclose(middle, [127.5, 71.5], atol=1e-6)
    assert (colour.name, depth.name) == ("cam", "cam-depth")


def test_a_depth_camera_has_the_data_sheets_field_of_view():
    for camera in SMALL.place("cam", PLAYER):
        width, height = camera.size
        across, down = np.diag(camera.K)[:2]
        assert np.degrees(2 * np.arctan(width / 2 / across)) == pytest.approx(69.4)
        assert np.degrees(2 * np.arctan(height / 2 / down)) == pytest.approx(42.5)


def test_the_sensors_are_apart_by_the_known_transform():
    colour, depth = SMALL.place("cam", PLAYER)
    point = np.array([4.3, 4.4, 1.3, 1.0])
    moved = SMALL.colour_from_depth @ np.append(depth.cam_from_world @ point, 1.0)
    np.testing.assert_allclose(moved, colour.cam_from_world @ point, atol=1e-12)
    apart = colour.centre_in_world - depth.centre_in_world
    assert np.linalg.norm(apart) == pytest.approx(0.015)
    turn = SMALL.colour_from_depth[:, :3]
    angle = np.degrees(np.linalg.norm(rotations.rodrigues_from_rotation(turn)))
    assert 0.1 < angle < 0.5


def test_colour_and_depth_show_the_same_ball(exact):
    colour, depth, made = exact
    bgr, steps = made.frame(0, 0.0)
    assert (bgr.shape, bgr.dtype) == ((180, 320, 3), np.uint8)
    assert (steps.shape, steps.dtype) == ((144, 256), np.uint16)
    red = (bgr[..., 2].astype(int) - bgr[..., 1]) > 60
    found = np.array([axis.mean() for axis in np.nonzero(red)[::-1]])
    np.testing.assert_allclose(found, cameras.project(colour, PLAYER.place), atol=1.0)
    row, column = np.rint(cameras.project(depth, PLAYER.place)).astype(int)[::-1]
    way = PLAYER.place - depth.centre_in_world
    nearest = depth.cam_from_world[2] @ np.append(
        PLAYER.place - 0.35 * way / np.linalg.norm(way), 1
    )
    assert steps[row, column] * 0.001 == pytest.approx(nearest, abs=0.004)
    # Every depth, seen by the colour camera, is red where it is the ball's.
    rows, columns = np.nonzero((steps > 0) & (steps < 1000 * (nearest + 0.3)))
    z = steps[rows, columns] * 0.001
    xy = cameras.undistort(depth, np.stack([columns, rows], axis=-1).astype(float))
    points = np.column_stack([xy * z[:, None], z, np.ones(len(z))]) @ SMALL.colour_from_depth.T
    px = points[:, :2] / points[:, 2:] * np.diag(colour.K)[:2] + colour.K[:2, 2]
    inside = np.rint(px).astype(int)
    assert len(z) > 500 and red[inside[:, 1], inside[:, 0]].mean() > 0.97


def test_depth_scatters_about_the_true_surface_as_the_formula_says():
    settings = DepthCamera(**{**vars(SMALL), "edge_holes": 0.0, "holes": 0.0})
    _, _, made = recorder(settings)
    true = made.true_depth_m(0.0)
    pairs = [(made.frame(k, 0.0)[1] * 0.001, true) for k in range(6)]
    found, true = (np.concatenate([pair[k].ravel() for pair in pairs]) for k in (0, 1))
    known = (found > 0) & (true > 1.5) & (true < 6)
    focal = 128 / np.tan(np.radians(69.4 / 2))
    sigma = true[known] ** 2 * 0.08 / (focal * 0.055)
    scores = (found - true)[known] / sigma
    # An error that grows with depth leaves a little more above than below.
    assert scores.std() == pytest.approx(1.0, abs=0.1) and abs(np.median(scores)) < 0.1


def test_frames_depend_on_seed_and_number_only(exact):
    first, second = (recorder()[2] for _ in range(2))
    for a, b in zip(first.frame(7, 0.1), second.frame(7, 0.1), strict=True):
        np.testing.assert_array_equal(a, b)
    for a, b in zip(first.frame(8, 0.1), second.frame(7, 0.1), strict=True):
        assert (a != b).mean() > 0.1
    other = recorder(seed=4)[2].frame(7, 0.1)
    assert (other[1] != first.frame(7, 0.1)[1]).mean() > 0.1


def test_frames_show_their_own_time():
    colour, _ = SMALL.place("cam", PLAYER)
    moving = Standing(PLAYER.place, (0.5, 0, 0.0), bgr=(0, 0, 255), radius_m=0.35)
    _, _, made = recorder(DepthCamera(**{**vars(SMALL), **EXACT}), moving)
    for time_s in (-0.5, 0.5):
        bgr, _ = made.frame(0, time_s)
        red = (bgr[..., 2].astype(int) - bgr[..., 1]) > 60
        found = np.array([axis.mean() for axis in np.nonzero(red)[::-1]])
        np.testing.assert_allclose(found, cameras.project(colour, moving.centre(time_s)), atol=1.5)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"distance_m": 0}, "distance_m above 0"),
        ({"rate_hz": -1}, "rate_hz above 0"),
        ({"range_m": [4, 2]}, "range_m as"),
    ],
)
def test_impossible_cameras_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        DepthCamera(**change)


# True depth of halls and moving bodies, against the geometry of planes and balls.

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
    # The mesh has 24 rings: flat pieces lie up to 0.3 (1 - cos(pi / 24)) = 2.6 mm inside the ball,
    # along the ray up to twice that.
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
