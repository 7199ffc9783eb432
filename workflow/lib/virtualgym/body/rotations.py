"""Rotations of one bone at a time: swing, twist, and turns about an axis.

On single vectors several times as fast as the functions of arrays in `courtside.geometry`.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

NEARLY_OPPOSITE = -1 + 1e-9  # ASSUME: cosine below which the plane of the swing is not determined
NO_TURN = np.eye(3)


def unit_vector(vector: NDArray) -> NDArray:
    """Return a vector (3,) of length 1 of the same direction."""
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
    """Return the cross product (3,) of two vectors; ten times as fast as NumPy's."""
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])
