"""Rotation matrices and vectors: conversion, interpolation, rotations between directions."""

from collections.abc import Iterable

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import interpolation

ROUNDING = 1e-4  # files print rotations with as few as six decimals
SMALL = 1e-6  # radians: below, the first terms of the series
NEARLY_OPPOSITE = -1 + 1e-9  # ASSUME: cosine below which the plane of the swing is not determined
NO_TURN = np.eye(3)


def rotation_from_rodrigues(vectors: ArrayLike) -> NDArray:
    """Return the rotations (..., 3, 3) of rotation vectors (..., 3), axis times radians."""
    return scipy.spatial.transform.Rotation.from_rotvec(vectors).as_matrix()


def rodrigues_from_rotation(rotations: ArrayLike) -> NDArray:
    """Return the rotation vectors (..., 3), axis times radians, of rotations (..., 3, 3)."""
    return scipy.spatial.transform.Rotation.from_matrix(rotations).as_rotvec()


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
    start, stop = rotations[before], rotations[np.minimum(before + 1, len(time_s) - 1)]
    step = rodrigues_from_rotation(np.swapaxes(start, -1, -2) @ stop)
    return start @ rotation_from_rodrigues(step * share.reshape((-1,) + (1,) * (step.ndim - 1)))


def unit_vector(vector: NDArray) -> NDArray:
    """Return a vector (3,) of length 1 of the same direction; faster than `unit` on one vector."""
    return vector / np.sqrt(vector @ vector)


def swing(start: NDArray, end: NDArray) -> NDArray:
    """Return the smallest rotation (3, 3) of a unit vector to another; one of many if opposite."""
    cosine = start @ end
    if cosine < NEARLY_OPPOSITE:
        aside = unit_vector(np.cross(start, NO_TURN[np.argmin(np.abs(start))]))
        return 2 * np.outer(aside, aside) - NO_TURN
    cross = skew(cross3(start, end))
    return NO_TURN + cross + cross @ cross / (1 + cosine)


def about_axis(axis: NDArray, angle: float) -> NDArray:
    """Return the rotation (3, 3) about a unit vector by an angle, radians."""
    cross = skew(axis)
    return NO_TURN + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def angle_about(axis: NDArray, start: NDArray, end: NDArray) -> float:
    """Return the angle from one vector to another about a unit vector, radians in -pi..pi.

    Only the parts of the vectors (3,) orthogonal to the axis count.
    """
    start, end = start - (start @ axis) * axis, end - (end @ axis) * axis
    return float(np.arctan2(axis @ cross3(start, end), start @ end))


def twist(rotation: NDArray, axis: NDArray) -> float:
    """Return the twist of a rotation (3, 3) about a unit vector (3,), radians in -pi..pi.

    Swing-twist decomposition: what remains after the smallest rotation that moves the axis alike.
    """
    rest = swing(axis, rotation @ axis).T @ rotation
    return float(np.arctan2(_sine_axis(rest) @ axis, (np.trace(rest) - 1) / 2))


def shares(start: NDArray, end: NDArray, parts: Iterable[float]) -> list[NDArray]:
    """Return rotations at shares 0..1 of the shortest way from one rotation (3, 3) to another."""
    turn = start.T @ end
    sine = _sine_axis(turn)
    length = np.sqrt(sine @ sine)
    angle = np.arctan2(length, (np.trace(turn) - 1) / 2)
    if length < 1e-9:  # ASSUME: no turn, for nobody turns the head or the trunk by half a turn
        return [start for _ in parts]
    return [start @ about_axis(sine / length, part * angle) for part in parts]


def _sine_axis(turn: NDArray) -> NDArray:
    """Return the axis (3,) of a rotation (3, 3) times the sine of its angle."""
    return 0.5 * np.array(
        [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
    )


def skew(vector: NDArray) -> NDArray:
    """Return the matrix (3, 3) whose product with another vector is the cross product."""
    x, y, z = vector.tolist()  # Python floats are several times as fast as NumPy scalars
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def cross3(first: NDArray, second: NDArray) -> NDArray:
    """Return the cross product (3,) of two vectors; ten times as fast as NumPy's on one pair."""
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])
