"""Joint angles, and the lean of the trunk, with their uncertainty.

The angles lie between straight lines from joint to joint. They are not those of the International
Society of Biomechanics (Wu et al. 2002, 2005), which are rotations between segment frames, split
into flexion, abduction and axial rotation: a segment frame needs three points that are not in line,
and a segment here has only the joints at its two ends. An angle here measures how far a joint is
bent, not about which axis: abduction and flexion of the hip are one number, and axial rotation is
not measured.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from courtside.kinematics.shared_errors import Errors

# Slopes (T, 3) of a value, radians per metre of each point -> its variance (T,).
Variance = Callable[[Sequence[NDArray]], NDArray]
SIDES = ("left_", "right_")
UP = np.array([0.0, 0.0, 1.0])
# ASSUME: the line of the hips says where is forwards up to this slope: beyond, its linear errors
# end (70 degrees: 90 % intervals hold 77 %).
STEEPEST_DEG = 70.0
LINES = {  # angle: first, middle, last joint; whether it is measured from the straight line
    "knee_flexion": ("hip", "knee", "ankle", True),
    "elbow_flexion": ("shoulder", "elbow", "wrist", True),
    "hip_flexion": ("shoulder", "hip", "knee", True),
    "shoulder_elevation": ("hip", "shoulder", "elbow", False),
}
TRUNK = ("left_hip", "right_hip", "left_shoulder", "right_shoulder")
DICTIONARY = {  # angle: zero, sign
    "knee_flexion": "0 with hip, knee and ankle in line, positive however it is bent",
    "elbow_flexion": "0 with shoulder, elbow and wrist in line, positive however it is bent",
    "hip_flexion": "0 with shoulder, hip and knee in line; positive forwards, backwards and "
    "sideways",
    "shoulder_elevation": "0 with the arm along the line from shoulder to hip, 90 held out, 180 "
    "overhead; positive in every direction",
    "trunk_lean": "between the line from mid-hip to mid-shoulder and the vertical; 0 upright, "
    "never negative",
    "trunk_lean_forward": "its part in the person's own vertical plane from back to front; "
    "positive forwards",
}


@dataclass(frozen=True, eq=False)
class Angle:
    """One angle over time (T,); NaN where a joint, or for sigma a covariance, is missing."""

    degrees: NDArray
    sigma_deg: NDArray


def joined(parts: Sequence[Angle]) -> Angle:
    """Return an angle over the frames of several parts, one after the other."""
    each = ([getattr(part, key) for part in parts] for key in ("degrees", "sigma_deg"))
    return Angle(*map(np.concatenate, each))


def between(first: NDArray, middle: NDArray, last: NDArray, variance: Variance) -> Angle:
    """Return the angle, 0 to 180 degrees, at the middle one of three points (T, 3) m.

    `variance` is of the errors of these points (`Errors.variance`).

    A point at distance l that moves across its line turns the line by 1 / l. This holds while the
    error is much smaller than the bend: near 0 and 180 degrees the angle folds, and noise only ever
    bends a straight line, by about sigma.
    """
    u, v = first - middle, last - middle
    length_u, length_v = (np.linalg.norm(a, axis=-1, keepdims=True) for a in (u, v))
    u, v = u / length_u, v / length_v
    normal = np.cross(u, v)
    sine = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = np.where(sine > 1e-9, normal / np.where(sine > 1e-9, sine, 1), _any_normal(u))
    radians = np.arctan2(sine[..., 0], np.sum(u * v, axis=-1))
    by_first = -np.cross(normal, u) / length_u
    by_last = np.cross(normal, v) / length_v
    slopes = (by_first, -by_first - by_last, by_last)
    return _angle(radians, slopes, variance)


def _any_normal(u: NDArray) -> NDArray:
    """Return unit vectors at right angles to (T, 3) unit vectors."""
    axis = np.eye(3)[np.argmin(np.nan_to_num(np.abs(u)), axis=-1)]
    found = np.cross(u, axis)
    return found / np.linalg.norm(found, axis=-1, keepdims=True)


def _angle(radians: NDArray, slopes: Sequence[NDArray], variance: Variance) -> Angle:
    return Angle(np.degrees(radians), np.degrees(np.sqrt(variance(slopes))))


def trunk(
    hips: Sequence[NDArray], shoulders: Sequence[NDArray], variance: Variance
) -> tuple[Angle, Angle]:
    """Return the trunk's lean and its forward part, as `DICTIONARY` defines them.

    Points (T, 3) m, and what `variance` is of, are the left and right hip, the left and right
    shoulder. Forwards is level and at right angles to the line of the hips; where this is steeper
    than `STEEPEST_DEG`, the forward part is NaN.
    """
    along = (shoulders[0] + shoulders[1] - hips[0] - hips[1]) / 2
    length = np.linalg.norm(along, axis=-1, keepdims=True)
    level = along * [1, 1, 0]
    flat = np.linalg.norm(level, axis=-1, keepdims=True)
    height = along[:, 2:]
    direction = np.where(flat > 1e-9, level / np.where(flat > 1e-9, flat, 1), [1.0, 0, 0])
    lean_slope = (direction * height - UP * flat) / length**2
    lean = _angle(np.arctan2(flat, height)[:, 0], _of_ends(lean_slope), variance)
    line = hips[0] - hips[1]
    width = np.linalg.norm(line[:, :2], axis=-1, keepdims=True)
    steep = np.abs(line[:, 2:]) > np.tan(np.radians(STEEPEST_DEG)) * width
    left = line * [1, 1, 0] / np.where(steep, np.nan, width)
    ahead = np.cross(left, UP)
    reach, aside = (np.sum(along * axis, axis=-1, keepdims=True) for axis in (ahead, left))
    slope = (ahead * height - UP * reach) / (reach**2 + height**2)
    turn = -ahead * aside * height / (reach**2 + height**2) / width  # by the left hip
    ends = _of_ends(slope)
    slopes = [ends[0] + turn, ends[1] - turn, *ends[2:]]
    return lean, _angle(np.arctan2(reach, height)[:, 0], slopes, variance)


def _of_ends(slope: NDArray) -> list[NDArray]:
    """Return the slopes of the trunk's four corners, from that of the line between its ends."""
    return [-slope / 2, -slope / 2, slope / 2, slope / 2]


def measure(xyz: NDArray, errors: Errors, joints: Sequence[str]) -> dict[str, Angle]:
    """Return all angles of a person by name, those of limbs with their side: `left_knee_flexion`.

    `xyz` (T, J, 3) m are filtered joints, the 12 limb joints among them, and `errors` theirs.
    """
    at = {joint: index for index, joint in enumerate(joints)}
    angles = {}
    for name, (*ends, rest) in LINES.items():
        for side in SIDES:
            three = [at[side + end] for end in ends]
            first, middle, last = (xyz[:, index] for index in three)
            found = between(first, middle, last, partial(errors.variance, three))
            angles[side + name] = Angle(180 - found.degrees, found.sigma_deg) if rest else found
    four = [at[joint] for joint in TRUNK]
    points = [xyz[:, index] for index in four]
    leans = trunk(points[:2], points[2:], partial(errors.variance, four))
    angles["trunk_lean"], angles["trunk_lean_forward"] = leans
    return angles
