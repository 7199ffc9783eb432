"""Rotations of single vectors against SciPy and NumPy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from virtualgym.body import rotations

UNITS_RNG = np.random.default_rng(0)
UNITS = [vector / np.linalg.norm(vector) for vector in UNITS_RNG.normal(size=(20, 3))]


@pytest.mark.parametrize("at", range(10))
def test_a_swing_is_the_smallest_rotation_between_two_ways(at):
    start, end = UNITS[at], UNITS[at + 10]
    found = rotations.swing(start, end)
    np.testing.assert_allclose(found @ start, end, atol=1e-12)
    angle = np.linalg.norm(Rotation.from_matrix(found).as_rotvec())
    assert angle == pytest.approx(np.arccos(start @ end))


def test_a_swing_to_the_opposite_is_half_a_turn():
    for start in UNITS:
        found = rotations.swing(start, -start)
        np.testing.assert_allclose(found @ start, -start, atol=1e-12)
        np.testing.assert_allclose(found @ found.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(found) == pytest.approx(1)


@pytest.mark.parametrize("angle", [-3.0, -0.4, 0.0, 1.2, 2.9])
def test_a_turn_about_an_axis_and_its_angle(angle):
    for axis in UNITS[:5]:
        found = rotations.about_axis(axis, angle)
        np.testing.assert_allclose(
            found, Rotation.from_rotvec(angle * axis).as_matrix(), atol=1e-12
        )
        assert rotations.twist(found, axis) == pytest.approx(angle)
        start = UNITS[7]
        assert rotations.angle_about(axis, start, found @ start + 3 * axis) == pytest.approx(angle)


def test_the_twist_is_what_is_left_of_a_rotation_without_its_swing():
    axis = UNITS[3]
    for end in UNITS[4:9]:
        both = rotations.swing(axis, end) @ rotations.about_axis(axis, 0.7)
        assert rotations.twist(both, axis) == pytest.approx(0.7)


def test_shares_of_a_turn_lie_on_the_shortest_way():
    start, end = Rotation.random(2, rng=1)
    end = start * Rotation.from_rotvec([0.3, -0.9, 0.4])
    parts = [0.0, 0.3, 0.8, 1.0]
    found = rotations.shares(start.as_matrix(), end.as_matrix(), parts)
    expected = Slerp([0, 1], Rotation.concatenate([start, end]))(parts).as_matrix()
    np.testing.assert_allclose(found, expected, atol=1e-12)
    same = rotations.shares(np.eye(3), np.eye(3), parts)
    np.testing.assert_array_equal(same, np.tile(np.eye(3), (4, 1, 1)))


def test_cross_products_of_single_vectors_are_numpys():
    for first, second in zip(UNITS[:10], UNITS[10:], strict=True):
        expected = np.cross(first, second)
        np.testing.assert_allclose(rotations.cross3(first, second), expected, atol=1e-15)
        np.testing.assert_allclose(rotations.skew(first) @ second, expected, atol=1e-15)
