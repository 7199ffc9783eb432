"""Centre of mass of the body, as a weighted mean of joints.

Segment masses and centres are those of de Leva (1996, J. Biomech. 29, 1223-1230, table 4).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.records.keypoints.derived_joints import DerivedJoints
from courtside.study.errors import InputError

SIDES = ("left_", "right_")


@dataclass(frozen=True)
class Segment:
    """Mass of a segment and the place of its centre of mass."""

    start: str  # `start` and `end` are points; limbs without their side
    end: str
    mass: dict[str, float]  # percent of the body's mass for `m` and `f`; of one side for limbs
    place: dict[str, float]  # percent of the way from `start` to `end`
    paired: bool = True  # whether there is one on each side


# The hand's centre lies beyond the wrist on the forearm's line: at 79.00 (74.74) % of the 86.2
# (78.0) mm from wrist to third knuckle, for a forearm of 268.9 (264.3) mm; men (women).
HAND = {"m": 100 + 79.00 * 86.2 / 268.9, "f": 100 + 74.74 * 78.0 / 264.3}
SEGMENTS = {
    "head": Segment("head_mass", "head_mass", {"m": 6.94, "f": 6.68}, {"m": 0, "f": 0}, False),
    "trunk": Segment(
        "mid_shoulder", "mid_hip", {"m": 43.46, "f": 42.57}, {"m": 43.10, "f": 37.82}, False
    ),
    "upper_arm": Segment("shoulder", "elbow", {"m": 2.71, "f": 2.55}, {"m": 57.72, "f": 57.54}),
    "forearm": Segment("elbow", "wrist", {"m": 1.62, "f": 1.38}, {"m": 45.74, "f": 45.59}),
    "hand": Segment("elbow", "wrist", {"m": 0.61, "f": 0.56}, HAND),
    "thigh": Segment("hip", "knee", {"m": 14.16, "f": 14.78}, {"m": 40.95, "f": 36.12}),
    "shank": Segment("knee", "ankle", {"m": 4.33, "f": 4.81}, {"m": 43.95, "f": 43.52}),
    "foot": Segment("ankle", "ankle", {"m": 1.37, "f": 1.29}, {"m": 0, "f": 0}),
}


def place(segment: str, sex: str | None) -> float:
    """Return where a segment's centre of mass lies from its start (0) to its end (1).

    Without a sex it is that of the mean of men's and women's shares of mass (`shares`).
    """
    own = SEGMENTS[segment]
    of = (sex,) if sex else ("m", "f")
    return (
        sum(own.mass[one] * own.place[one] for one in of) / sum(own.mass[one] for one in of) / 100
    )


def shares(sex: str | None) -> dict[str, float]:
    """Return the share of the body's mass at each point.

    `sex` is "m" or "f"; None gives the mean of men and women. The points are `head_mass`,
    `mid_shoulder`, `mid_hip` and the 12 limb joints; the shares sum to 1. The hand lies beyond the
    wrist, which makes the wrists' shares larger than the forearm's part and the elbows' smaller. An
    `InputError` if `sex` is none of these.

    Trunk: a straight line from mid-shoulder to mid-hip, which does not follow a bent back. Head:
    the point `head_mass` of `config/derived_joints.yaml`. Hand: on the forearm's line, as if the
    wrist were straight; a wrist bent by 60 degrees moves the body's centre by 0.4 mm. Foot: at the
    ankle; its centre is 6 to 8 cm in front of and below it, which moves the body's centre by about
    1 mm per foot. The mass of a racket (0.09 kg) is left out: about 1 mm.
    """
    if sex is None:
        both = [shares("m"), shares("f")]
        return {point: (both[0][point] + both[1][point]) / 2 for point in both[0]}
    if sex not in ("m", "f"):
        raise InputError(f"subject: sex: expected m or f, or none stated, found {sex!r}")
    found: dict[str, float] = {}
    for segment in SEGMENTS.values():
        place = segment.place[sex] / 100
        for side in SIDES if segment.paired else ("",):
            for point, part in ((segment.start, 1 - place), (segment.end, place)):
                name = side + point
                found[name] = found.get(name, 0.0) + segment.mass[sex] * part
    total = sum(found.values())  # 100.00 and 99.99 in print
    return {point: mass / total for point, mass in found.items()}


def weights(
    table: DerivedJoints, skeleton: str, joints: Sequence[str] | NDArray, sex: str | None
) -> NDArray:
    """Return the weights (J,) of the joints of a named skeleton that make the centre of mass."""
    parts = [share * table.weights(skeleton, point, joints) for point, share in shares(sex).items()]
    return np.sum(parts, axis=0)
