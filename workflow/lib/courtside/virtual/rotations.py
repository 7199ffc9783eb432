"""Rotations that posing a body needs: the shortest between two ways, about an axis, parts of a turn."""

import numpy as np

NEARLY_OPPOSITE = -1 + 1e-9
NO_TURN = np.eye(3)


def unit(vector):
    """Return a vector (3,) of length 1 of the same direction."""
    return vector / np.sqrt(vector @ vector)


def swing(start, end):
    """Return the smallest rotation (3, 3) that turns one unit vector into another.

    Of opposite vectors there are many; one of them is returned.
    """
    cosine = start @ end
    if cosine < NEARLY_OPPOSITE:
        aside = unit(np.cross(start, NO_TURN[np.argmin(np.abs(start))]))
        return 2 * np.outer(aside, aside) - NO_TURN
    cross = skew(cross3(start, end))
    return NO_TURN + cross + cross @ cross / (1 + cosine)


def about(axis, angle):
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
    return [start @ about(sine / length, part * angle) for part in parts]


def skew(vector):
    """Return the matrix (3, 3) whose product with another vector is the cross product."""
    x, y, z = vector.tolist()  # arithmetic on NumPy's own numbers takes several times as long
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def cross3(first, second):
    """Return the cross product (3,) of two vectors; NumPy's own takes ten times as long on so few."""
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])
