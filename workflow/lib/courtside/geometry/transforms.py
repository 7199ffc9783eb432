"""Rigid transforms as (3, 4) matrices, and rotations."""

import numpy as np
from scipy.spatial.transform import Rotation

ROUNDING = 1e-4  # files print rotations with as few as six decimals


def rotation_from_rodrigues(vector):
    """Return the rotation matrix (3, 3) of a rotation vector (3,): axis times angle in radians."""
    return Rotation.from_rotvec(vector).as_matrix()


def rodrigues_from_rotation(rotation):
    """Return the rotation vector (3,), axis times angle in radians, of a rotation matrix (3, 3)."""
    return Rotation.from_matrix(rotation).as_rotvec()


def nearest_rotation(matrix):
    """Return the rotation nearest to a matrix that is one but for rounding.

    Parameters
    ----------
    matrix : (3, 3) float
        A rotation as a file prints it.

    Returns
    -------
    rotation : (3, 3) float
        Orthonormal to machine precision (polar factor).

    Raises
    ------
    ValueError
        If `matrix` is a reflection, or differs from a rotation by more than 1e-4 in an entry.
    """
    left, _, right = np.linalg.svd(matrix)
    rotation = left @ right
    if np.linalg.det(rotation) < 0:
        raise ValueError("expected a right-handed rotation, found one with determinant -1")
    off = np.abs(rotation - matrix).max()
    if off > ROUNDING:
        raise ValueError(f"expected an orthonormal rotation, found one that is {off:.2g} off")
    return rotation


def unit(vectors):
    """Return vectors (..., 3) at length 1; NaN where they have none."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, np.nan)


def invert(b_from_a):
    """Return `a_from_b` (3, 4) of a rigid transform `b_from_a` (3, 4)."""
    rotation = b_from_a[:, :3].T
    return np.column_stack([rotation, -rotation @ b_from_a[:, 3]])
