"""Signals for the detection of strokes: both wrists relative to the waist, and the trunk."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.records.keypoints import missing_reason, skeleton
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.strokes import local_fit
from courtside.strokes.local_fit import Fit

HANDS = ("left", "right")
# ASSUME: half widths of the fits, of the development takes: a swing lasts 0.15 s, a stop longer.
ARM_S, TRUNK_S = 0.1, 0.17


@dataclass(frozen=True, eq=False)
class Arm:
    """One wrist over time (T frames); reach and height are shares of `Signals.size_m`."""

    wrist: Fit  # in the world, metres
    from_waist: Fit  # the wrist against the waist, metres
    reach: NDArray  # (T,): distance of the wrist from the waist
    above: NDArray  # (T,): height of the wrist over the shoulders
    measured: NDArray  # (T,) bool: the wrist was reconstructed, not filled in

    def speed(self, rate_hz: float) -> NDArray:
        """Return the wrist's speed (T,), m/s; NaN where its fit reaches beyond measured frames.

        Measured are the frame itself, and two frames before it and after it that the fit uses. At
        the edge of a gap the slope of a parabola is a guess: in takes it was 12 times the truth.
        """
        half = local_fit.half_width(rate_hz, ARM_S)
        counts = np.concatenate([[0], np.cumsum(self.measured)])
        at, n_frames = np.arange(len(self.measured)), len(self.measured)
        before = counts[at] - counts[np.maximum(at - half, 0)]
        after = counts[np.minimum(at + half + 1, n_frames)] - counts[at + 1]
        inside = self.measured & (np.minimum(before, after) >= 2)
        return np.where(inside, self.wrist.speed, np.nan)


@dataclass(frozen=True, eq=False)
class Signals:
    """One person over time."""

    time_s: NDArray  # (T,), uniform
    arms: dict[str, Arm]  # of `HANDS`
    trunk: Fit  # mean of shoulders and hips, metres
    trunk_path: NDArray  # (T, 12): the four joints, metres
    size_m: float  # arm and trunk, the length that all reaches are shares of

    @property
    def rate_hz(self) -> float:
        """Frames per second."""
        return (len(self.time_s) - 1) / (self.time_s[-1] - self.time_s[0])


def of_person(points: Keypoints3D, person: int) -> Signals:
    """Return the signals of one person, by the person's index, from filtered skeletons."""
    names, rate_hz = points.joints.tolist(), points.rate_hz
    xyz, reason = points.xyz[person], points.reason[person]

    def joint(name: str) -> NDArray:
        return xyz[:, names.index(name)]

    def length(above: str, below: str) -> float:  # of either arm: one may never be seen
        lines = [joint(f"{side}_{above}") - joint(f"{side}_{below}") for side in HANDS]
        return _usual(np.concatenate(lines))

    waist = (joint("left_hip") + joint("right_hip")) / 2
    shoulders = (joint("left_shoulder") + joint("right_shoulder")) / 2
    arm_m, arms = length("shoulder", "elbow") + length("elbow", "wrist"), {}
    size_m = arm_m + _usual(shoulders - waist)
    for side in HANDS:
        wrist = joint(f"{side}_wrist")
        known = reason[:, names.index(f"{side}_wrist")] == missing_reason.OK
        away = local_fit.fit(wrist - waist, rate_hz, ARM_S)
        arms[side] = Arm(
            wrist=local_fit.fit(wrist, rate_hz, ARM_S),
            from_waist=away,
            reach=np.linalg.norm(away.place, axis=1) / size_m,
            above=local_fit.fit(wrist - shoulders, rate_hz, ARM_S).place[:, 2] / size_m,
            measured=known & np.isfinite(wrist).all(axis=1),
        )
    path = np.concatenate([joint(name) for name in skeleton.TRUNK], axis=1)
    middle = path.reshape(len(path), -1, 3).mean(axis=1)
    return Signals(points.time_s, arms, local_fit.fit(middle, rate_hz, TRUNK_S), path, size_m)


def _usual(lines: NDArray) -> float:
    """Return the median length of lines (T, 3); NaN where none is known."""
    lengths = np.linalg.norm(lines, axis=1)
    known = lengths[np.isfinite(lengths)]
    return float(np.median(known)) if len(known) else np.nan
