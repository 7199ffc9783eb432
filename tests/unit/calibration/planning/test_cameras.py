"""Planned cameras look where they are aimed; walked ones stand evenly along the way."""

import numpy as np
import pytest

from courtside.calibration.planning import cameras
from courtside.study.errors import InputError
from fixtures.cameras import hall_plan, scene


def test_the_aim_is_in_the_middle_of_an_upright_picture():
    found = cameras.camera("c", (-3, 2, 1.5), (4, 6, 1), (1920, 1080), fov_deg=90)
    points = np.array([(4, 6, 1.0), (4, 6, 2.0)])
    middle, above = scene.opencv_projection(found, points)
    assert middle == pytest.approx([959.5, 539.5])
    assert above[0] == pytest.approx(959.5)
    assert above[1] < 539.5
    assert found.centre_in_world == pytest.approx([-3, 2, 1.5])
    assert found.K[0, 0] == pytest.approx(960)  # 90 degrees: half the width


def test_the_field_of_view_is_across_the_width():
    found = cameras.camera("c", (0, 0, 1), (10, 0, 1), (1000, 500), fov_deg=60)
    edge = np.array([[10, 10 * np.tan(np.radians(30)), 1.0]])
    assert scene.opencv_projection(found, edge)[0] == pytest.approx([-0.5, 249.5])


def test_a_roll_turns_the_picture():
    found = cameras.camera("c", (0, 0, 1), (10, 0, 1), (1000, 500), focal_px=800, roll=np.pi / 2)
    (x, y) = scene.opencv_projection(found, np.array([[10, 0, 2.0]]))[0]
    assert y == pytest.approx(249.5)
    assert abs(x - 499.5) == pytest.approx(80)


def test_faults():
    with pytest.raises(ValueError, match="focal_px and fov_deg"):
        cameras.camera("c", (0, 0, 1), (1, 0, 1), (640, 480))
    with pytest.raises(ValueError, match="focal_px and fov_deg"):
        cameras.camera("c", (0, 0, 1), (1, 0, 1), (640, 480), focal_px=1, fov_deg=1)
    with pytest.raises(InputError, match="camera top: expected it to look sideways"):
        cameras.camera("top", (0, 0, 9), (0, 0, 1), (640, 480), focal_px=500)


def test_places_are_even_along_the_way():
    places = cameras.on_way([(0, 0), (3, 0), (10, 0)], 6, 1.6)
    assert places == pytest.approx(np.column_stack([np.arange(0, 11, 2), [0] * 6, [1.6] * 6]))
    angles = np.radians(np.linspace(0, 90, 7))
    circle = 5 * np.column_stack([np.cos(angles), np.sin(angles)])
    places = cameras.on_way(circle, 10, 1.6)
    assert np.linalg.norm(places[:, :2], axis=1) == pytest.approx([5] * 10, rel=1e-3)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert steps == pytest.approx([5 * np.pi / 2 / 9] * 9, rel=2e-3)  # chords of 10 degrees
    assert cameras.on_way([(0, 0), (4, 0)], 1, 1.0) == pytest.approx(np.array([[2, 0, 1.0]]))
    assert cameras.on_way([(0, 0), (4, 0)], 0, 1.0).shape == (0, 3)


def test_a_walk_strays_slowly_and_always_alike():
    walked = hall_plan.walked(60)
    again = hall_plan.walked(60)
    assert all(
        np.array_equal(a.cam_from_world, b.cam_from_world)
        for a, b in zip(walked, again, strict=True)
    )
    places = np.array([camera.centre_in_world for camera in walked])
    radius = np.linalg.norm(places[:, :2] - hall_plan.CENTRE[:2], axis=1)
    assert 0.05 < radius.std() < 0.6
    assert np.abs(np.diff(radius)).max() < 0.3  # half a metre apart
    middle = np.array(
        [scene.opencv_projection(c, hall_plan.from_centre(0, 0, 1.25)[None])[0] for c in walked]
    )
    spread_m = (middle - [639.5, 359.5]).std(axis=0) * 21 / hall_plan.FOCAL_PX
    assert spread_m == pytest.approx([0.35, 0.2], rel=0.35)
