"""Joint angles by name, plane and sign, with their standard deviations.

Rotations between segments are split as the International Society of Biomechanics recommends: of
hip, trunk and neck into flexion about Z, then adduction about X, then axial rotation about Y (Grood
& Suntay 1983; Wu et al. 2002); of the arm against the thorax into plane of elevation, elevation and
axial rotation, Y-X-Y (Wu et al. 2005). The pelvis in the hall is first rotated about the vertical,
then split into list and tilt, Y-X-Z: so these do not depend on where a person faces (Baker 2001).
Hinges have their angles at once. The left side is mirrored first, so that both sides have the signs
of the right one.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from courtside.body_model import fit, segments
from courtside.body_model import pose as poses
from courtside.body_model.fit import Spread
from courtside.body_model.pose import Pose
from courtside.body_model.segments import SIDES, Model
from courtside.kinematics.shared_errors import NETWORK_SHARE

ZXY, YXY, YXZ = (2, 0, 1), (1, 0, 1), (1, 0, 2)
# Segment, its ancestor, sequence; names and signs of the three angles. OpenSim splits the pelvis,
# too, Z-X-Y: those angles are in `exports.opensim_model` alone.
FREE = {
    "pelvis": (None, YXZ, (("pelvis_rotation", 1), ("pelvis_list", 1), ("pelvis_tilt", -1))),
    "thorax": ("pelvis", ZXY, (("trunk_flexion", -1), ("trunk_bending", 1), ("trunk_rotation", 1))),
    "head": ("thorax", ZXY, (("neck_flexion", -1), ("neck_bending", 1), ("neck_rotation", 1))),
    "femur": (
        "pelvis",
        ZXY,
        (("hip_flexion", 1), ("hip_adduction", 1), ("hip_internal_rotation", 1)),
    ),
    "humerus": (
        "thorax",
        YXY,
        (("shoulder_plane", 1), ("shoulder_elevation", -1), ("shoulder_internal_rotation", 1)),
    ),
}
HINGES = {  # segment: names and signs of its two angles, of the right side
    "forearm": (("elbow_flexion", 1), ("forearm_pronation", 1)),
    "hand": (("wrist_flexion", 1), ("wrist_ulnar_deviation", 1)),
    "tibia": (("knee_flexion", -1), ("knee_internal_rotation", 1)),
    "foot": (("ankle_dorsiflexion", 1), ("ankle_inversion", 1)),
}
MIRROR = np.array([1.0, 1.0, -1.0])
UP_Y = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])  # world to OpenSim's: y, z, x


def measure(model: Model, pose: Pose, covariance: NDArray) -> dict[str, tuple[NDArray, NDArray]]:
    """Return all angles and their standard deviations (T,) degrees by name; sides are prefixes.

    `covariance` (T, D, D) is that of the coordinates.
    """
    _, turned = poses.forward(model, pose, np.zeros((len(model.names), 3)))
    world = poses.axes(model, turned)
    found: dict[str, tuple[NDArray, NDArray]] = {}
    for at, name in enumerate(model.names):
        side, part = _split(name)
        if part in HINGES:
            for k, (angle, sign) in enumerate(HINGES[part]):
                column = model.first[at] + k
                mirrored = -1 if side == "left" and model.joints[at].axes[k] != 2 else 1
                value = sign * mirrored * pose.angle[:, column]
                spread = np.sqrt(np.minimum(covariance[:, column, column], np.pi**2))
                found[_named(side, angle)] = np.degrees(value), np.degrees(spread)
        elif part in FREE:
            found |= dict(_of_rotation(model, at, turned, world, covariance))
    return found


def of_fit(model: Model, pose: Pose, spread: Spread) -> dict[str, tuple[NDArray, NDArray]]:
    """Return the angles of a fit; of the variance of the network's errors a share counts.

    That of the prior counts in full: where the points do not show an angle, nothing else says it.
    """
    own = slice(0, len(model.sigma))  # without the lengths, whose errors these contain
    total, noise = spread.total[:, own, own], spread.noise[:, own, own]
    certain = noise + fit.from_prior(model, pose, spread)
    return measure(model, pose, certain + NETWORK_SHARE * (total - certain))


def names() -> tuple[str, ...]:
    """Return the names of all angles, in their order."""
    found = []
    for name in segments.model().names:
        side, part = _split(name)
        those = HINGES.get(part) or FREE.get(part, (None, None, ()))[2]
        found += [_named(side, angle) for angle, _ in those]
    return tuple(found)


def _of_rotation(
    model: Model, at: int, turned: NDArray, world: NDArray, covariance: NDArray
) -> Iterator[tuple[str, tuple[NDArray, NDArray]]]:
    """Yield name, values and standard deviations of the three angles of one free joint."""
    side, part = _split(model.names[at])
    ancestor, order, named = FREE[part]
    base = turned[model.names.index(ancestor)] if ancestor else UP_Y.T
    rotation = np.swapaxes(base, -1, -2) @ turned[at]
    above = model.moves[:, model.names.index(ancestor)] if ancestor else False
    own = (model.moves[:, at] & ~np.asarray(above)) & (np.arange(len(model.sigma)) > 2)
    spin = np.einsum("tba,tdb->tad", turned[at], world[:, own])  # in the segment's axes
    if side == "left":
        rotation = MIRROR[:, None] * rotation * MIRROR
        spin = spin * -MIRROR[:, None]
    value, rates = split(rotation, order)
    by = np.linalg.pinv(rates) @ spin
    spread = np.einsum("tad,tde,tae->ta", by, covariance[:, own][:, :, own], by, optimize=True)
    for k, (angle, sign) in enumerate(named):
        found = np.degrees(np.sqrt(np.minimum(spread[:, k], np.pi**2)))
        yield _named(side, angle), (np.degrees(sign * value[:, k]), found)


def split(rotation: NDArray, order: tuple[int, int, int]) -> tuple[NDArray, NDArray]:
    """Return the angles (T, 3) rad of rotations (T, 3, 3), and the axes (T, 3, 3) of their rates.

    `order` is `ZXY`, `YXZ` or `YXY`, of which the elevation is negative. Columns of the rates are
    in the axes of the turned segment.
    """
    r = rotation
    if order == ZXY:
        first = np.arctan2(-r[:, 0, 1], r[:, 1, 1])
        middle = np.arcsin(np.clip(r[:, 2, 1], -1, 1))
        last = np.arctan2(-r[:, 2, 0], r[:, 2, 2])
    elif order == YXZ:
        first = np.arctan2(r[:, 0, 2], r[:, 2, 2])
        middle = -np.arcsin(np.clip(r[:, 1, 2], -1, 1))
        last = np.arctan2(r[:, 1, 0], r[:, 1, 1])
    else:
        first = np.arctan2(-r[:, 0, 1], -r[:, 2, 1])
        middle = -np.arccos(np.clip(r[:, 1, 1], -1, 1))
        last = np.arctan2(-r[:, 1, 0], r[:, 1, 2])
    inner = np.swapaxes(poses.about(order[2], last), 1, 2)
    both = inner @ np.swapaxes(poses.about(order[1], middle), 1, 2)
    third = np.broadcast_to(np.eye(3)[order[2]], (len(r), 3))
    rates = np.stack([both[:, :, order[0]], inner[:, :, order[1]], third], axis=2)
    return np.stack([first, middle, last], axis=1), rates


def _split(name: str) -> tuple[str, str]:
    side, _, part = name.partition("_")
    return (side, part) if side in SIDES else ("", name)


def _named(side: str, angle: str) -> str:
    return f"{side}_{angle}" if side else angle
