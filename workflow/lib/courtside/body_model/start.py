"""Where the fit starts: poses straight from the limb joints, frame by frame."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from courtside.body_model import pose as poses
from courtside.body_model.pose import Pose
from courtside.body_model.segments import SIDES, Model
from courtside.geometry.rotations import rotation_from_rodrigues, unit

BENT = np.radians(20)  # ASSUME: a limb that is bent less does not show the plane of its joint
# Below 90 degrees, or a step from one side to the other could still be shorter by way of the back.
# On 2-, 3- and 4-camera fits of `players-dev` 60 and 85 degrees remove all full turns.
MOST_TURNED = np.radians(85)


def pose(model: Model, place: Mapping[str, NDArray]) -> Pose:
    """Return the starting pose; `place` holds the limb joints (T, 3) m, none missing."""
    hips, shoulders = (
        (place[f"left_{part}"] + place[f"right_{part}"]) / 2 for part in ("hip", "shoulder")
    )
    n_frames = len(hips)
    local = np.repeat(model.rest[:, None], n_frames, axis=1)
    angle = np.zeros((n_frames, len(model.sigma)))
    up = shoulders - hips
    turned = {
        "pelvis": _frame(up, place["right_hip"] - place["left_hip"]),
        "thorax": _frame(up, place["right_shoulder"] - place["left_shoulder"], keep_first=True),
    }
    local[0] = turned["pelvis"]
    local[1] = np.swapaxes(turned["pelvis"], 1, 2) @ turned["thorax"]
    for side in SIDES:
        for above, start, middle, end, upper, lower, sign in (
            ("thorax", "shoulder", "elbow", "wrist", "humerus", "forearm", 1.0),
            ("pelvis", "hip", "knee", "ankle", "femur", "tibia", -1.0),
        ):
            at, below = (model.names.index(f"{side}_{name}") for name in (upper, lower))
            chain = [place[f"{side}_{joint}"] for joint in (start, middle, end)]
            first, second = unit(chain[1] - chain[0]), unit(chain[2] - chain[1])
            normal = sign * np.cross(first, second)
            bend = np.arctan2(np.linalg.norm(normal, axis=1), np.sum(first * second, axis=1))
            neutral = turned[above] @ model.rest[at]
            swung = _swung(neutral, -first)
            seen = (bend > BENT)[:, None, None]
            own = _wound(swung, np.where(seen, _frame(-first, normal, keep_first=True), swung))
            local[at] = np.swapaxes(turned[above], 1, 2) @ own
            angle[:, model.first[below]] = sign * bend
    return Pose(hips, poses.hinged(model, angle, local), angle)


def _wound(swung: NDArray, own: NDArray) -> NDArray:
    """Return frames `own` (T, 3, 3), which no error of a joint's plane turns by 360 degrees.

    `own` are `swung`, turned about Y. If the turn passes 180 degrees between two frames, a fit, in
    which neighbours take the shortest way, cannot undo it: then every turn is limited.
    """
    turn = np.arctan2(*(np.einsum("ta,ta->t", own[:, :, 2], swung[:, :, at]) for at in (0, 2)))
    if np.abs(np.diff(turn)).max(initial=0.0) <= np.pi:
        return own
    return swung @ poses.about(1, np.clip(turn, -MOST_TURNED, MOST_TURNED))


def _frame(up: NDArray, right: NDArray, keep_first: bool = False) -> NDArray:
    """Return axes (T, 3, 3) with Y along `up` and Z near `right`, or Z along `right`."""
    if keep_first:
        y = unit(up)
        z = unit(right - np.sum(right * y, axis=1, keepdims=True) * y)
    else:
        z = unit(right)
        y = unit(up - np.sum(up * z, axis=1, keepdims=True) * z)
    z = np.where(np.isfinite(z), z, np.eye(3)[2])
    y = np.where(np.isfinite(y), y, np.eye(3)[1])
    return np.stack([np.cross(y, z), y, z], axis=2)


def _swung(frames: NDArray, up: NDArray) -> NDArray:
    """Return frames (T, 3, 3) after the smallest rotation that takes their Y to `up` (T, 3)."""
    y = frames[:, :, 1]
    axis = np.cross(y, up)
    sine = np.linalg.norm(axis, axis=1, keepdims=True)
    angle = np.arctan2(sine, np.sum(y * up, axis=1, keepdims=True))
    return rotation_from_rodrigues(axis / np.maximum(sine, 1e-9) * angle) @ frames
