"""What is up by the pictures alone, and how far it is off."""

import numpy as np
import pytest

from courtside.calibration import vertical
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
