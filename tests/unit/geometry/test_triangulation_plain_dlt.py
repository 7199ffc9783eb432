"""Plain DLT: exact on exact views, equal to OpenCV's, and helpless against a wrong view."""

import cv2
import numpy as np
import pytest

from courtside.geometry import triangulation
from fixtures.cameras import scene

XYZ = scene.points(50)


def test_exact_views_give_the_points_whatever_the_lens():
    cameras = scene.ring(3, dist=(-0.1, 0.02, 1e-3, -1e-3, 0))
    found = triangulation.triangulate_plain(
        cameras, scene.views(cameras, XYZ), np.ones((3, 50)), sigma_px=1.0
    )
    np.testing.assert_allclose(found.xyz, XYZ, atol=1e-7)
    assert found.accepted.all() and found.error_px.max() < 1e-5


def test_two_noisy_views_give_nearly_what_opencv_does():
    cameras = scene.ring(5)[:2]
    xy = scene.views(cameras, XYZ) + np.random.default_rng(0).normal(0, 3, (2, 50, 2))
    found = triangulation.triangulate_plain(cameras, xy, np.ones((2, 50)), sigma_px=3.0)
    matrices = [camera.K @ camera.cam_from_world for camera in cameras]
    other = cv2.triangulatePoints(*matrices, xy[0].T.copy(), xy[1].T.copy())
    apart = np.linalg.norm(found.xyz - (other[:3] / other[3]).T, axis=1)
    error = np.linalg.norm(found.xyz - XYZ, axis=1)
    assert np.median(apart) < 0.1 * np.median(error)
    sigma = np.sqrt(np.trace(found.covariance, axis1=1, axis2=2))
    assert np.sqrt(np.mean(error**2)) == pytest.approx(np.sqrt(np.mean(sigma**2)), rel=0.25)


def test_a_wrong_view_is_used_and_a_doubtful_one_is_not():
    cameras = scene.ring(4)
    xy, score = scene.views(cameras, XYZ), np.ones((4, 50))
    xy[0] += 200
    found = triangulation.triangulate_plain(cameras, xy, score, sigma_px=1.0)
    assert np.linalg.norm(found.xyz - XYZ, axis=1).min() > 0.02
    score[0] = 0.1
    found = triangulation.triangulate_plain(cameras, xy, score, sigma_px=1.0, min_score=0.5)
    np.testing.assert_allclose(found.xyz, XYZ, atol=1e-7)
    assert not found.accepted[0].any()


def test_points_of_too_few_views_are_missing():
    cameras = scene.ring(3)
    xy = scene.views(cameras, XYZ)
    xy[:2, 3] = np.nan
    xy[0, 4] = np.nan
    found = triangulation.triangulate_plain(
        cameras, xy, np.ones((3, 50)), sigma_px=1.0, min_views=2
    )
    assert np.isnan(found.xyz[3]).all() and not found.accepted[:, 3].any()
    assert found.accepted[:, 4].tolist() == [False, True, True]
    with pytest.raises(ValueError, match="min_views"):
        triangulation.triangulate_plain(cameras, xy, np.ones((3, 50)), sigma_px=1.0, min_views=1)
