"""What is up by the pictures alone, and how far it is off."""

import numpy as np
import pytest

from courtside.calibration import vertical
from courtside.geometry import camera as camera_models
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.geometry.similarity import Sim3


def filming(rng, sides, pitch_deg, roll_deg):
    """Return cameras that look from some sides (rad) to a place, pitched and rolled by chance."""
    found = []
    for k, side in enumerate(sides):
        place = np.array([6 * np.cos(side), 6 * np.sin(side), 2.0])
        ahead = -place / np.linalg.norm(place)
        pitch = np.radians(rng.normal(pitch_deg, 5))
        ahead = np.array([*np.cos(pitch) * rotations.unit(ahead[:2]), np.sin(pitch)])
        right = rotations.unit(np.cross(ahead, [0, 0, 1.0]))
        level = np.stack([right, np.cross(ahead, right), ahead])
        turn = rotations.rotation_from_rodrigues([0, 0, np.radians(rng.normal(0, roll_deg))])
        pose = np.column_stack([turn @ level, -turn @ level @ place])
        found.append(Camera(f"c{k}", (640, 480), np.eye(3), np.zeros(5), pose))
    return found


@pytest.mark.parametrize("sides", [(0, 1.6, 3.2, 4.7), (0.0, 0.7, 1.4), (0.2, 0.5)])
@pytest.mark.parametrize("pitch_deg", [0, -20])
def test_the_error_of_a_vertical_by_pictures_covers_what_it_is_off(sides, pitch_deg):
    rng, off = np.random.default_rng(1), []
    for _ in range(40):
        cameras = filming(rng, sides, pitch_deg, 4)
        up = vertical.up_in_pictures(cameras)
        turn = vertical.axes(up, np.array([1.0, 0, 0]))
        moved = [Sim3(1.0, turn, np.zeros(3)).camera(camera) for camera in cameras]
        frame = vertical.error_of_pictures(moved)
        true = turn @ [0, 0, 1.0]  # the vertical in that frame
        rotation = np.array([-true[1], true[0]])  # about x and y, that turns z to it
        off.append(rotation @ np.linalg.solve(frame[:2, :2], rotation))
        assert not frame[2].any()
    assert 0.7 < np.mean(off) < 4  # 2 if it is right


def held(places, targets, roll_deg=0.0):
    """Return cameras at places that look to targets (N, 3)."""
    rolls = np.radians(np.broadcast_to(roll_deg, len(places)))
    poses = [camera_models.look_at(*one) for one in zip(places, targets, rolls, strict=True)]
    return [
        Camera(f"c{k}", (640, 480), np.eye(3), np.zeros(5), pose) for k, pose in enumerate(poses)
    ]


def off_deg(cameras):
    return np.degrees(np.arccos(np.clip(vertical.up_in_pictures(cameras)[2], -1, 1)))


def around(degrees, height_m=2.8, away_m=4.0):
    angles = np.radians(degrees)
    return np.stack([away_m * np.cos(angles), away_m * np.sin(angles), 0 * angles + height_m], 1)


@pytest.mark.parametrize("count", [2, 4, 8])
def test_cameras_along_one_wall_all_look_down(count):
    """Their common angle is not better known from many."""
    cameras = held(around(np.linspace(-6, 6, count)), np.tile([0, 0, 1.0], (count, 1)))
    stated = vertical.sigma_deg(vertical.error_of_pictures(cameras))
    assert off_deg(cameras) < 2 * stated
    assert not vertical.is_unknown(cameras)


WALL = np.array([[0, 0, 3.0], [1.5, 0, 3], [3, 0, 3], [4.5, 0, 3]])
QUARTERS = around([0, 90, 180, 270])
AHEAD, DOWN = np.array([0, 4.3, -2.0]), np.array([0, 0.01, -3])
MIDDLE = np.tile([0, 0, 1.0], (4, 1))


@pytest.mark.parametrize(
    ("cameras", "unknown"),
    [
        (held(WALL, WALL + AHEAD), True),  # in parallel
        (held(WALL, WALL + DOWN), True),  # straight down
        (held(QUARTERS, MIDDLE, 90), True),  # all on their side
        (held(QUARTERS[:2], MIDDLE[:2], [0, 180]), True),  # one upside down
        (held(QUARTERS[[0, 2]], MIDDLE[:2]), True),  # face to face
        (held(QUARTERS, MIDDLE, [0, 0, 0, 180]), False),  # one of four upside down
        (held(QUARTERS, MIDDLE), False),
        (held(around([0, 90, 180, 270], 12, 3), MIDDLE * 0), False),  # 76 degrees down
    ],
)
def test_pictures_do_not_always_tell_what_is_up(cameras, unknown):
    assert vertical.is_unknown(cameras) == unknown
    assert ("do not tell what is up" in vertical.words(cameras)) == unknown
    assert unknown or off_deg(cameras) < 3
