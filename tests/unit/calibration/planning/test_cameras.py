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


def test_a_planned_camera_needs_a_sideways_aim():
    with pytest.raises(InputError, match="camera top: expected it to look sideways"):
        cameras.camera("top", (0, 0, 9), (0, 0, 1), (640, 480), focal_px=500)


def test_places_are_even_along_the_way():
    places = cameras.places_on_path([(0, 0), (3, 0), (10, 0)], 6, 1.6)
    assert places == pytest.approx(np.column_stack([np.arange(0, 11, 2), [0] * 6, [1.6] * 6]))
    angles = np.radians(np.linspace(0, 90, 7))
    circle = 5 * np.column_stack([np.cos(angles), np.sin(angles)])
    places = cameras.places_on_path(circle, 10, 1.6)
    assert np.linalg.norm(places[:, :2], axis=1) == pytest.approx([5] * 10, rel=1e-3)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert steps == pytest.approx([5 * np.pi / 2 / 9] * 9, rel=2e-3)  # chords of 10 degrees
    assert cameras.places_on_path([(0, 0), (4, 0)], 1, 1.0) == pytest.approx(
        np.array([[2, 0, 1.0]])
    )
    assert cameras.places_on_path([(0, 0), (4, 0)], 0, 1.0).shape == (0, 3)


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


# ---- angles between views along a walk, against circles and brute force


def test_angles_between_views_are_those_of_a_circle():
    point = np.array([3.05, 6.7, 1.0])
    turn = np.radians([0, 10, 35, 90, 270])
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(5)])
    radii = np.array([5, 9, 2, 7, 4.0])[:, None]
    walked = np.zeros(5, dtype=bool)
    found = cameras.path_angles_deg(walked, point + radii * circle, point)
    np.testing.assert_allclose(found, [10, 25, 55, 180], atol=1e-9)
    with_gap = point + radii * circle
    with_gap[2] = np.nan
    found = cameras.path_angles_deg(walked, with_gap, point)
    np.testing.assert_array_equal(np.isnan(found), [False, True, True, False])


WALK = np.array([[x, 0.0, 0.0] for x in range(5)])


def order_of(fixed, walk=WALK):
    centres = np.concatenate([np.reshape(fixed, (-1, 3)), walk])
    is_fixed = np.arange(len(centres)) < len(centres) - len(walk)
    return cameras.path_order(centres, is_fixed).tolist()


@pytest.mark.parametrize(
    ("fixed", "order"),
    [
        ([[-1, 1, 0], [5, 1, 0]], [0, 2, 3, 4, 5, 6, 1]),
        ([[5, 1, 0], [-1, 1, 0]], [1, 2, 3, 4, 5, 6, 0]),
        ([[1.5, 0.5, 0], [9, 0, 0]], [2, 3, 0, 4, 5, 6, 1]),
        ([], [0, 1, 2, 3, 4]),
    ],
)
def test_fixed_cameras_stand_where_the_walk_passes_them(fixed, order):
    assert order_of(fixed) == order


def test_no_other_place_of_a_fixed_camera_makes_a_shorter_path():
    rng = np.random.default_rng(0)
    for _ in range(30):
        walk, camera = np.cumsum(rng.normal(size=(6, 3)), axis=0), 3 * rng.normal(size=3)
        centres = np.concatenate([[camera], walk])

        def length(order, centres=centres):
            return np.linalg.norm(np.diff(centres[order], axis=0), axis=1).sum()

        others = [[*range(1, at + 1), 0, *range(at + 1, 7)] for at in range(7)]
        assert length(order_of(camera, walk)) == pytest.approx(min(map(length, others)))


def test_fixed_cameras_alone_and_with_one_frame_have_an_order():
    assert sorted(order_of([[1, 0, 0], [2, 0, 0]], np.zeros((0, 3)))) == [0, 1]
    assert sorted(order_of([[1, 0, 0]], WALK[:1])) == [0, 1]


def test_angles_along_the_path_count_the_fixed_ends():
    """A walk on a circle, 10 degrees a step, fixed cameras 30 and 20 degrees beyond its ends."""
    degrees = np.array([-30.0, 60, 0, 10, 20, 30, 40])
    radius = np.array([15.0, 18, 9, 9, 9, 9, 9])[:, None]
    ray = np.stack([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0 * degrees], axis=1)
    centres = [3.05, 6.7, 1] + radius * ray
    fixed = np.arange(7) < 2
    found = cameras.path_angles_deg(fixed, centres, [3.05, 6.7, 1])
    np.testing.assert_allclose(found, [30, 10, 10, 10, 10, 20], atol=1e-9)
