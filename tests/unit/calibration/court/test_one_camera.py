"""The derivatives of one camera's fit, against differences of OpenCV's projection."""

import cv2
import numpy as np
import pytest

from courtside.calibration.court import one_camera
from fixtures.cameras.scene import FOCAL_PX, SIZE, look_at, opencv_projection, points, ring

XYZ = points(7)


def state_and_clicks(*, free_lens, xyz_sigma=None):
    camera = ring(3, dist=(-0.1, 0.03, 1e-3, -2e-3, 0.01))[1]
    state = one_camera.State(camera.K, camera.dist, camera.cam_from_world)
    xy = opencv_projection(camera, XYZ) + 3.0
    return state, one_camera.Clicks(XYZ, xy, 2.0, xyz_sigma, free_lens)


def in_opencv(state, clicks):
    turn, _ = cv2.Rodrigues(state.cam_from_world[:, :3])
    xy, _ = cv2.projectPoints(clicks.xyz, turn, state.cam_from_world[:, 3], state.K, state.dist)
    return xy[:, 0] - clicks.xy


@pytest.mark.parametrize(("free_lens", "n_parameters"), [(False, 6), (True, 8)])
def test_derivatives_are_differences_of_opencvs_projection(free_lens, n_parameters):
    state, clicks = state_and_clicks(free_lens=free_lens)
    off, by_step = one_camera.whitened(state, clicks)
    np.testing.assert_allclose(off, in_opencv(state, clicks) / 2.0, atol=1e-9)
    assert by_step.shape == (7, 2, n_parameters)
    for at in range(n_parameters):
        step = np.zeros(n_parameters)
        step[at] = 1e-3 if at == 6 else 1e-6
        ahead, behind = (in_opencv(state.moved(sign * step), clicks) for sign in (1, -1))
        slope = (ahead - behind) / (2 * step[at]) / 2.0
        np.testing.assert_allclose(by_step[:, :, at], slope, rtol=1e-5, atol=1e-4)


def test_uncertain_points_widen_the_residual_as_a_thousand_of_them_do():
    spread = np.linspace(0.005, 0.03, 7)
    state, _ = state_and_clicks(free_lens=False, xyz_sigma=spread)
    rng = np.random.default_rng(0)
    draws = []
    for _ in range(1500):
        moved = XYZ + spread[:, None] * rng.normal(size=(7, 3))
        turn, _ = cv2.Rodrigues(state.cam_from_world[:, :3])
        xy, _ = cv2.projectPoints(moved, turn, state.cam_from_world[:, 3], state.K, state.dist)
        xy = xy[:, 0] + 2.0 * rng.normal(size=(7, 2))
        seen = one_camera.Clicks(XYZ, xy, 2.0, spread, False)
        draws.append(one_camera.whitened(state, seen)[0])
    draws = np.array(draws)  # white: variance 1, no correlation between x and y
    np.testing.assert_allclose((draws**2).mean(axis=0), 1, atol=0.15)
    np.testing.assert_allclose((draws[..., 0] * draws[..., 1]).mean(axis=0), 0, atol=0.12)


def test_points_behind_the_camera_are_refused_not_mirrored():
    state, clicks = state_and_clicks(free_lens=True)
    behind = one_camera.State(state.K, state.dist, look_at((0, 6, 2), (0, 12, 2)))
    assert one_camera.whitened(state, clicks)[0] is not None
    assert one_camera.whitened(behind, clicks) == (None, None)
    assert not state.moved(np.array([0, 0, 0, 0, 0, 0, -2 * FOCAL_PX, 0])).possible


def test_the_start_tries_focal_lengths():
    camera = ring(3)[0]
    clicks = one_camera.Clicks(XYZ, opencv_projection(camera, XYZ), 1.0, None, True)
    state = one_camera.start(clicks, SIZE, None, np.zeros(5))
    assert state.K[0, 0] / SIZE[0] == pytest.approx(FOCAL_PX / SIZE[0], rel=0.2)
    assert state.K[:2, 2].tolist() == [959.5, 539.5]
