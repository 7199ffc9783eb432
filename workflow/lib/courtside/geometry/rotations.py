"""Rotation matrices and vectors: conversion, inversion, derivatives, interpolation."""

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import interpolation

ROUNDING = 1e-4  # files print rotations with as few as six decimals
SMALL = 1e-6  # radians: below, the first terms of the series


def rotation_from_rodrigues(vectors: ArrayLike) -> NDArray:
    """Return the rotations (..., 3, 3) of rotation vectors (..., 3), axis times radians."""
    return scipy.spatial.transform.Rotation.from_rotvec(vectors).as_matrix()


def rodrigues_from_rotation(rotations: ArrayLike, *, valid: bool = False) -> NDArray:
    """Return the rotation vectors (..., 3), axis times radians, of rotations (..., 3, 3).

    `valid` skips the check that they are rotations, which takes most of the time where they are
    few.
    """
    found = scipy.spatial.transform.Rotation.from_matrix(rotations, assume_valid=valid)
    return found.as_rotvec()


def angles(rotations: ArrayLike) -> NDArray:
    """Return the angles (...) of rotations (..., 3, 3), radians in 0..pi."""
    return scipy.spatial.transform.Rotation.from_matrix(rotations).magnitude()


def nearest_rotation(matrix: NDArray) -> NDArray:
    """Return the rotation (3, 3) nearest to a printed one: its polar factor.

    Raises `ValueError` for a reflection, and where an entry differs by more than 1e-4.
    """
    left, _, right = np.linalg.svd(matrix)
    rotation = left @ right
    if np.linalg.det(rotation) < 0:
        raise ValueError("expected a right-handed rotation, found one with determinant -1")
    off = np.abs(rotation - matrix).max()
    if off > ROUNDING:
        raise ValueError(f"expected an orthonormal rotation, found one that is {off:.2g} off")
    return rotation


def unit(vectors: NDArray) -> NDArray:
    """Return vectors (..., 3) scaled to length 1; NaN for zero vectors."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, np.nan)


def invert(b_from_a: NDArray) -> NDArray:
    """Return `a_from_b` (3, 4) of a rigid transform `b_from_a` (3, 4)."""
    rotation = b_from_a[:, :3].T
    return np.column_stack([rotation, -rotation @ b_from_a[:, 3]])


def composed(c_from_b: NDArray, b_from_a: NDArray) -> NDArray:
    """Return `c_from_a` (3, 4) of two rigid transforms (3, 4)."""
    rotation = c_from_b[:, :3] @ b_from_a[:, :3]
    return np.column_stack([rotation, c_from_b[:, :3] @ b_from_a[:, 3] + c_from_b[:, 3]])


def cross(a: NDArray, b: NDArray) -> NDArray:
    """Return the cross products (..., 3) of vectors (..., 3).

    As `np.cross`, without its handling of axes and of vectors in the plane, which takes most of the
    time where they are few.
    """
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


def cross_matrices(vectors: ArrayLike) -> NDArray:
    """Return the matrices (..., 3, 3) whose product with another vector is the cross product."""
    x, y, z = np.moveaxis(np.asarray(vectors, float), -1, 0)
    none = np.zeros_like(x)
    rows = [none, -z, y, z, none, -x, -y, x, none]
    return np.stack(rows, -1).reshape(*x.shape, 3, 3)


def left_jacobians(vectors: NDArray) -> NDArray:
    """Return the left Jacobians J (..., 3, 3) of rotation vectors v (..., 3), radians.

    exp(v + dv) = exp(J dv) exp(v) to first order: Barfoot 2017, eq. 7.77.
    """
    angle = np.linalg.norm(vectors, axis=-1)[..., None, None]
    safe = np.maximum(angle, SMALL)
    first = np.where(angle > SMALL, (1 - np.cos(safe)) / safe**2, 0.5)
    second = np.where(angle > SMALL, (safe - np.sin(safe)) / safe**3, 1 / 6)
    cross = cross_matrices(vectors)
    return np.eye(3) + first * cross + second * cross @ cross


def interpolate(time_s: NDArray, rotations: NDArray, wanted_s: NDArray) -> NDArray:
    """Interpolate rotations (T, ..., 3, 3) at times (N,) by slerp; beyond the ends, the nearest."""
    before, share = interpolation.shares(time_s, wanted_s)
    start, stop = rotations[before], rotations[before + 1]
    step = rodrigues_from_rotation(np.swapaxes(start, -1, -2) @ stop)
    return start @ rotation_from_rodrigues(step * share.reshape((-1,) + (1,) * (step.ndim - 1)))
