"""The cameras' share of the error: against moving the cameras by hand and triangulating with OpenCV."""

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.calibration.bundle import selection
from courtside.calibration.records import covariance as camera_covariance
from courtside.reconstruction import fusion
from fixtures.cameras import scene
from fixtures.people import walker

CAMERAS = scene.ring(2, radius_m=8)
N = len(camera_covariance.PARAMETERS)
SIGMA = np.array([1e-3, 2e-3, 1e-3, 0.01, 0.02, 0.01, 4, 1e-4, 2, 2, 1e-4, 1e-4, 1e-5, 1e-5])


def covariance():
    return camera_covariance.CameraCovariance(["c0", "c1"], np.diag(np.tile(SIGMA, 2) ** 2))


def triangulated(poses, xy):
    matrices = [camera.K @ pose for camera, pose in zip(CAMERAS, poses, strict=True)]
    found = cv2.triangulatePoints(*matrices, xy[0].T.copy(), xy[1].T.copy())
    return (found[:3] / found[3]).T


def test_spread_is_that_of_points_triangulated_with_cameras_moved_at_random():
    points = walker.points(6, n_cameras=2)
    places = np.array([[[0.5, 0.2, 1.0]] * walker.N_JOINTS] * 6)[None]
    points = walker_at(points, places)
    pose_only = covariance()
    keep = np.tile(np.arange(N) < 6, 2)
    pose_only.covariance[~np.ix_(keep, keep)[0][:, 0]] = 0
    found = fusion.with_cameras(points, CAMERAS, pose_only.of_columns())
    rng = np.random.default_rng(0)
    xy = scene.views(CAMERAS, places[0, 0, :1])
    moved = []
    for _ in range(4000):
        poses = []
        for camera in CAMERAS:
            turn = Rotation.from_rotvec(rng.normal(0, SIGMA[:3])).as_matrix()
            pose = turn @ camera.cam_from_world
            pose[:, 3] += rng.normal(0, SIGMA[3:6])
            poses.append(pose)
        moved.append(triangulated(poses, xy)[0])
    expected = np.cov(np.array(moved).T)
    np.testing.assert_allclose(
        found.covariance_camera[0, 0, 5], expected, atol=0.08 * np.trace(expected)
    )


def walker_at(points, xyz):
    return type(points)(**{**vars(points), "xyz": xyz})


def test_a_person_who_is_missing_has_none_and_joints_share_the_persons():
    points = walker.points(6, n_cameras=2)
    points.xyz[0, 2] = np.nan
    found = fusion.with_cameras(points, CAMERAS, covariance().of_columns())
    assert np.isnan(found.covariance_camera[0, 2]).all()
    assert np.isnan(found.covariance_camera[0, 3, 4]).all()
    np.testing.assert_array_equal(
        found.covariance_camera[0, 4, 0], found.covariance_camera[0, 4, 20]
    )
    np.testing.assert_array_equal(found.covariance_2d, points.covariance_2d)


def test_some_of_the_cameras_have_their_own_part():
    three = camera_covariance.CameraCovariance(
        ["a", "b", "c"], np.diag(np.arange(3 * N, dtype=float))
    )
    part = three.of(["c", "a"])
    assert part.cameras == ["c", "a"]
    assert np.diag(part.covariance).tolist() == [*range(2 * N, 3 * N), *range(N)]
    with pytest.raises(ValueError, match="expected a camera of"):
        three.of(["d"])
    assert selection.of_cameras(CAMERAS).n_columns == len(part.of_columns())
