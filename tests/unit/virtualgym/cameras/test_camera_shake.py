"""Cameras that tremble or are knocked, against exact projection and the renderer's own picture."""

import cv2
import numpy as np
import pytest
from scipy import ndimage
from scipy.spatial.transform import Rotation

from fixtures.cameras import scene, small_hall
from virtualgym.cameras import camera_shake
from virtualgym.rendering import background
from virtualgym.rendering.hall_renderer import Renderer

CAMERA = small_hall.camera(size=(320, 180))


def shaking_of(**shake):
    return camera_shake.Shaking(camera_shake.Shake(**shake), CAMERA, np.random.default_rng(7))


def moved_px(camera, points):
    return scene.opencv_projection(camera, points) - scene.opencv_projection(CAMERA, points)


def test_the_tremor_has_the_stated_size_and_frequencies():
    movement, middle = shaking_of(tremor_px=1.5), np.array([[6.5, 7.5, 1.0]])
    times_s = np.arange(0, 120, 0.02)
    path = np.array([moved_px(movement.camera_at(t), middle)[0] for t in times_s])
    assert path.std(axis=0) == pytest.approx([1.5, 1.5], rel=0.08)
    power = np.abs(np.fft.rfft(path - path.mean(axis=0), axis=0)) ** 2
    hz = np.fft.rfftfreq(len(path), 0.02)
    inside = (hz > 0.4) & (hz < 8.1)
    assert power[inside].sum() > 0.97 * power.sum()
    assert np.hypot(*path.T).max() <= movement.reach_px()


def test_a_knock_turns_the_camera_for_good():
    movement = shaking_of(knock_s=2.0, knock_deg=0.5)
    assert (movement.still_from_shaken(1.999) == np.eye(3)).all()
    for time_s in (2.0, 9.0):
        turn = Rotation.from_matrix(movement.still_from_shaken(time_s))
        assert np.degrees(turn.magnitude()) == pytest.approx(0.5, abs=1e-9)
    knocked = movement.camera_at(3.0)
    np.testing.assert_allclose(knocked.centre_in_world, CAMERA.centre_in_world, atol=1e-12)
    points = small_hall.corners()
    seen = scene.opencv_projection(CAMERA, points)
    depth = points @ CAMERA.cam_from_world[2, :3] + CAMERA.cam_from_world[2, 3]
    shown = ((seen > 0) & (seen < CAMERA.size)).all(axis=1) & (depth > 0)
    moved = np.hypot(*moved_px(knocked, points[shown]).T)
    assert shown.sum() > 50
    assert 0 < moved.max() <= movement.reach_px()


@pytest.mark.parametrize("strength", [1.0, 2.0])
def test_a_tripod_creeps_by_a_pixel_and_one_more_a_minute(strength):
    still = camera_shake.Shake()
    movement = camera_shake.Shaking(still, CAMERA, np.random.default_rng(7), strength)
    ahead = CAMERA.cam_from_world[2, :3] * 5 + CAMERA.centre_in_world
    for minutes in (0, 1, 3):
        moved = np.hypot(*moved_px(movement.camera_at(60.0 * minutes), ahead[None])[0])
        expected_px = strength * camera_shake.CREEP_PX * 320 / 1280 * (1 + minutes)
        assert moved == pytest.approx(expected_px, rel=0.02)
        assert moved <= movement.reach_px(60.0 * minutes)
    assert (shaking_of().still_from_shaken(60.0) == np.eye(3)).all()


def test_positive_about_y_turns_the_view_to_the_right():
    turn = Rotation.from_rotvec([0, 0.01, 0]).as_matrix()
    moved = moved_px(camera_shake.turned(CAMERA, turn), np.array([[6.5, 7.5, 1.0]]))[0]
    assert moved[0] == pytest.approx(-0.01 * CAMERA.K[0, 0], rel=0.05)
    assert abs(moved[1]) < 0.1


def test_each_pixel_looks_where_projection_says():
    turn = Rotation.from_rotvec([0.012, -0.02, 0.015]).as_matrix()
    wide = background.widened(CAMERA, 16)
    places = camera_shake.Warp(CAMERA, wide).places(turn)
    points = small_hall.corners()
    turned = camera_shake.turned(CAMERA, turn)
    depth = points @ turned.cam_from_world[2, :3] + turned.cam_from_world[2, 3]
    points = points[depth > 0.5]
    now = scene.opencv_projection(turned, points)
    before = scene.opencv_projection(wide, points)
    inside = ((now > 1) & (now < np.array(CAMERA.size) - 2)).all(axis=1)
    assert inside.sum() > 50
    found = np.stack(
        [ndimage.map_coordinates(part, now.T[::-1], order=1) for part in places], axis=1
    )
    assert np.abs(found - before)[inside].max() < 1e-3


def test_the_warped_picture_is_that_of_the_turned_camera():
    renderer = Renderer(small_hall.scene())
    turn = Rotation.from_rotvec([0.006, 0.009, -0.004]).as_matrix()
    wide = background.look(renderer, CAMERA, margin_px=8)
    places = camera_shake.Warp(CAMERA, wide.camera).places(turn)
    warped = cv2.remap(wide.picture, *places, cv2.INTER_CUBIC).astype(int)
    true = renderer.render(camera_shake.turned(CAMERA, turn)).astype(int)
    still = renderer.render(CAMERA).astype(int)
    error, change = (np.abs(picture - true).mean() for picture in (warped, still))
    assert error < change / 5, "what is left is the sharpness of a picture that is sampled twice"


@pytest.mark.parametrize(
    "shake", [{"tremor_px": -1.0}, {"knock_deg": 1.0}, {"knock_s": 1.0}, {"knock_deg": -1.0}]
)
def test_impossible_shakes_are_refused(shake):
    with pytest.raises(ValueError, match="knock_s with knock_deg"):
        camera_shake.Shake(**shake)
