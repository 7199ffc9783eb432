"""The fingers: loosely bent, or closed round the grip of a racket."""

import numpy as np

from courtside.geometry import rotations
from courtside.virtual.posing import SUFFIX

FINGERS = (2, 3, 4, 5)
LOOSE, CLOSED = np.radians([12, 18, 10]), np.radians([62, 78, 45])  # at the three joints
THUMB_LOOSE, THUMB_CLOSED = np.radians([5, 8, 8]), np.radians([28, 25, 35])
GRIP_OUT_M, GRIP_BACK_M = (
    0.024,
    0.012,
)  # of the grip's axis from the knuckles: out of the palm, to the wrist


def bent(figure, skeleton, side, *, closed):
    """Bend the fingers of one hand.

    Parameters
    ----------
    figure : courtside.virtual.makehuman.Figure
    skeleton : courtside.virtual.posing.Skeleton
    side : str
    closed : bool

    Returns
    -------
    figure : courtside.virtual.makehuman.Figure
    """
    suffix, palm = SUFFIX[side], skeleton.palms[side]
    hand = rotations.unit_vector(skeleton.knuckles[side] - skeleton.heads["wrist" + suffix])
    turns = {}
    for finger in FINGERS:
        root, tip = (
            figure.head(f"finger{finger}-1{suffix}"),
            figure.tail(f"finger{finger}-3{suffix}"),
        )
        axis = rotations.unit_vector(np.cross(rotations.unit_vector(tip - root), palm))
        for joint, angle in enumerate(CLOSED if closed else LOOSE, start=1):
            turns[f"finger{finger}-{joint}{suffix}"] = rotations.about_axis(axis, angle)
    root, tip = figure.head(f"finger1-1{suffix}"), figure.tail(f"finger1-3{suffix}")
    # The thumb closes over the palm, towards the fingers' tips.
    goal = 0.6 * palm + 0.5 * hand - 0.5 * skeleton.across[side] if closed else palm
    axis = rotations.unit_vector(np.cross(rotations.unit_vector(tip - root), goal))
    for joint, angle in enumerate(THUMB_CLOSED if closed else THUMB_LOOSE, start=1):
        turns[f"finger1-{joint}{suffix}"] = rotations.about_axis(axis, angle)
    return figure.bent(turns)


def grip(figure, skeleton, side):
    """Return where the axis of a racket's grip passes through the hand at rest, (3,) m.

    Parameters
    ----------
    figure : courtside.virtual.makehuman.Figure
        The bare body.
    skeleton : courtside.virtual.posing.Skeleton
    side : str
        "left" or "right".
    """
    suffix = SUFFIX[side]
    knuckles = np.mean([figure.head(f"finger{n}-1{suffix}") for n in FINGERS], axis=0)
    hand = rotations.unit_vector(skeleton.knuckles[side] - skeleton.heads["wrist" + suffix])
    return knuckles + GRIP_OUT_M * skeleton.palms[side] - GRIP_BACK_M * hand
