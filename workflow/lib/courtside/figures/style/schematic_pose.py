"""Approximate joints of any skeleton in a T-pose, for a skeleton without a recording."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

# ASSUME: a person of 1.75 m, body axes and units (half the wrist span), rounded to 1 cm.
# For drawing only.
MIDDLE = {
    "root": (-0.17, 0.0),
    **{f"torso_{at}": (-0.17 + 0.085 * at, 0.0) for at in range(1, 8)},
    "mid_hip": (-0.22, 0.0),
    "waist": (-0.10, 0.0),
    "torso": (0.20, 0.0),
    "collar": (0.48, 0.0),
    "neck": (0.60, 0.0),
    "neck_1": (0.58, 0.0),
    "neck_2": (0.66, 0.01),
    "head": (0.75, 0.03),
    "nose": (0.76, 0.16),
    "head_top": (0.98, 0.02),
}
LEFT = {
    "clavicle": (0.05, 0.50, 0.03),
    "shoulder": (0.27, 0.52, 0.0),
    "elbow": (0.64, 0.52, 0.0),
    "wrist": (1.0, 0.52, 0.0),
    "hand": (1.1, 0.52, 0.0),
    "pinky": (1.12, 0.51, -0.05),
    "index": (1.14, 0.51, 0.04),
    "thumb": (1.06, 0.50, 0.06),
    "eye_inner": (0.03, 0.81, 0.14),
    "eye": (0.05, 0.81, 0.13),
    "eye_outer": (0.07, 0.81, 0.12),
    "ear": (0.11, 0.79, 0.02),
    "mouth": (0.035, 0.70, 0.14),
    "hip": (0.13, -0.22, 0.0),
    "knee": (0.14, -0.80, 0.02),
    "ankle": (0.14, -1.36, -0.02),
    "heel": (0.14, -1.44, -0.08),
    "toes": (0.16, -1.45, 0.17),
    "big_toe": (0.14, -1.45, 0.20),
    "small_toe": (0.20, -1.45, 0.15),
    "foot_index": (0.16, -1.45, 0.22),
}


def tpose(joints: Sequence[str]) -> NDArray:
    """Return the joints (J, 3) of a schematic T-pose, in body axes and units; NaN if unknown."""
    return np.array([_place(joint) for joint in joints])


def _place(joint: str) -> tuple[float, float, float]:
    if joint in MIDDLE:
        return (0.0, *MIDDLE[joint])
    side, _, part = joint.partition("_")
    if side in ("left", "right") and part in LEFT:
        x, y, z = LEFT[part]
        return (x if side == "left" else -x, y, z)
    return (np.nan,) * 3
