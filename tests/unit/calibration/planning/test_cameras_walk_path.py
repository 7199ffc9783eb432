"""Angles between views along a walk, and where fixed cameras stand in it, against circles and brute force."""

import numpy as np
import pytest

from courtside.calibration.planning import cameras


def test_angles_between_views_are_those_of_a_circle():
    point = np.array([3.05, 6.7, 1.0])
    turn = np.radians([0, 10, 35, 90, 270])
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(5)])
    radii = np.array([5, 9, 2, 7, 4.0])[:, None]
    found = cameras.neighbour_angles_deg(point + radii * circle, point)
    np.testing.assert_allclose(found, [10, 25, 55, 180], atol=1e-9)
    with_gap = point + radii * circle
    with_gap[2] = np.nan
    found = cameras.neighbour_angles_deg(with_gap, point)
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
    """A walk on a circle about the point, 10 degrees a step, fixed cameras 30 and 20 beyond its ends."""
    degrees = np.array([-30.0, 60, 0, 10, 20, 30, 40])
    radius = np.array([15.0, 18, 9, 9, 9, 9, 9])[:, None]
    ray = np.stack([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0 * degrees], axis=1)
    centres = [3.05, 6.7, 1] + radius * ray
    fixed = np.arange(7) < 2
    found = cameras.path_angles_deg(fixed, centres, [3.05, 6.7, 1])
    np.testing.assert_allclose(found, [30, 10, 10, 10, 10, 20], atol=1e-9)
