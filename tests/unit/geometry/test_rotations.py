"""Rotations and rigid transforms against OpenCV and matrix algebra."""

import cv2
import numpy as np
import pytest

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


def test_inverse_undoes():
    b_from_a = np.column_stack([cv2.Rodrigues(np.array([0.3, -1.2, 2.0]))[0], [1.0, -2.0, 3.0]])
    square = [np.vstack([m, [0, 0, 0, 1]]) for m in (b_from_a, rotations.invert(b_from_a))]
    np.testing.assert_allclose(square[0] @ square[1], np.eye(4), atol=1e-14)
