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


@pytest.mark.parametrize(
    ("last", "message"), [(-1.0, "found one with determinant -1"), (1.001, "expected an orthonorm")]
)
def test_other_matrices_are_refused(last, message):
    matrix = np.diag([1.0, 1.0, last])
    with pytest.raises(ValueError, match=message):
        rotations.nearest_rotation(matrix)


def test_a_transform_times_its_inverse_is_the_identity():
    b_from_a = np.column_stack([cv2.Rodrigues(np.array([0.3, -1.2, 2.0]))[0], [1.0, -2.0, 3.0]])
    square = [np.vstack([m, [0, 0, 0, 1]]) for m in (b_from_a, rotations.invert(b_from_a))]
    np.testing.assert_allclose(square[0] @ square[1], np.eye(4), atol=1e-14)
    same = rotations.composed(b_from_a, rotations.invert(b_from_a))
    np.testing.assert_allclose(same, np.eye(3, 4), atol=1e-14)


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
