"""Rotation matrices and rotation vectors: conversion, interpolation, rotations between directions."""

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


SMALL = 1e-6  # radians: below, the first terms of the series


def matrices_from_vectors(vectors):
    """Return the rotations (..., 3, 3) of rotation vectors (..., 3), radians."""
    vectors = np.asarray(vectors, float)
    flat = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix()
    return flat.reshape(*vectors.shape, 3)


def vectors_from_matrices(rotations):
    """Return the rotation vectors (..., 3), radians, of rotations (..., 3, 3)."""
    rotations = np.asarray(rotations, float)
    flat = Rotation.from_matrix(rotations.reshape(-1, 3, 3)).as_rotvec()
    return flat.reshape(rotations.shape[:-1])


def cross_matrices(vectors):
    """Return the matrices (..., 3, 3) that take the cross product of vectors (..., 3) with what follows."""
    x, y, z = np.moveaxis(np.asarray(vectors, float), -1, 0)
    none = np.zeros_like(x)
    rows = [none, -z, y, z, none, -x, -y, x, none]
    return np.stack(rows, -1).reshape(*x.shape, 3, 3)


def left_jacobians(vectors):
    """Return how a rotation turns, in the outer frame, as its rotation vector changes.

    Parameters
    ----------
    vectors : (..., 3) float
        Rotation vectors, radians.

    Returns
    -------
    jacobians : (..., 3, 3) float
        J with exp(v + dv) = exp(J dv) exp(v) to first order.

    Notes
    -----
    Barfoot 2017, eq. 7.77.
    """
    angle = np.linalg.norm(vectors, axis=-1)[..., None, None]
    safe = np.maximum(angle, SMALL)
    first = np.where(angle > SMALL, (1 - np.cos(safe)) / safe**2, 0.5)
    second = np.where(angle > SMALL, (safe - np.sin(safe)) / safe**3, 1 / 6)
    cross = cross_matrices(vectors)
    return np.eye(3) + first * cross + second * cross @ cross


def interpolate(time_s, rotations, wanted_s):
    """Return rotations between samples, turning at constant speed from one to the next.

    Parameters
    ----------
    time_s : (T,) float
        Increasing.
    rotations : (T, ..., 3, 3) float
    wanted_s : (N,) float
        Times outside the samples take the nearest one.

    Returns
    -------
    rotations : (N, ..., 3, 3) float
    """
    before, share = interpolation_shares(time_s, wanted_s)
    start, stop = rotations[before], rotations[np.minimum(before + 1, len(time_s) - 1)]
    step = vectors_from_matrices(np.swapaxes(start, -1, -2) @ stop)
    return start @ matrices_from_vectors(step * share.reshape((-1,) + (1,) * (step.ndim - 1)))


def interpolation_shares(time_s, wanted_s):
    """Return the sample before each wanted time (N,) and the share of the way to the next (N,)."""
    wanted_s = np.clip(wanted_s, time_s[0], time_s[-1])
    before = np.clip(np.searchsorted(time_s, wanted_s, side="right") - 1, 0, len(time_s) - 2)
    return before, (wanted_s - time_s[before]) / (time_s[before + 1] - time_s[before])


NEARLY_OPPOSITE = -1 + 1e-9
NO_TURN = np.eye(3)


def unit_vector(vector):
    """Return a vector (3,) of length 1 of the same direction."""
    return vector / np.sqrt(vector @ vector)


def swing(start, end):
    """Return the smallest rotation (3, 3) that turns one unit vector into another.

    Of opposite vectors there are many; one of them is returned.
    """
    cosine = start @ end
    if cosine < NEARLY_OPPOSITE:
        aside = unit_vector(np.cross(start, NO_TURN[np.argmin(np.abs(start))]))
        return 2 * np.outer(aside, aside) - NO_TURN
    cross = skew(cross3(start, end))
    return NO_TURN + cross + cross @ cross / (1 + cosine)


def about_axis(axis, angle):
    """Return the rotation (3, 3) about a unit vector by an angle, radians."""
    cross = skew(axis)
    return NO_TURN + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def angle_about(axis, start, end):
    """Return the angle from one vector to another as seen along an axis, radians in -pi..pi.

    Parameters
    ----------
    axis : (3,) float
        Unit vector; only the parts of the others orthogonal to it count.
    start, end : (3,) float

    Returns
    -------
    angle : float
    """
    start, end = start - (start @ axis) * axis, end - (end @ axis) * axis
    return float(np.arctan2(axis @ cross3(start, end), start @ end))


def twist(rotation, axis):
    """Return by how much a rotation turns about an axis, radians in -pi..pi (swing-twist decomposition).

    Parameters
    ----------
    rotation : (3, 3) float
    axis : (3,) float
        Unit vector.

    Returns
    -------
    angle : float
        What is left of the rotation after the smallest one that turns the axis as it does.
    """
    rest = swing(axis, rotation @ axis).T @ rotation
    sine = 0.5 * np.array(
        [rest[2, 1] - rest[1, 2], rest[0, 2] - rest[2, 0], rest[1, 0] - rest[0, 1]]
    )
    return float(np.arctan2(sine @ axis, (np.trace(rest) - 1) / 2))


def shares(start, end, parts):
    """Return rotations on the shortest way from one to another.

    Parameters
    ----------
    start, end : (3, 3) float
    parts : list of float
        How much of the way, 0..1.

    Returns
    -------
    rotations : list of (3, 3) float
    """
    turn = start.T @ end
    sine = 0.5 * np.array(
        [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
    )
    length = np.sqrt(sine @ sine)
    angle = np.arctan2(length, (np.trace(turn) - 1) / 2)
    if length < 1e-9:  # ASSUME: nobody turns the head or the trunk by half a turn
        return [start for _ in parts]
    return [start @ about_axis(sine / length, part * angle) for part in parts]


def skew(vector):
    """Return the matrix (3, 3) whose product with another vector is the cross product."""
    x, y, z = vector.tolist()  # arithmetic on NumPy's own numbers takes several times as long
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def cross3(first, second):
    """Return the cross product (3,) of two vectors; NumPy's own takes ten times as long on so few."""
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])
