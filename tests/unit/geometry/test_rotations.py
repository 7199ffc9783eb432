"""Rotations and rigid transforms against OpenCV, SciPy, matrix algebra and differences."""

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from courtside.geometry import rotations

VECTORS = [
    [0.0, 0.0, 0.0],
    [1e-9, -2e-9, 3e-9],
    [0.3, -1.2, 2.0],
    [0.0, np.pi, 0.0],
    [np.pi - 1e-8, 0.0, 0.0],
]


@pytest.mark.parametrize("vector", VECTORS)
def test_rotation_is_opencvs(vector):
    rotation = rotations.rotation_from_rodrigues(vector)
    np.testing.assert_allclose(rotation, cv2.Rodrigues(np.array(vector))[0], atol=1e-15)


@pytest.mark.parametrize("vector", VECTORS)
def test_rotation_vector_gives_the_rotation_back(vector):
    rotation = cv2.Rodrigues(np.array(vector))[0]
    again = cv2.Rodrigues(rotations.rodrigues_from_rotation(rotation))[0]
    np.testing.assert_allclose(again, rotation, atol=1e-12)


def test_rounded_rotation_becomes_orthonormal():
    rounded = np.round(cv2.Rodrigues(np.array([0.3, -1.2, 2.0]))[0], 5)
    rotation = rotations.nearest_rotation(rounded)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(rotation, rounded, atol=1e-5)


@pytest.mark.parametrize("matrix", [np.diag([1.0, 1.0, -1.0]), np.diag([1.0, 1.0, 1.001])])
def test_other_matrices_are_refused(matrix):
    with pytest.raises(ValueError, match="expected"):
        rotations.nearest_rotation(matrix)


def test_a_transform_times_its_inverse_is_the_identity():
    b_from_a = np.column_stack([cv2.Rodrigues(np.array([0.3, -1.2, 2.0]))[0], [1.0, -2.0, 3.0]])
    square = [np.vstack([m, [0, 0, 0, 1]]) for m in (b_from_a, rotations.invert(b_from_a))]
    np.testing.assert_allclose(square[0] @ square[1], np.eye(4), atol=1e-14)


VECTORS_RNG = np.random.default_rng(0)


def test_rotation_vectors_become_scipys_matrices_and_come_back():
    vectors = VECTORS_RNG.normal(size=(4, 5, 3))
    matrices = rotations.rotation_from_rodrigues(vectors)
    assert matrices[1, 2] == pytest.approx(Rotation.from_rotvec(vectors[1, 2]).as_matrix())
    assert rotations.rotation_from_rodrigues(
        rotations.rodrigues_from_rotation(matrices)
    ) == pytest.approx(matrices)


def test_cross_matrices_take_the_cross_product():
    a, b = VECTORS_RNG.normal(size=(2, 7, 3))
    assert (rotations.cross_matrices(a) @ b[..., None])[..., 0] == pytest.approx(np.cross(a, b))


@pytest.mark.parametrize("size", [0.0, 1e-8, 1e-3, 1.0, 3.0])
def test_left_jacobians_are_the_derivative(size):
    vector = size * np.array([0.6, -0.48, 0.64])
    found = rotations.left_jacobians(vector)
    step = 1e-6
    for axis in range(3):
        ends = [vector + sign * step * np.eye(3)[axis] for sign in (1, -1)]
        turn = Rotation.from_rotvec(ends[0]) * Rotation.from_rotvec(ends[1]).inv()
        assert found[:, axis] == pytest.approx(turn.as_rotvec() / (2 * step), abs=1e-6)


def test_interpolated_rotations_are_scipys_slerp():
    time_s = np.array([0.0, 0.1, 0.3, 0.4])
    turns = Rotation.from_rotvec(VECTORS_RNG.normal(size=(4, 3)))
    wanted = np.linspace(0, 0.4, 17)
    found = rotations.interpolate(time_s, turns.as_matrix(), wanted)
    assert found == pytest.approx(Slerp(time_s, turns)(wanted).as_matrix(), abs=1e-12)


def test_interpolated_rotations_stay_at_the_ends():
    turns = Rotation.from_rotvec([[0, 0, 0], [0, 0, 1.0]]).as_matrix()
    found = rotations.interpolate(np.array([0.0, 1.0]), turns, np.array([-5.0, 5.0]))
    assert found == pytest.approx(turns)


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
