"""A pose of the virtual athlete: pelvis position, trunk rotations, directions of the limbs."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

SIDES = ("left", "right")
PARTS = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
SEGMENTS = tuple(f"{side}_{part}" for side in SIDES for part in PARTS)
# ASSUME: this share of the trunk's length turns with the pelvis, the rest with the thorax.
LUMBAR_SHARE = 0.45
OTHER = {"left": "right", "right": "left"}


@dataclass(frozen=True)
class Proportions:
    """Lengths of a body, metres, from joint centre to joint centre.

    Attributes
    ----------
    upper_arm, forearm, thigh, shank : float
        Shoulder to elbow, elbow to wrist, hip to knee, knee to ankle.
    hand : float
        Wrist to the tip of the middle finger.
    foot : float
        Ankle to the joint of the toes (the ball of the foot), on which the heel rises.
    hip_width, shoulder_width : float
        Between the two hip joints, the two shoulder joints.
    trunk : float
        Mid-hip to mid-shoulder, standing.
    ankle_height, toe_height : float
        Of the ankle and of the joint of the toes above the floor, foot flat.
    palm : float
        Wrist centre to the surface of the palm: clapping hands have their wrists twice that apart.
    """

    upper_arm: float
    forearm: float
    hand: float
    thigh: float
    shank: float
    foot: float
    hip_width: float
    shoulder_width: float
    trunk: float
    ankle_height: float
    toe_height: float = 0.02
    palm: float = 0.025

    @classmethod
    def of_height(cls, height_m: float) -> "Proportions":
        """Return the mean proportions of an adult of that height [Winter 2009, fig. 4.1].

        The widths are between joint centres, which lie inside the bony points measured there.
        """
        shares = {
            "upper_arm": 0.186,
            "forearm": 0.146,
            "hand": 0.108,
            "thigh": 0.245,
            "shank": 0.246,
            "foot": 0.080,
            "hip_width": 0.100,
            "shoulder_width": 0.205,
            "trunk": 0.288,
            "ankle_height": 0.039,
            "toe_height": 0.011,
            "palm": 0.014,
        }
        return cls(**{name: share * height_m for name, share in shares.items()})


@dataclass(frozen=True, eq=False)
class Stance:
    """A pose without lengths: a body of any proportions can take it.

    Body axes, as columns of the rotations: x to the person's left, y up along the trunk, z forward.

    Attributes
    ----------
    pelvis : (3,) float
        Midpoint of the two hip joints in the world, metres.
    world_from_pelvis, world_from_thorax, world_from_head : (3, 3) float
        Rotations.
    directions : dict of str to (3,) float
        Unit vector in the world from the proximal to the distal joint of each of SEGMENTS (hand:
        wrist to fingertips; foot: ankle to the joint of the toes, so a flat foot points slightly
        down).
    palms : dict of str to (3,) float, or None
        For "left" and "right", the unit vector out of the palm, orthogonal to the hand; None: it
        follows the arm.
    racket : (3,) float or None
        Unit vector from butt to top of the racket in the world; None: no racket.
    racket_hand : str
        "left" or "right".
    """

    pelvis: np.ndarray
    world_from_pelvis: np.ndarray
    world_from_thorax: np.ndarray
    world_from_head: np.ndarray
    directions: dict[str, np.ndarray]
    palms: dict[str, np.ndarray] | None = None
    racket: np.ndarray | None = None
    racket_hand: str = "right"


def mid_shoulder(stance: Stance, proportions: Proportions) -> NDArray:
    """Return the midpoint of the shoulder joints (3,) m; the trunk bends at LUMBAR_SHARE."""
    lumbar = LUMBAR_SHARE * stance.world_from_pelvis[:, 1]
    thoracic = (1 - LUMBAR_SHARE) * stance.world_from_thorax[:, 1]
    return stance.pelvis + proportions.trunk * (lumbar + thoracic)


def joints(stance: Stance, proportions: Proportions) -> dict[str, NDArray]:
    """Place the joint centres of a body in a stance, by forward kinematics.

    Returns
    -------
    joints : dict of str to (3,) float
        In the world, metres: {left,right}_{shoulder,elbow,wrist,hand,hip,knee,ankle,toe} (hand:
        fingertip; toe: joint of the toes), and head (centre of the skull).
    """
    placed = {}
    shoulders = mid_shoulder(stance, proportions)
    for side, sign in (("left", 0.5), ("right", -0.5)):
        shoulder = shoulders + sign * proportions.shoulder_width * stance.world_from_thorax[:, 0]
        hip = stance.pelvis + sign * proportions.hip_width * stance.world_from_pelvis[:, 0]
        placed[f"{side}_shoulder"], placed[f"{side}_hip"] = shoulder, hip
        for start, parts, names in (
            (shoulder, PARTS[:3], ("elbow", "wrist", "hand")),
            (hip, PARTS[3:], ("knee", "ankle", "toe")),
        ):
            for part, name in zip(parts, names, strict=True):
                start = start + getattr(proportions, part) * stance.directions[f"{side}_{part}"]
                placed[f"{side}_{name}"] = start
    neck = 0.17 * proportions.trunk * stance.world_from_thorax[:, 1]
    skull = np.array([0, 0.28, 0.1]) * proportions.trunk
    placed["head"] = shoulders + neck + stance.world_from_head @ skull
    return placed


def mirrored(stance: Stance, point: NDArray, normal: NDArray) -> Stance:
    """Return the stance in a mirror: left becomes right, and the racket changes hands.

    Parameters
    ----------
    stance : Stance
    point, normal : (3,) float
        A point of the mirror plane in the world, metres, and its unit normal.
    """
    mirror = np.eye(3) - 2 * np.outer(normal, normal)
    keep = np.diag([-1.0, 1.0, 1.0])  # keeps the axes right-handed, x to the new left
    rotations = {
        name: mirror @ getattr(stance, name) @ keep
        for name in ("world_from_pelvis", "world_from_thorax", "world_from_head")
    }
    return Stance(
        pelvis=np.asarray(point) + mirror @ (stance.pelvis - point),
        directions={_other(name): mirror @ way for name, way in stance.directions.items()},
        palms=stance.palms and {OTHER[side]: mirror @ way for side, way in stance.palms.items()},
        racket=None if stance.racket is None else mirror @ stance.racket,
        racket_hand=OTHER[stance.racket_hand],
        **rotations,
    )


def moved(stance: Stance, rotation: NDArray, shift: NDArray) -> Stance:
    """Return the stance moved rigidly: a point x goes to `rotation @ x + shift`, metres."""
    return Stance(
        pelvis=rotation @ stance.pelvis + shift,
        world_from_pelvis=rotation @ stance.world_from_pelvis,
        world_from_thorax=rotation @ stance.world_from_thorax,
        world_from_head=rotation @ stance.world_from_head,
        directions={name: rotation @ way for name, way in stance.directions.items()},
        palms=stance.palms and {side: rotation @ way for side, way in stance.palms.items()},
        racket=None if stance.racket is None else rotation @ stance.racket,
        racket_hand=stance.racket_hand,
    )


def _other(segment: str) -> str:
    """Return the name of the same segment on the other side."""
    side, part = segment.split("_", 1)
    return f"{OTHER[side]}_{part}"
