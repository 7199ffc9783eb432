"""The skeletal model: segments, their joints with axes, ranges and priors, the points on them.

Axes of every segment: X forwards, Y up, Z to the right in the standing body (Wu et al. 2002, 2005).
Left and right have the same axes: flexion has one sign, abduction and axial rotation have opposite
ones until `angles` gives them by name.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

BALL = "ball"  # a free rotation
HINGES = "hinges"  # a turn about a fixed axis, then one about another


@dataclass(frozen=True)
class Coordinate:
    """One degree of freedom: its range, and a normal prior about 0; degrees."""

    sigma_deg: float
    low_deg: float = -180.0
    high_deg: float = 180.0


@dataclass(frozen=True)
class Joint:
    """How a segment hangs on its parent."""

    parent: str | None
    kind: str
    # Of a ball three, about X, Y and Z from `rest`; of hinges two, about `axes`
    coordinates: tuple[Coordinate, ...]
    axes: tuple[int, ...] = (0, 1, 2)
    rest: float = 0.0  # turn about X of the rest of a ball joint, degrees; right side


FREE, HALL_M = 400.0, 100.0  # degrees, metres: no prior
# Ranges: the largest of Kapandji's and the AAOS' normal ranges of motion, rounded outwards for
# athletes; ASSUME: the clavicle's. ASSUME: standard deviations of priors: what people in sport use
# of these ranges where joint centres do not show it; they decide axial rotation of straight limbs,
# the pelvis' tilt and the share of the clavicle.
LIMBS = {
    "clavicle": Joint("thorax", HINGES, (Coordinate(12, -45, 15), Coordinate(12, -35, 35)), (0, 1)),
    # From an arm held out to the side
    "humerus": Joint(
        "clavicle",
        BALL,
        (Coordinate(FREE), Coordinate(50, -110, 110), Coordinate(FREE)),
        rest=-90,
    ),
    "forearm": Joint(
        "humerus", HINGES, (Coordinate(FREE, -5, 155), Coordinate(45, -90, 90)), (2, 1)
    ),
    "hand": Joint("forearm", HINGES, (Coordinate(30, -90, 90), Coordinate(15, -35, 45)), (2, 0)),
    "femur": Joint(
        "pelvis",
        BALL,
        (Coordinate(60, -60, 60), Coordinate(20, -55, 55), Coordinate(FREE, -50, 145)),
    ),
    "tibia": Joint("femur", HINGES, (Coordinate(FREE, -160, 5), Coordinate(10, -40, 40)), (2, 1)),
    "foot": Joint("tibia", HINGES, (Coordinate(25, -60, 40), Coordinate(10, -35, 35)), (2, 0)),
}
TRUNK = {
    "pelvis": Joint(None, BALL, (Coordinate(FREE),) * 3),
    "thorax": Joint(
        "pelvis", BALL, (Coordinate(12, -40, 40), Coordinate(15, -60, 60), Coordinate(10, -90, 40))
    ),
    "head": Joint(
        "thorax", BALL, (Coordinate(20, -50, 50), Coordinate(30, -90, 90), Coordinate(25, -80, 80))
    ),
}
SIDES = ("left", "right")
# Segments that limb joints are the origins of.
ORIGINS = {
    "shoulder": "humerus", "elbow": "forearm", "wrist": "hand",
    "hip": "femur", "knee": "tibia", "ankle": "foot",
}  # fmt: skip
# Other points of a network, by the segment that they are fixed to.
POINTS = {
    "foot": ("heel", "foot_index", "big_toe", "small_toe", "toe"),
    "hand": ("pinky", "index", "thumb", "hand"),
    "thorax": ("neck",),
    "pelvis": ("mid_hip",),
    "head": (
        "nose", "eye_inner", "eye", "eye_outer", "ear", "mouth", "head", "head_top", "head_centre"
    ),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Model:
    """The tree of segments as arrays; D degrees of freedom, of which the first three are places."""

    names: tuple[str, ...]  # S
    parents: NDArray  # (S,) int
    joints: tuple[Joint, ...]
    first: NDArray  # (S,) int: first degree of freedom of each segment
    rest: NDArray  # (S, 3, 3): rotation in the parent at coordinates zero
    sigma: NDArray  # (D,) rad or m
    low: NDArray  # (D,) rad
    high: NDArray  # (D,) rad
    moves: NDArray  # (D, S) bool: whether a degree of freedom moves a segment


@cache
def model() -> Model:
    """Return the whole body's model."""
    joints = {name: TRUNK[name] for name in TRUNK}
    for side in SIDES:
        joints |= {f"{side}_{name}": joint for name, joint in LIMBS.items()}
    names = tuple(joints)
    parents = np.array([_parent(name, joint, names) for name, joint in joints.items()])
    first, sigma, low, high = [], [HALL_M] * 3, [-np.inf] * 3, [np.inf] * 3
    rest = np.tile(np.eye(3), (len(names), 1, 1))
    below = np.eye(len(names), dtype=bool)  # row: segment; column: what moves with it
    for at in range(len(names) - 1, 0, -1):
        below[parents[at]] |= below[at]
    moves = [below[0]] * 3
    for at, (name, joint) in enumerate(joints.items()):
        left = name.startswith("left_")
        turn = np.radians(-joint.rest if left else joint.rest)
        cosine, sine = np.cos(turn), np.sin(turn)
        rest[at] = [[1, 0, 0], [0, cosine, -sine], [0, sine, cosine]]
        first.append(len(sigma))
        for axis, one in zip(joint.axes, joint.coordinates, strict=True):
            ends = np.radians([one.low_deg, one.high_deg])
            if left and axis != 2:  # about X and Y the sides mirror each other
                ends = -ends[::-1]
            sigma.append(np.radians(one.sigma_deg))
            low.append(ends[0])
            high.append(ends[1])
            moves.append(below[at])
    values = (np.array(values) for values in (first, rest, sigma, low, high, moves))
    return Model(names, parents, tuple(joints.values()), *values)


def _parent(name: str, joint: Joint, names: tuple[str, ...]) -> int:
    if joint.parent is None:
        return -1
    side = name.split("_")[0] + "_"
    return names.index(side + joint.parent if side + joint.parent in names else joint.parent)


def segment_of(joint: str) -> str | None:
    """Return the segment that a named joint of a network is fixed to; None for others."""
    side, _, part = joint.partition("_")
    if side not in SIDES:
        side, part = "", joint
    if part in ORIGINS:
        return f"{side}_{ORIGINS[part]}"
    for segment, parts in POINTS.items():
        if part in parts:
            return segment if segment in TRUNK else f"{side}_{segment}"
    return None
