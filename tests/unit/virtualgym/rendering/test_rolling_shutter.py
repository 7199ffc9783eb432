"""Surfaces as a rolling shutter sees them, against solving for each point's row by bisection."""

import numpy as np
import pytest
from scipy.optimize import brentq

from courtside.geometry import camera
from fixtures.cameras import balls, scene, small_hall
from virtualgym.rendering import rolling_shutter

CAMERA = small_hall.camera(size=(1920, 1080))
READOUT_S, EXPOSURE_S = 0.02, 0.01


class Swing(balls.Ball):
    """A ball on an arm of 1 m that turns at 40 rad/s about a place."""

    def centre(self, time_s):
        angle = 40 * time_s + 0.4
        return self.place + np.array([0.7 * np.cos(angle), -0.7 * np.cos(angle), np.sin(angle)])


def seen_at(athlete, vertex, time_s, later_s):
    """Return where a vertex is seen (2,) px, by its row's own time."""

    def place(own_s):
        return scene.opencv_projection(
            CAMERA, athlete.mesh(own_s).vertices[[vertex]].astype(float)
        )[0]

    def excess(row):
        return place(time_s + ((row + 0.5) / 1080 - 0.5) * READOUT_S + later_s)[1] - row

    row = brentq(excess, -2000, 3000, xtol=1e-9)
    return place(time_s + ((row + 0.5) / 1080 - 0.5) * READOUT_S + later_s)


@pytest.mark.parametrize(
    ("athlete", "error_px"),
    [
        (balls.Ball((4.0, 4.5, 1.0)), 1e-4),
        (balls.Ball((3.5, 4.5, 2.0), (9.0, -6.0, 3.0)), 0.02),
        (Swing((4.0, 4.5, 1.0)), 0.3),  # 40 m/s
    ],
)
def test_points_are_where_their_own_row_sees_them(athlete, error_px):
    shutter = 0.003, READOUT_S, EXPOSURE_S
    screen = rolling_shutter.Screen(
        rolling_shutter.follow(athlete, CAMERA, *shutter), CAMERA, *shutter
    )
    for share in (-0.5, 0.0, 0.2, 0.5):
        found = screen.at(share)
        for vertex in range(0, len(found), 97):
            expected = seen_at(athlete, vertex, 0.003, share * EXPOSURE_S)
            assert np.abs(found[vertex, :2] - expected).max() < error_px


def test_depths_are_along_the_camera_s_axis():
    athlete = balls.Ball((4.0, 4.5, 1.0))
    screen = rolling_shutter.Screen(
        rolling_shutter.follow(athlete, CAMERA, 0, 0, 0), CAMERA, 0, 0, 0
    )
    xyz = athlete.mesh(0).vertices
    expected = (xyz - CAMERA.centre_in_world) @ CAMERA.cam_from_world[2, :3]
    np.testing.assert_allclose(screen.at(0.0)[:, 2], expected, atol=1e-5)


def test_blur_is_speed_times_exposure():
    still, fast = balls.Ball((4.0, 4.5, 1.0)), balls.Ball((4.0, 4.5, 1.0), (5.0, -5.0, 0.0))
    blurs = []
    for athlete in (still, fast):
        shutter = 0.0, 0.0, EXPOSURE_S
        screen = rolling_shutter.Screen(
            rolling_shutter.follow(athlete, CAMERA, *shutter), CAMERA, *shutter
        )
        blurs.append(screen.blur_px)
    assert blurs[0].max() < 1e-3
    ends = [
        scene.opencv_projection(CAMERA, fast.mesh(s * EXPOSURE_S).vertices.astype(float))
        for s in (-0.5, 0.5)
    ]
    np.testing.assert_allclose(blurs[1], np.hypot(*(ends[1] - ends[0]).T), atol=1e-3)


def test_points_behind_the_camera_have_no_place_in_the_picture():
    athlete = balls.Ball(CAMERA.centre_in_world, radius_m=1.5)
    screen = rolling_shutter.Screen(
        rolling_shutter.follow(athlete, CAMERA, 0, 0.01, 0.01), CAMERA, 0, 0.01, 0.01
    )
    depth = (athlete.mesh(0).vertices - CAMERA.centre_in_world) @ CAMERA.cam_from_world[2, :3]
    shown = np.isfinite(screen.at(0.0)).all(axis=1)
    assert (depth < -0.1).any() and not shown[depth < 0].any()
    assert shown[depth > 1.3].all() and (depth > 1.3).any()


def test_surfaces_are_lighter_where_they_face_the_lamps():
    moving = rolling_shutter.Moving(balls.Ball((4.0, 4.5, 1.0)), 0.0, 0.0)
    up = moving.vertices[:, 2] - 1.0
    light = moving.light()
    assert light[up > 0.29].min() > 1.0 > light[up < -0.29].max() + 0.4


def test_bounds_hold_points_and_stay_in_the_picture():
    xy = np.array([[10.2, 20.7], [30.1, 22.0], [np.nan, 5.0]])
    assert rolling_shutter.bounds(xy, (320, 180), 2) == (8, 18, 34, 25)
    assert rolling_shutter.bounds(xy, (20, 180), 2) == (8, 18, 20, 25)
    assert rolling_shutter.bounds(xy + 500, (320, 180), 2) is None
    assert rolling_shutter.bounds(xy * np.nan, (320, 180), 2) is None


def test_points_are_where_the_camera_projects_them_to_the_last_bit():
    rng = np.random.default_rng(3)
    xyz = rng.uniform([-20, -20, -5], [25, 30, 12], (5000, 3))  # many behind it, many far aside
    xyz[7] = np.nan
    x, y, depth = rolling_shutter.shown(CAMERA, xyz)
    expected = camera.project(CAMERA, xyz)
    assert 0.1 < np.isfinite(expected[:, 0]).mean() < 0.9
    np.testing.assert_array_equal(np.stack([x, y], axis=1), expected)
    away = np.column_stack([xyz, np.ones(len(xyz))]) @ CAMERA.cam_from_world[2]
    np.testing.assert_allclose(depth, away, atol=1e-12)
