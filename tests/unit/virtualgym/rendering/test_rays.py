"""Rays of pixels: the inverse of the projection, also while the camera moves."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.geometry.camera import Camera
from fixtures.cameras import scene, small_hall
from virtualgym.rendering import rays

TWIST = np.array([0.4, -0.3, 0.2]), np.array([1.0, 2.0, -0.5])


def pixels(size):
    return np.stack(np.meshgrid(*map(np.arange, size)), axis=-1).reshape(-1, 2)


@pytest.mark.parametrize("size", [(640, 360), (101, 57)])
def test_points_along_a_ray_are_seen_in_its_pixel(size):
    camera = small_hall.camera(size=size)
    seen = rays.of_camera(camera, rays.grid(camera), None, 0.0)
    direction, time_s = seen.of_band(0, size[1])
    assert time_s is None
    for away in (0.5, 7.0):
        xy = scene.opencv_projection(camera, seen.origins(None) + away * direction.T.astype(float))
        assert np.abs(xy - pixels(size)).max() < 1e-3


def test_bands_are_the_whole_picture_in_parts(monkeypatch):
    camera = small_hall.camera(size=(101, 57))
    seen = rays.of_camera(camera, rays.grid(camera), None, 0.0)
    monkeypatch.setattr(rays, "BAND_RAYS", 2000)
    parts, directions = zip(*seen.bands(), strict=True)
    assert len(parts) == 3 and parts[1] == slice(19 * 101, 38 * 101)
    np.testing.assert_array_equal(np.concatenate(directions, axis=1), seen.of_band(0, 57)[0])


def test_rays_beside_pixels_and_of_halved_pictures():
    camera = small_hall.camera()
    seen = rays.of_camera(camera, rays.grid(camera), None, 0.0)
    chosen = np.array([0, 639, 200 * 640 + 77, 359 * 640, 359 * 640 + 639])
    (_, direction), _ = seen.near(chosen, [(0, 0), (0.375, -0.125)])
    xy = scene.opencv_projection(camera, camera.centre_in_world + direction.T.astype(float))
    np.testing.assert_allclose(xy, pixels(camera.size)[chosen] + [0.375, -0.125], atol=0.01)
    direction, _ = seen.halved().of_band(0, 180)
    xy = scene.opencv_projection(camera, camera.centre_in_world + direction.T.astype(float))
    np.testing.assert_allclose(xy, 2 * pixels((320, 180)) + 0.5, atol=0.01)


def test_each_row_has_its_own_time_place_and_direction():
    camera = small_hall.camera()
    xy = rays.grid(camera)
    seen, still = (rays.of_camera(camera, xy, twist, 0.2) for twist in (TWIST, None))
    world_from_cam = camera.cam_from_world[:, :3].T
    for row in (0, 100, 359):
        time_s = ((row + 0.5) / 360 - 0.5) * 0.2
        direction, times = seen.of_band(row, row + 1)
        np.testing.assert_allclose(times, time_s, rtol=1e-5)
        turned = world_from_cam @ Rotation.from_rotvec(TWIST[0] * time_s).as_matrix()
        expected = turned @ world_from_cam.T @ still.of_band(row, row + 1)[0]
        np.testing.assert_allclose(direction, expected, atol=1e-6)
        np.testing.assert_allclose(
            seen.origins(times)[0], camera.centre_in_world + TWIST[1] * time_s, atol=1e-6
        )
        (beside,), same = seen.near(np.arange(row * 640, (row + 1) * 640))
        np.testing.assert_allclose(beside, direction, atol=1e-6)
        np.testing.assert_array_equal(same, times)
    assert not still.moving
    assert seen.moving


def test_a_lens_that_shows_nothing_in_the_corners_is_refused():
    good = small_hall.camera()
    bad = Camera("c", good.size, good.K, np.array([-0.9, 0, 0, 0, 0]), good.cam_from_world)
    with pytest.raises(ValueError, match="camera c: expected a lens that fills the picture"):
        rays.grid(bad)
