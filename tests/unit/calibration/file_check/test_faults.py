"""Faults of a calibration file: planting one and mending it gives the camera back."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.file_check import faults, verdict
from courtside.geometry import camera as cameras
from fixtures.cameras import corner_cameras as hall


def assert_same(found, camera):
    np.testing.assert_allclose(found.K, camera.K, atol=1e-9)
    np.testing.assert_allclose(found.dist, camera.dist, atol=1e-12)
    np.testing.assert_allclose(found.cam_from_world, camera.cam_from_world, atol=1e-12)
    assert found.size == camera.size


def test_a_mirrored_point_mirrored_again_is_as_it_was():
    camera = hall.four_cameras()[0]
    for axis in (0, 1):
        mirrored = faults.mirrored_point(camera, axis)
        assert mirrored.K[axis, 2] == camera.size[axis] - 1 - camera.K[axis, 2]
        assert_same(faults.mirrored_point(mirrored, axis), camera)


def test_a_scaled_picture_shows_points_at_scaled_places():
    camera = hall.four_cameras()[1]
    xyz = np.array([[0.3, -0.2, 1.1], [0.0, 0.5, 0.4]])
    xy = cameras.project(camera, xyz)
    scaled = cameras.project(faults.scaled_picture(camera, 0.5), xyz)
    np.testing.assert_allclose(scaled + 0.5, (xy + 0.5) / 2)


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_a_turned_picture_shows_points_at_turned_places(turns):
    camera = hall.four_cameras()[2]
    square = replace(camera, size=(1080, 1080))
    xyz = np.array([[0.3, -0.2, 1.1], [0.0, 0.5, 0.4]])
    xy = cameras.project(square, xyz)
    for _ in range(turns):
        xy = np.stack([1079 - xy[:, 1], xy[:, 0]], axis=-1)
    np.testing.assert_allclose(cameras.project(faults.turned_picture(square, turns), xyz), xy)


def test_four_quarter_turns_change_nothing():
    camera = hall.four_cameras()[3]
    one = camera
    for _ in range(4):
        one = faults.turned_picture(one, 1)
    assert one.size == camera.size
    np.testing.assert_allclose(one.cam_from_world, camera.cam_from_world, atol=1e-12)


def test_simple_faults_name_every_camera_and_pair():
    seen_by = hall.four_cameras()
    message = [one.what for one in faults.simple(seen_by)]
    assert sum("mirrored" in line for line in message) == 8
    assert sum("turned by" in line for line in message) == 12
    assert sum("picture size" in line for line in message) == 4 * len(faults.SCALES)
    assert (
        next(line for line in message if "exchanged" in line) == "cameras c0 and c1 are exchanged"
    )
    assert all(one.n_free == 0 for one in faults.simple(seen_by))


def test_a_point_in_the_middle_is_not_told_from_its_mirror_image():
    camera = hall.camera("c", np.array([4, 4, 2.0]), (959.5, 539.5))
    assert list(faults.mirrored([camera], 0, 0)) == []


def test_exchanged_cameras_keep_their_names():
    seen_by = hall.four_cameras()
    (one,) = [f for f in faults.simple(seen_by) if f.what == "cameras c1 and c3 are exchanged"]
    assert [camera.name for camera in one.cameras] == ["c0", "c1", "c2", "c3"]
    np.testing.assert_array_equal(one.cameras[1].K, seen_by[3].K)


def test_free_numbers_are_fitted_to_what_others_see():
    seen_by = hall.four_cameras()
    rng = np.random.default_rng(3)
    xyz = np.array([0, 0, 1.0]) + rng.uniform(-1, 1, (40, 3))
    xy = cameras.project(seen_by[1], xyz)
    longer = seen_by[1].K.copy()
    longer[[0, 1], [0, 1]] *= 1.04
    spoilt = [seen_by[0], replace(seen_by[1], K=longer), *seen_by[2:]]
    focal, turned, zoomed, moved = faults.fitted(spoilt, 1, xyz, xy, verdict.FREE)
    assert focal.what == "the focal length of camera c1 is 4.0 % too long"
    assert [one.n_free for one in (focal, turned, zoomed, moved)] == [1, 3, 4, 6]
    np.testing.assert_allclose(focal.cameras[1].K, seen_by[1].K, rtol=1e-4)
    away = cameras.turned(seen_by[1], [0.01, -0.02, 0.005])
    spoilt[1] = away
    _, turned, _, _ = faults.fitted(spoilt, 1, xyz, xy, verdict.FREE)
    np.testing.assert_allclose(
        turned.cameras[1].cam_from_world, seen_by[1].cam_from_world, atol=1e-4
    )


def test_few_points_fit_few_numbers():
    seen_by = hall.four_cameras()
    xyz = np.array([[0.1, 0.2, 1], [0.3, -0.4, 1.2], [-0.5, 0.2, 0.7]])
    xy = cameras.project(seen_by[0], xyz)
    assert [one.n_free for one in faults.fitted(seen_by, 0, xyz, xy, verdict.FREE)] == [1]
