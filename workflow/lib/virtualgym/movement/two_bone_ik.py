"""Body rotations, and inverse kinematics of a limb of two segments."""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def facing(heading: float) -> NDArray:
    """Return the body axes (3, 3) of an upright body: columns left, up, forward.

    The heading is in radians, anticlockwise seen from above; 0 looks along the world's y.
    """
    sin, cos = np.sin(heading), np.cos(heading)
    return np.array([[-cos, 0.0, -sin], [-sin, 0.0, cos], [0.0, 1.0, 0.0]])


def turn(twist: float = 0.0, pitch: float = 0.0, roll: float = 0.0) -> NDArray:
    """Return the rotation (3, 3): turn left, lean forward, lean right, about own axes, radians."""
    st, ct, sp, cp = np.sin(twist), np.cos(twist), np.sin(pitch), np.cos(pitch)
    sr, cr = np.sin(roll), np.cos(roll)
    twisted = np.array([[ct, 0, st], [0, 1, 0], [-st, 0, ct]])
    pitched = np.array([[1, 0, 0], [0, cp, -sp], [0, sp, cp]])
    rolled = np.array([[cr, -sr, 0], [sr, cr, 0], [0, 0, 1]])
    return twisted @ pitched @ rolled


def bend(
    start: NDArray, end: NDArray, lengths: tuple[float, float], pole: NDArray
) -> tuple[NDArray, NDArray]:
    """Bend a limb of two segments so that it spans two points.

    Parameters
    ----------
    start, end : (3,) float
        Ends of the limb, metres. An end out of reach is approached along the straight line.
    lengths : (float, float)
        Of the two segments, metres.
    pole : (3,) float
        Direction in which the joint between them bends; not along the limb.

    Returns
    -------
    first, second : (3,) float
        Unit vectors of the segments, away from the start.
    """
    first, second = lengths
    span = end - start
    whole = np.linalg.norm(span)
    along = span / whole
    reach = np.clip(whole, abs(first - second) + 1e-9, first + second - 1e-9)
    aside = pole - (pole @ along) * along
    aside = aside / np.linalg.norm(aside)
    cos = (first**2 + reach**2 - second**2) / (2 * first * reach)
    upper = cos * along + np.sqrt(max(1 - cos * cos, 0.0)) * aside
    lower = (reach * along - first * upper) / second
    return upper, lower / np.linalg.norm(lower)


def unit(vector: ArrayLike) -> NDArray:
    """Return the unit vector."""
    vector = np.asarray(vector, float)
    return vector / np.linalg.norm(vector)


def across(vector: NDArray, axis: NDArray) -> NDArray:
    """Return the unit vector along a vector's part orthogonal to a unit axis."""
    return unit(vector - (vector @ axis) * axis)
