"""Rotation vectors of many frames, against scipy and differences."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from courtside.geometry import rotations as rotation_vectors

RNG = np.random.default_rng(0)


def test_matrices_and_back():
    vectors = RNG.normal(size=(4, 5, 3))
    matrices = rotation_vectors.matrices_from_vectors(vectors)
    assert matrices[1, 2] == pytest.approx(Rotation.from_rotvec(vectors[1, 2]).as_matrix())
    assert rotation_vectors.matrices_from_vectors(
        rotation_vectors.vectors_from_matrices(matrices)
    ) == pytest.approx(matrices)


def test_cross_matrices():
    a, b = RNG.normal(size=(2, 7, 3))
    assert (rotation_vectors.cross_matrices(a) @ b[..., None])[..., 0] == pytest.approx(
        np.cross(a, b)
    )


@pytest.mark.parametrize("size", [0.0, 1e-8, 1e-3, 1.0, 3.0])
def test_left_jacobians_are_the_derivative(size):
    vector = size * np.array([0.6, -0.48, 0.64])
    found = rotation_vectors.left_jacobians(vector)
    step = 1e-6
    for axis in range(3):
        ends = [vector + sign * step * np.eye(3)[axis] for sign in (1, -1)]
        turn = Rotation.from_rotvec(ends[0]) * Rotation.from_rotvec(ends[1]).inv()
        assert found[:, axis] == pytest.approx(turn.as_rotvec() / (2 * step), abs=1e-6)


def test_between_is_slerp():
    time_s = np.array([0.0, 0.1, 0.3, 0.4])
    rotations = Rotation.from_rotvec(RNG.normal(size=(4, 3)))
    wanted = np.linspace(0, 0.4, 17)
    found = rotation_vectors.interpolate(time_s, rotations.as_matrix(), wanted)
    assert found == pytest.approx(Slerp(time_s, rotations)(wanted).as_matrix(), abs=1e-12)


def test_between_stays_at_the_ends():
    rotations = Rotation.from_rotvec([[0, 0, 0], [0, 0, 1.0]]).as_matrix()
    found = rotation_vectors.interpolate(np.array([0.0, 1.0]), rotations, np.array([-5.0, 5.0]))
    assert found == pytest.approx(rotations)
