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


@pytest.mark.parametrize("point", [(0.49, 0.51), (0.0, 0.0), (-1.2, 0.8)])
def test_a_principal_point_that_is_not_in_px_from_the_corner_is_named(point):
    matrix = RING[2].K.copy()
    matrix[:2, 2] = point
    cameras = [*RING[:2], replace(RING[2], K=matrix), RING[3]]
    message = r"^hall.toml: camera c2: expected the principal point in px .* the 1920x1080 px pict"
    with pytest.raises(InputError, match=message):
        stated.check("hall.toml", cameras)


def test_a_principal_point_at_one_side_passes():
    """As of a part of a picture."""
    matrix = RING[2].K.copy()
    matrix[:2, 2] = 0.5, 900
    stated.check("hall.toml", [*RING[:2], replace(RING[2], K=matrix)])
