"""Whole pictures of balls in a small hall: where, when, before what, with which noise."""

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fixtures.cameras import balls, scene, small_hall
from virtualgym.cameras import camera_shake
from virtualgym.hall import quads
from virtualgym.rendering import background, player_renderer, rolling_shutter
from virtualgym.rendering.hall_renderer import Renderer

SIZE = (320, 180)
CAMERA = small_hall.camera(size=SIZE)
RED = (0, 0, 255)
GREEN = np.full((4, 4, 3), (30, 180, 30), np.uint8)
BALL = balls.Ball((4.0, 4.5, 1.2), bgr=RED)


@pytest.fixture(scope="module")
def green():
    return background.look(Renderer(small_hall.scene(texture=GREEN)), CAMERA)


def covered(picture, hall, athlete, time_s=0.0):
    """Return by how much a ball without green covers each pixel round it."""
    share = 1 - picture[..., 1] / np.maximum(hall.picture[..., 1].astype(float), 1)
    rows, columns = np.indices(share.shape)
    away = np.hypot(
        columns - outline_middle(athlete, time_s)[0], rows - outline_middle(athlete, time_s)[1]
    )
    return np.where(away < 40, share, 0)


def middle(share):
    rows, columns = np.indices(share.shape)
    return np.array([(columns * share).sum(), (rows * share).sum()]) / share.sum()


def outline_middle(athlete, time_s=0.0, camera=CAMERA):
    xy = scene.opencv_projection(camera, athlete.mesh(time_s).vertices.astype(float))
    moments = cv2.moments(cv2.convexHull(xy.astype(np.float32)))
    return np.array([moments["m10"], moments["m01"]]) / moments["m00"]


def test_a_still_ball_is_where_the_truth_says(green):
    film = player_renderer.Film(green, 0.02, 0.01)
    for place in ((4.0, 4.5, 1.2), (5.5, 4.2, 1.9), (3.0, 4.8, 1.6)):
        ball = balls.Ball(place, bgr=RED)
        found = middle(covered(film.picture([ball], 0.7), green, ball))
        np.testing.assert_allclose(found, outline_middle(ball), atol=0.1)


def test_without_athletes_there_is_the_hall(green):
    film = player_renderer.Film(green, 0.02, 0.01)
    assert (film.picture([], 0.0) == green.picture).all()
    behind = balls.Ball((-3.0, -3.0, 1.7))
    assert (film.picture([behind], 0.0) == green.picture).all()


def test_each_row_sees_its_own_time(green):
    readout_s = 0.3
    film = player_renderer.Film(green, readout_s, 0.0)
    moving = balls.Ball((4.0, 4.5, 2.2), (1.0, -1.0, 0.0), bgr=RED)
    row = outline_middle(moving)[1]
    assert row < 60, "far from the middle row"
    own_s = ((row + 0.5) / SIZE[1] - 0.5) * readout_s
    found = middle(covered(film.picture([moving], 0.0), green, moving))
    moved = outline_middle(moving, own_s) - outline_middle(moving)
    assert abs(moved[0]) > 3
    np.testing.assert_allclose(found, outline_middle(moving, own_s), atol=0.3)


def test_a_picture_shows_its_own_time(green):
    film = player_renderer.Film(green, 0.01, 0.002)
    moving = balls.Ball((4.0, 4.5, 1.2), (1.0, -1.0, 0.0), bgr=RED)
    for time_s in (-0.4, 0.8):
        found = middle(covered(film.picture([moving], time_s), green, moving, time_s))
        np.testing.assert_allclose(found, outline_middle(moving, time_s), atol=0.15)


def test_a_thing_in_the_hall_hides_the_ball(green):
    eye = CAMERA.centre_in_world
    before = eye + 0.6 * (BALL.place - eye)
    post = quads.box(before - [0.15, 0.15, 1.0], np.diag([0.3, 0.3, 2.0]), GREEN)
    hall = background.look(Renderer(small_hall.scene(post, texture=GREEN)), CAMERA)
    shown, hidden = (
        covered(player_renderer.Film(each, 0.0, 0.0).picture([BALL], 0.0), each, BALL)
        for each in (green, hall)
    )
    assert hidden.sum() < 0.6 * shown.sum()
    column, row = np.rint(outline_middle(BALL)).astype(int)
    around = slice(row - 5, row + 5), column
    assert hidden[around].max() < 0.02 and shown[around].min() > 0.98


def test_a_ball_above_the_floor_darkens_the_floor_below(green):
    light = background.look(
        Renderer(small_hall.scene(texture=np.full((4, 4, 3), 160, np.uint8))), CAMERA
    )
    low = balls.Ball((4.0, 4.5, 0.45), bgr=(160, 160, 160), radius_m=0.4)
    change = player_renderer.Film(light, 0.0, 0.0).picture([low], 0.0).astype(int) - light.picture
    foot = scene.opencv_projection(CAMERA, np.array([[4.0, 4.5, 0.0]]))[0]
    beside = scene.opencv_projection(CAMERA, np.array([[6.5, 3.0, 0.0]]))[0]
    column, row = np.rint(foot).astype(int)
    assert change[row, column].max() < -20
    column, row = np.rint(beside).astype(int)
    assert (change[row, column] == 0).all()


def test_a_turned_camera_moves_hall_and_ball_together():
    renderer = Renderer(small_hall.scene())
    hall = background.look(renderer, CAMERA, margin_px=10)
    turn = Rotation.from_rotvec([0.008, 0.012, -0.006]).as_matrix()
    red = balls.Ball((4.0, 4.5, 1.2), bgr=(0, 0, 255))
    picture = player_renderer.Film(hall, 0.0, 0.0).picture([red], 0.0, turn).astype(int)
    turned = camera_shake.turned(CAMERA, turn)
    rows, columns = np.nonzero(picture[..., 2] - picture[..., 1] > 90)
    found = np.array([columns.mean(), rows.mean()])
    np.testing.assert_allclose(found, outline_middle(red, camera=turned), atol=0.3)
    assert np.abs(found - outline_middle(red)).max() > 2
    left = slice(0, 120)
    true = renderer.render(turned).astype(int)[:, left]
    still = renderer.render(CAMERA).astype(int)[:, left]
    error, change = (np.abs(each - true).mean() for each in (picture[:, left], still))
    assert error < change / 5


def test_grain_has_its_size_and_never_the_same_place():
    grain = player_renderer.Grain(SIZE, 4.5, np.random.default_rng(1))
    flat = np.full((180, 320, 3), 100, np.uint8)
    rng = np.random.default_rng(2)
    one, two = (grain.added(flat, rng).astype(float) - 100 for _ in range(2))
    for noise in (one, two):
        assert noise.mean() == pytest.approx(0, abs=0.05)
        assert noise.std() == pytest.approx(np.sqrt(4.5**2 + 1 / 12), rel=0.01)
    assert abs(np.corrcoef(one.ravel(), two.ravel())[0, 1]) < 0.01
    again = grain.added(flat, np.random.default_rng(2))
    assert (again == one + 100).all()


def test_overlapping_athletes_are_taken_together():
    shutter = 0.0, 0.0, 0.0
    places = [(4.0, 4.5, 1.2), (4.3, 4.5, 1.2), (5.8, 3.6, 1.2), (-3.0, -3.0, 1.7)]
    screens = [
        rolling_shutter.Screen(
            rolling_shutter.follow(balls.Ball(p), CAMERA, *shutter), CAMERA, *shutter
        )
        for p in places
    ]
    groups = player_renderer.grouped(screens)
    members = sorted(sorted(screens.index(each) for each in group) for _, group in groups)
    assert members == [[0, 1], [2]]
    for box, group in groups:
        for each in group:
            own = each.box(player_renderer.PAD_PX)
            assert all(box[i] <= own[i] and box[i + 2] >= own[i + 2] for i in (0, 1))
