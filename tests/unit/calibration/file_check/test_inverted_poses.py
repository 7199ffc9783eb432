"""Poses stated the other way round are recognised; right ones in any world are left alone."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.file_check import inverted_poses, stated
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError
from fixtures.cameras import scene

WRONG = {
    "poses from the camera": rotations.invert,
    "rotations from the camera": lambda pose: np.column_stack([pose[:, :3].T, pose[:, 3]]),
    "places C of": lambda pose: np.column_stack([pose[:, :3], -pose[:, :3].T @ pose[:, 3]]),
    "as in OpenGL": lambda pose: np.diag([1, -1, -1]) @ pose,
    "as in Blender": lambda pose: rotations.invert(np.diag([1, -1, -1]) @ pose),
}
WORLDS = {
    "z up": [0, 0, 0.7],
    "z down": [np.pi, 0, 0],
    "y up": [np.pi / 2, 0, 0],
    "tilted": [0.9, -1.3, 0.4],
}


def stated_as(cameras, change):
    return [replace(c, cam_from_world=change(c.cam_from_world)) for c in cameras]


def aimed(places, targets):
    lens = scene.ring(1)[0]
    return [
        replace(lens, name=f"c{k}", cam_from_world=scene.look_at(*at))
        for k, at in enumerate(zip(places, targets, strict=True))
    ]


def arrangements():
    """Yield cameras around a place, in a row, at the ceiling, in one place, and on one side."""
    rng = np.random.default_rng(0)
    for n in range(3, 7):
        yield scene.ring(n)
        x = np.linspace(0, 5 * n, n)
        row = np.column_stack([x, np.zeros(n), np.full(n, 2.0)])
        yield aimed(row, np.add(row, [0, 9, -1]))
        hall = rng.uniform([0, 0, 5], [12, 20, 9], (n, 3))
        yield aimed(hall, hall * [1, 1, 0] + rng.normal(0, 1.5, (n, 3)) * [1, 1, 0])
        around = np.array([[0.3 * np.cos(k), 0.3 * np.sin(k), 1.5] for k in range(n)])
        yield aimed(around, around * [30, 30, 0.7])
        yield aimed(rng.uniform([0, 0, 1], [9, 2, 4], (n, 3)), rng.normal([4, 9, 1], 0.5, (n, 3)))


@pytest.mark.parametrize("world", WORLDS)
def test_right_poses_are_left_alone_in_any_world(world):
    turn = rotations.rotation_from_rodrigues(WORLDS[world])
    move = np.vstack([np.column_stack([turn, [3, -2, 0]]), [0, 0, 0, 1]])
    for cameras in arrangements():
        assert inverted_poses.judge(stated_as(cameras, lambda pose: pose @ move)) is None


def test_right_poses_are_left_alone_in_the_frame_of_a_camera():
    for cameras in arrangements():
        first = np.vstack([rotations.invert(cameras[0].cam_from_world), [0, 0, 0, 1]])
        assert inverted_poses.judge(stated_as(cameras, lambda pose, w=first: pose @ w)) is None


@pytest.mark.parametrize("count", [3, 4, 5, 8])
@pytest.mark.parametrize("what", WRONG)
def test_poses_the_other_way_round_are_told_with_what_to_do(count, what):
    wrong = stated_as(scene.ring(count), WRONG[what])
    found = inverted_poses.judge(wrong)
    assert what in found.what
    for camera, right in zip(wrong, scene.ring(count), strict=True):
        mended = found.right(camera.cam_from_world)
        np.testing.assert_allclose(mended, right.cam_from_world, atol=1e-12)
    with pytest.raises(InputError, match=f"hall: cameras c0, c1, c2.* if the file has .*{what}"):
        stated.check("hall", wrong)


def test_two_cameras_say_nothing():
    assert inverted_poses.judge(stated_as(scene.ring(2), rotations.invert)) is None


def test_cameras_that_look_in_parallel_say_nothing():
    pose = [np.column_stack([np.eye(3), [k, 0, 0]]) for k in range(4)]
    lens = scene.ring(1)[0]
    cameras = [Camera(f"c{k}", lens.size, lens.K, lens.dist, one) for k, one in enumerate(pose)]
    assert inverted_poses.judge(cameras) is None
