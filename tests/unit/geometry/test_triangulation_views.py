"""Newton's way to points: residuals against OpenCV, derivatives against differences."""

import numpy as np

from courtside.geometry import triangulation
from fixtures.cameras import scene

CAMERAS = scene.ring(3)  # without distortion, pixels are the plane
XYZ = scene.points(20)
SEEN = triangulation.Views(CAMERAS, scene.views(CAMERAS, XYZ), np.ones((3, 20)))
NEAR = XYZ + np.random.default_rng(1).normal(0, 0.05, XYZ.shape)


def test_residuals_are_those_of_opencv():
    found, in_cam = SEEN.residuals(NEAR)
    expected = scene.views(CAMERAS, NEAR) - scene.views(CAMERAS, XYZ)
    np.testing.assert_allclose(found, expected, atol=1e-6)
    np.testing.assert_allclose(SEEN.distance(NEAR), np.linalg.norm(expected, axis=-1), atol=1e-6)
    depth = np.einsum("cj,nj->cn", [c.cam_from_world[2, :3] for c in CAMERAS], NEAR)
    np.testing.assert_allclose(in_cam[..., 2], depth + SEEN.matrix[:, 2, 3:], atol=1e-12)


def test_normal_equations_are_those_of_differences():
    weight = np.random.default_rng(2).uniform(0.2, 1, (3, 20))
    residual, in_cam = SEEN.residuals(NEAR)
    square, right = SEEN.normal(in_cam, weight, residual)
    steps = 1e-6 * np.eye(3)
    slope = [(SEEN.residuals(NEAR + d)[0] - SEEN.residuals(NEAR - d)[0]) / 2e-6 for d in steps]
    expected = np.einsum("icnr,cn,jcnr->nij", slope, weight, slope)
    np.testing.assert_allclose(square, expected, rtol=1e-6)
    np.testing.assert_allclose(
        right, np.einsum("icnr,cn,cnr->ni", slope, weight, residual), rtol=1e-6
    )


def test_steps_end_at_the_points_that_the_views_show():
    xyz = NEAR
    for _ in range(4):
        xyz = SEEN.stepped(xyz, SEEN.weight)
    np.testing.assert_allclose(xyz, XYZ, atol=1e-9)
    part = SEEN.of(np.array([3, 5]))
    np.testing.assert_allclose(part.stepped(XYZ[[3, 5]], part.weight), XYZ[[3, 5]], atol=1e-9)


def test_a_step_without_weight_leaves_a_point_where_it_is():
    weight = SEEN.weight.copy()
    weight[:, 4] = 0
    moved = SEEN.stepped(NEAR, weight) != NEAR
    assert moved.any(axis=1).tolist() == [True] * 4 + [False] + [True] * 15


def test_points_are_in_front_of_the_cameras_named():
    behind = 2 * CAMERAS[0].centre_in_world - XYZ
    nobody, first = np.zeros((3, 20), bool), np.zeros((3, 20), bool)
    first[0] = True
    assert SEEN.in_front(XYZ, ~nobody).all() and SEEN.in_front(behind, nobody).all()
    assert not SEEN.in_front(behind, first).any()
