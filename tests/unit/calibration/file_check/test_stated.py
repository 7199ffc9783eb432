"""Cameras that no calibration may state; right ones of any arrangement pass."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.file_check import stated
from courtside.study.errors import InputError
from fixtures.cameras import scene

RING = scene.ring(4)


def posed(camera, pose):
    return replace(camera, cam_from_world=np.asarray(pose))


def test_right_cameras_pass():
    for count in range(5):
        stated.check("hall.toml", scene.ring(4)[:count])


def test_two_cameras_of_one_pose_are_named():
    first, second, *others = RING
    same = [first, posed(second, first.cam_from_world), *others]
    message = r"^hall.toml: cameras c0 and c1: expected a pose of its own for each, found one and"
    with pytest.raises(InputError, match=message):
        stated.check("hall.toml", same)


def test_cameras_in_one_place_that_look_elsewhere_pass():
    """As the parts of a picture all around."""
    turned = np.diag([-1.0, 1.0, -1.0]) @ RING[0].cam_from_world
    stated.check("hall.toml", [RING[0], posed(RING[1], turned), *RING[2:]])
