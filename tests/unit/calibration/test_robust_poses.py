"""Poses by RANSAC from exact points, a third of which are wrong."""

import numpy as np
import pytest

from courtside.calibration import robust_poses
from courtside.geometry.camera import undistort
from fixtures.cameras import scene

ONE, OTHER = scene.ring(4)[:2]
XYZ = scene.points(300)


def rays(wrong=100):
    """Return the points on the z = 1 planes of both cameras; the first ones are wrong."""
    found = [
        undistort(camera, xy)
        for camera, xy in zip((ONE, OTHER), scene.views((ONE, OTHER), XYZ), strict=True)
    ]
    found[1][:wrong] += np.random.default_rng(0).normal(0, 0.2, (wrong, 2))
    return found


def test_the_relative_pose_is_found_among_wrong_points():
    one, other = rays()
    matrix, inside = robust_poses.essential(one, other, 1e-3)
    assert inside[100:].all() and inside[:100].mean() < 0.1
    pose, in_front = robust_poses.relative(matrix, one[inside], other[inside])
    turn = OTHER.cam_from_world[:, :3] @ ONE.cam_from_world[:, :3].T
    shift = OTHER.cam_from_world[:, 3] - turn @ ONE.cam_from_world[:, 3]
    np.testing.assert_allclose(pose[:, :3], turn, atol=2e-3)
    np.testing.assert_allclose(pose[:, 3], shift / np.linalg.norm(shift), atol=5e-3)
    assert in_front == pytest.approx(1.0, abs=0.03)


def test_a_camera_is_found_by_points_among_wrong_ones():
    count, pose = robust_poses.resected(XYZ, rays()[1], 2e-3, 0.75)
    assert 200 <= count < 215
    np.testing.assert_allclose(pose, OTHER.cam_from_world, atol=1e-3)


def test_points_without_any_pose_give_none():
    noise = np.random.default_rng(1).normal(size=(300, 2))
    found = robust_poses.resected(XYZ, noise, 1e-5, 0.75)
    assert found is None or found[0] < 8


@pytest.mark.parametrize("xyz", [1e-4 * XYZ, XYZ[:, :1] * [1, 2, 3]], ids=["a point", "a line"])
def test_points_that_any_pose_fits_give_none(xyz):
    """OpenCV's SQPnP raises an error of its own there."""
    in_camera = xyz + np.array([0, 0, 10])
    views = in_camera[:, :2] / in_camera[:, 2:]
    assert robust_poses.resected(xyz, views, 1e-3, 0.75) is None
    assert robust_poses.placed(xyz, views, robust_poses.IDEAL, None) == []


def test_all_right_points_give_the_pose():
    pose, *_ = robust_poses.placed(XYZ, rays(0)[1], robust_poses.IDEAL, None)
    np.testing.assert_allclose(pose, OTHER.cam_from_world, atol=1e-6)
