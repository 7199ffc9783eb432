"""T-poses in the motion of any device: arms straight out to the sides, square to the trunk, still.

All measures are relative to the body, because devices differ in their up axis. Depth of single
frames is too noisy to tell straight arms: joints are medians over a third of a second.
"""

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import interpolation, rotations
from courtside.kinematics import filtering
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.events import TPose
from courtside.records.keypoints import keypoints
from courtside.study.errors import InputError

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
MEDIAN_S = 0.35  # joints are medians over this time
STILL_S = 0.5  # speeds are differences over this time
LEAST_S = 0.5  # least duration of a T-pose
APART_S = 0.3  # spells with a shorter gap are one
LIMITS = {
    "bend_deg": 35.0,  # of each elbow
    "level_deg": 20.0,  # of each arm, from square to the trunk
    "sideways_deg": 35.0,  # of each arm, from the line of the shoulders
    "speed_per_s": 0.4,  # of each wrist against the trunk, half wrist spans per second
}
# How messages tell a measure: what comes before its value, and after.
WORDS = {
    "bend_deg": ("elbows bent by", "degrees"),
    "level_deg": ("arms", "degrees from square to the trunk"),
    "sideways_deg": ("arms", "degrees from the line of the shoulders"),
    "speed_per_s": ("wrists moving by", "half arm spans a second"),
}
HELD = 21  # frames that a rest pose is repeated for: more than the medians and speeds need
SIDES = ("left", "right")
JOINTS = tuple(f"{side}_{part}" for part in ("shoulder", "elbow", "wrist", "hip") for side in SIDES)


def find(motion: DeviceMotion) -> list[TPose]:
    """Find all T-poses of a take, one or more, in order of time.

    Frames that nobody performed are ignored. Raise InputError if there is none; the message tells
    what came nearest, and when.
    """
    measures = measure(motion)
    over = np.stack([measures[key] / limit for key, limit in LIMITS.items()])
    good = np.all(over <= 1, axis=0)
    spells = [
        (first, stop)
        for first, stop in _joined(filtering.runs(good), motion.time_s)
        if motion.time_s[stop - 1] - motion.time_s[first] >= LEAST_S
    ]
    if not spells:
        raise InputError(_nearest(motion, measures, over, good))
    return [
        _spell(
            motion.time_s,
            *spell,
            {key: float(np.nanmedian(measures[key][slice(*spell)])) for key in LIMITS},
        )
        for spell in spells
    ]


def rest(motion: DeviceMotion) -> TPose:
    """Return the rest pose of a device's own model, from the frames that nobody performed.

    It gives unit and axes of a take without a T-pose, in the frame that moves with the trunk, but
    not where the body stood. The motion must begin with one run of such frames. Raise InputError if
    there are no such frames, or they show another pose.
    """
    runs = filtering.runs(~motion.performed)
    if not len(runs):
        raise InputError(f"{motion.source}: expected a rest pose, found none; film a T-pose")
    first, stop = runs[0]
    held = np.repeat(motion.xyz[first : first + 1], HELD, axis=0)
    performed = np.ones(HELD, dtype=bool)
    still = replace(motion, time_s=np.arange(HELD) * 0.1, xyz=held, performed=performed, posed=None)
    middle = {key: float(values[HELD // 2]) for key, values in measure(still).items()}
    over = [key for key, limit in LIMITS.items() if not middle[key] <= limit]
    if over:
        found = _told({key: middle[key] for key in over})
        raise InputError(f"{motion.source}: expected a rest pose with level arms, found {found}")
    return _spell(motion.time_s, first, stop, middle)


def measure(motion: DeviceMotion) -> dict[str, NDArray]:
    """Measure how close every frame is to a T-pose.

    The keys are those of `LIMITS`, the values (T,) as in `TPose`, of the worse side; NaN if a joint
    is missing or the frame was not performed. Raise InputError if the motion lacks a joint of
    `JOINTS`.
    """
    names = list(motion.joints)
    missing = [name for name in JOINTS if name not in names]
    if missing:
        raise InputError(
            f"{motion.source}: expected the joints {list(JOINTS)} to find a T-pose, "
            f"missing: {missing}; correct the device's joint map"
        )
    step_s = float(np.median(np.diff(motion.time_s))) if len(motion.time_s) > 1 else 1.0
    xyz = np.where(motion.performed[:, None, None], motion.xyz, np.nan)
    smooth = _medians(xyz[:, [names.index(name) for name in JOINTS]], MEDIAN_S / step_s)
    at = dict(zip(JOINTS, np.moveaxis(smooth, 1, 0), strict=True))
    up = rotations.unit(sum(at[f"{s}_shoulder"] - at[f"{s}_hip"] for s in SIDES))
    line = _level(at["left_shoulder"] - at["right_shoulder"], up)
    half_m = np.linalg.norm(at["left_wrist"] - at["right_wrist"], axis=1, keepdims=True) / 2
    sides = [_arm(at, side, up, line * (1 if side == "left" else -1)) for side in SIDES]
    middle = smooth[:, [JOINTS.index(f"{s}_{p}") for p in ("shoulder", "hip") for s in SIDES]].mean(
        axis=1
    )
    reach = max(1, interpolation.window(STILL_S / 2, 1 / step_s))
    speeds = [
        _speed((at[f"{side}_wrist"] - middle) / half_m, reach, 2 * reach * step_s) for side in SIDES
    ]
    measures = {key: np.maximum(sides[0][key], sides[1][key]) for key in sides[0]}
    return measures | {"speed_per_s": np.maximum(*speeds)}


def _arm(at, side, up, outwards) -> dict[str, NDArray]:
    upper = rotations.unit(at[f"{side}_elbow"] - at[f"{side}_shoulder"])
    fore = rotations.unit(at[f"{side}_wrist"] - at[f"{side}_elbow"])
    whole = rotations.unit(at[f"{side}_wrist"] - at[f"{side}_shoulder"])
    return {
        "bend_deg": _degrees(_dot(upper, fore)),
        "level_deg": np.abs(90 - _degrees(_dot(whole, up))),
        "sideways_deg": _degrees(_dot(_level(whole, up), outwards)),
    }


def _medians(values: NDArray, length: float) -> NDArray:
    """Return running medians (T, J, 3) over about `length` frames, if most of them are known."""
    half = max(0, int(length // 2))
    ends = np.full((half, *values.shape[1:]), np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(
        np.concatenate([ends, values, ends]), 2 * half + 1, axis=0
    )
    medians = np.full(values.shape, np.nan)
    # All joints, or all frames, at once need much memory.
    for joint, at in itertools.product(range(values.shape[1]), keypoints.blocks(len(values))):
        window = windows[at, joint]
        known = np.isfinite(window).all(axis=1).sum(axis=-1) > half
        medians[at, joint][known] = np.nanmedian(window[known], axis=-1)
    return medians


def _speed(path: NDArray, reach: int, span_s: float) -> NDArray:
    """Return the speed (T,) of a path (T, 3) over the frames before and after; NaN at the ends."""
    speed = np.full(len(path), np.nan)
    if len(path) > 2 * reach:
        apart = np.linalg.norm(path[2 * reach :] - path[: -2 * reach], axis=1)
        speed[reach:-reach] = apart / span_s
    return speed


def _dot(first: NDArray, second: NDArray) -> NDArray:
    return np.einsum("ti,ti->t", first, second)


def _level(vectors: NDArray, up: NDArray) -> NDArray:
    """Return directions without their component along the trunk."""
    return rotations.unit(vectors - _dot(vectors, up)[:, None] * up)


def _degrees(cosine: NDArray) -> NDArray:
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def _joined(runs: Iterable[tuple[int, int]], time_s: NDArray) -> list[tuple[int, int]]:
    """Join runs of frames with a gap shorter than `APART_S`."""
    joined: list[tuple[int, int]] = []
    for first, stop in runs:
        if joined and time_s[first] - time_s[joined[-1][1] - 1] < APART_S:
            joined[-1] = (joined[-1][0], stop)
        else:
            joined.append((first, stop))
    return joined


def _spell(time_s: NDArray, first: int, stop: int, middle: Mapping[str, float]) -> TPose:
    cost = float(np.mean([(middle[key] / limit) ** 2 for key, limit in LIMITS.items()]))
    start_s, stop_s = float(time_s[first]), float(time_s[stop - 1])
    return TPose(start_s, stop_s, int(first), int(stop), cost=cost, **middle)


def _told(measures: Mapping[str, float]) -> str:
    words = ((*WORDS[key], value) for key, value in measures.items())
    return ", ".join(f"{before} {value:.2g} {after}" for before, after, value in words)


def _nearest(motion, measures, over, good) -> str:
    limits = f"{_told(LIMITS)} at most, for {LEAST_S:g} s"
    line = f"{motion.source}: expected a T-pose ({limits}), found none"
    worst = np.where(np.isfinite(over).all(axis=0), over.max(axis=0), np.inf)
    if not np.isfinite(worst).any():
        return f"{line}, nor a frame with both arms and the trunk; film a T-pose before the clap"
    runs = filtering.runs(good)
    if len(runs):
        first, stop = max(runs, key=lambda run: motion.time_s[run[1] - 1] - motion.time_s[run[0]])
        lasts = motion.time_s[stop - 1] - motion.time_s[first]
        found = f"the longest lasts {lasts:.2f} s at {motion.time_s[first]:.2f} s"
    else:
        at = int(worst.argmin())
        nearest = _told({key: measures[key][at] for key in LIMITS})
        found = f"the nearest is at {motion.time_s[at]:.2f} s: {nearest}"
    return f"{line}; {found}; film a T-pose before the clap"
