"""Epipolar distances: zero for one point, pixels for a miss, against OpenCV."""

import cv2
import numpy as np

from courtside.geometry import epipolar, rotations
from fixtures.cameras import scene

CAMERAS = scene.ring(3, dist=(-0.1, 0.02, 1e-3, -5e-4, 0.0))
XYZ = scene.points(200)


def straight(camera, noise=0.0, rng=None):
    xy = scene.opencv_projection(camera, XYZ)
    return epipolar.straight_px(camera, xy + (rng.normal(0, noise, xy.shape) if rng else 0))


def test_one_point_lies_on_its_lines():
    matrix = epipolar.fundamental(CAMERAS[0], CAMERAS[1])
    a, b = straight(CAMERAS[0]), straight(CAMERAS[1])
    np.testing.assert_allclose(epipolar.distance_px(matrix, a, b), 0, atol=1e-6)
    lines = epipolar.lines(matrix, a)
    np.testing.assert_allclose((lines[:, :2] * b).sum(axis=1) + lines[:, 2], 0, atol=1e-6)


def test_the_distance_is_opencvs():
    rng = np.random.default_rng(0)
    matrix = epipolar.fundamental(CAMERAS[0], CAMERAS[2])
    a, b = straight(CAMERAS[0], 3.0, rng), straight(CAMERAS[2], 3.0, rng)
    ours = epipolar.distance_px(matrix, a, b)
    one = np.ones((len(a), 1))
    theirs = [
        cv2.sampsonDistance(p[:, None], q[:, None], matrix)
        for p, q in zip(np.hstack([a, one]), np.hstack([b, one]), strict=True)
    ]
    np.testing.assert_allclose(ours**2, theirs, rtol=1e-6)


def test_the_distance_of_noise_has_the_noises_deviation():
    rng = np.random.default_rng(1)
    matrix = epipolar.fundamental(CAMERAS[0], CAMERAS[1])
    misses = [
        epipolar.distance_px(
            matrix,
            straight(CAMERAS[0]) + rng.normal(0, 2.0, (len(XYZ), 2)),
            straight(CAMERAS[1]) + rng.normal(0, 2.0, (len(XYZ), 2)),
        )
        for _ in range(50)
    ]
    assert abs(np.std(misses) - 2.0) < 0.06


def test_a_line_is_where_the_ray_of_a_pixel_goes():
    matrix = epipolar.fundamental(CAMERAS[0], CAMERAS[1])
    line = epipolar.lines(matrix, straight(CAMERAS[0])[:1])[0]
    centre = rotations.invert(CAMERAS[0].cam_from_world)[:, 3]
    along = centre + np.linspace(0.7, 1.3, 5)[:, None] * (XYZ[0] - centre)
    xy = epipolar.straight_px(CAMERAS[1], scene.opencv_projection(CAMERAS[1], along))
    np.testing.assert_allclose(xy @ line[:2] + line[2], 0, atol=1e-6)


def test_rays_meet_at_the_angle_between_the_directions_to_the_cameras():
    a, b = CAMERAS[0], CAMERAS[1]
    rotation, _ = epipolar.relative_pose(a, b)
    xy = [epipolar.straight_px(c, scene.opencv_projection(c, XYZ)) / epipolar.focal_px(c)
          for c in (a, b)]  # fmt: skip
    one, other = (rotations.unit(XYZ - camera.centre_in_world) for camera in (a, b))
    expected = np.sin(np.arccos((one * other).sum(axis=1)))
    np.testing.assert_allclose(epipolar.ray_sines(rotation, *xy), expected, atol=1e-4)
