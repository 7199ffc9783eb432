"""Rotations of many frames and joints at once: as vectors, how they change, between samples."""

import numpy as np
from scipy.spatial.transform import Rotation

SMALL = 1e-6  # radians: below, the first terms of the series


def matrices(vectors):
    """Return the rotations (..., 3, 3) of rotation vectors (..., 3), radians."""
    vectors = np.asarray(vectors, float)
    flat = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix()
    return flat.reshape(*vectors.shape, 3)


def vectors(rotations):
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


def between(time_s, rotations, wanted_s):
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
    before, share = places(time_s, wanted_s)
    start, stop = rotations[before], rotations[np.minimum(before + 1, len(time_s) - 1)]
    step = vectors(np.swapaxes(start, -1, -2) @ stop)
    return start @ matrices(step * share.reshape((-1,) + (1,) * (step.ndim - 1)))


def places(time_s, wanted_s):
    """Return the sample before each wanted time (N,) and the share of the way to the next (N,)."""
    wanted_s = np.clip(wanted_s, time_s[0], time_s[-1])
    before = np.clip(np.searchsorted(time_s, wanted_s, side="right") - 1, 0, len(time_s) - 2)
    return before, (wanted_s - time_s[before]) / (time_s[before + 1] - time_s[before])
