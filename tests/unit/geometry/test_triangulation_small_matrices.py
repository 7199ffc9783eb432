"""Symmetric 3 x 3 systems: against NumPy, and singular ones are missing."""

import numpy as np

from courtside.geometry import triangulation


def systems(count, seed=0):
    root = np.random.default_rng(seed).normal(size=(count, 3, 3))
    return root @ root.transpose(0, 2, 1)


def test_inverses_and_solutions_are_those_of_numpy():
    matrix, right = systems(200), np.random.default_rng(1).normal(size=(200, 3))
    expected = np.linalg.solve(matrix, right[..., None])[..., 0]
    scale = np.abs(expected).max(axis=1, keepdims=True)
    assert (np.abs(triangulation.solve_3x3(matrix, right) - expected) / scale).max() < 1e-6
    product = triangulation.inverse_3x3(matrix) @ matrix
    assert np.median(np.abs(product - np.eye(3))) < 1e-12


def test_a_singular_system_has_no_solution_and_spoils_no_other():
    matrix = systems(3)
    matrix[1] = np.outer([1, 2, 3], [1, 2, 3])
    found = triangulation.solve_3x3(matrix, np.ones((3, 3)))
    assert np.isnan(found[1]).all() and np.isfinite(found[[0, 2]]).all()
