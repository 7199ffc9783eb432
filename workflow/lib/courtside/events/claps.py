"""Claps after a T-pose: the time at which the palms first touch, between frames.

The distance of the wrists is measured along the line that joined them in the T-pose. In three
dimensions a camera's depth noise alone would keep them apart: at contact they are a hand's width
apart.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.events import contact_time, tpose
from courtside.geometry import interpolation
from courtside.kinematics import filtering
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.events import CLAP_WITHIN_S, Clap, NoClap, TPose

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md). "Span" is the wrist
# distance in the T-pose.
CLOSE = 0.25  # spans: closer hands may clap
TOGETHER = 0.2  # spans: hands that are held together are closer
FLAT = 0.06  # spans: hands this close to their rest have nearly met
HELD_S = (0.03, 0.2)  # after hands come close: the time of rest
HELD_APART = 0.12  # spans: held or rebounding hands do not part further
BEFORE_S, BEHIND_S = 0.15, 0.22  # around the contact: what the hinge is fitted to
LEAST_HZ = contact_time.FEWEST / (BEFORE_S + BEHIND_S)  # with fewer frames there is no such fit
REBOUND_S = 0.12  # after the contact: the time in which a rebound shows
REBOUND_FRAMES = 3.5  # and at least so many frames before and after, or it cannot be fitted
REBOUND = 0.015  # spans: hands of a rebound part by more, the overshoot of a filter is less
REACH_S = 0.08  # search range of the contact about the first guess
# Around the meeting of hands: their place. Hands that hide each other for longer are often lost.
MEETING_S = (-0.1, 0.05)
IN_FRONT = 0.5  # arm lengths: least distance of the hands in front of the shoulders
LEVEL = 0.6  # arm lengths: largest distance of the hands above or below the shoulders
STRAIGHT_DEG = 45.0  # largest bend of the elbows on the way, median of both arms
# Before hands meet: then they hide the arms from a camera that they point to.
ON_THE_WAY_S = (-0.4, -0.1)
REBOUND_NOISE = 1.5  # standard deviations of the noise by which hands of a rebound part at least
MOST_UNCERTAIN_S = 0.04  # claps with a less certain time do not count
TOUCHING_M = 0.14  # largest wrist distance of touching hands, as any device measures it
SPEEDS_M_S = 0.5, 3.0  # limits of the closing speed of wrists in a clap
# Smoothing of the devices, standard deviation.
SMOOTHINGS_S = {"rgb": 0.01, "rgbd": 0.01, "cameras": 0.03, "inertial": 0.03}


def find(motion: DeviceMotion, spells: Sequence[TPose]) -> tuple[list[Clap], list[NoClap]]:
    """Find every time at which the hands come together: the claps, and the others with a reason.

    `spells` are the T-poses of this motion in order of time; each counts its first clap only. Both
    lists are in order of time, and empty without T-poses.
    """
    if not spells:
        return [], []
    after, taken = [], []
    bend_deg = tpose.measure(motion)["bend_deg"]
    for number, spell in enumerate(spells):
        stop_s = spell.stop_s + CLAP_WITHIN_S
        if number + 1 < len(spells):
            stop_s = min(stop_s, spells[number + 1].start_s)
        judged = _after(motion, spell, number, stop_s, bend_deg)
        if judged:
            after.append(judged)
            taken.append((judged.time_s - 0.5, stop_s))
    others = [
        NoClap(at_s, "no T-pose just before it")
        for at_s in _together(motion, spells)
        if not any(first <= at_s <= last for first, last in taken)
    ]
    both = sorted([*after, *others], key=lambda one: one.time_s)
    claps = [one for one in both if isinstance(one, Clap)]
    return claps, [one for one in both if isinstance(one, NoClap)]


def none_counts(source: str, no_claps: Sequence[NoClap]) -> str:
    """Return in one line that a source shows no clap: when hands came together, and why not."""
    times = "; ".join(f"{one.time_s:.2f} s ({one.why})" for one in no_claps)
    seen = (
        f"hands together only at {times}" if times else "no time at which the hands come together"
    )
    return (
        f"{source}: expected a clap with straight arms within {CLAP_WITHIN_S:g} s of a T-pose, "
        f"found {seen}; clap after the T-pose, or give the device's offset_s under clocks of the "
        "take"
    )


def separation(motion: DeviceMotion, spell: TPose) -> NDArray:
    """Return the distance of the wrists along their line in a T-pose, (T,) m."""
    across = motion.joint("left_wrist") - motion.joint("right_wrist")
    line = np.nanmedian(across[spell.frames], axis=0)
    return across @ (line / np.linalg.norm(line))


def wrist_distance(motion: DeviceMotion) -> NDArray:
    """Return the distance of the wrists in space, (T,) m; NaN if the motion lacks one."""
    if not {"left_wrist", "right_wrist"} <= set(motion.joints):
        return np.full(len(motion.time_s), np.nan)
    return np.linalg.norm(motion.joint("left_wrist") - motion.joint("right_wrist"), axis=1)


def _together(motion: DeviceMotion, spells: Sequence[TPose]) -> list[float]:
    """Return when the wrists come within `CLOSE` of their distance in the T-poses."""
    apart = wrist_distance(motion)
    span_m = np.median([np.nanmedian(apart[spell.frames]) for spell in spells])
    close = (apart < CLOSE * span_m) & motion.performed
    starts, last_s = [], -np.inf
    for first, stop in filtering.runs(close):
        if motion.time_s[first] - last_s > 0.5:
            starts.append(float(motion.time_s[first]))
        last_s = motion.time_s[stop - 1]
    return starts


def _after(motion, spell, number, stop_s, bend_deg) -> Clap | NoClap | None:
    """Return how hands first meet after a T-pose, None if they do not."""
    apart, time_s = separation(motion, spell), motion.time_s
    span_m = float(np.nanmedian(apart[spell.frames]))
    later = motion.performed & (time_s > spell.stop_s) & (time_s <= stop_s)
    close = np.flatnonzero(later & (apart < CLOSE * span_m))
    if not len(close):
        return None
    rate_hz = 1 / interpolation.frame_step_s(time_s)
    if rate_hz < LEAST_HZ:
        why = f"{rate_hz:.3g} frames per second are too few: a clap needs {LEAST_HZ:.3g}"
        return NoClap(float(time_s[close[0]]), why)
    rest = apart[_within(time_s, time_s[close[0]], HELD_S)]
    floor = float(np.nanmedian(rest)) if np.isfinite(rest).any() else float(apart[close[0]])
    met = np.flatnonzero(later & (apart < floor + FLAT * span_m))
    near = int(met[0] if len(met) else close[0])
    near_s = float(time_s[near])
    most_m = floor + HELD_APART * span_m if floor < TOGETHER * span_m else 0.0
    why = _why_not(motion, spell, near, apart, most_m) or _bent(motion, near, bend_deg)
    if why:
        return NoClap(near_s, why)
    return _fitted(motion, spell, number, apart, near_s)


def _within(time_s: NDArray, at_s: float, span: tuple[float, float]) -> NDArray:
    return (time_s >= at_s + span[0]) & (time_s <= at_s + span[1])


def _why_not(motion, spell, near, apart, most_m) -> str:
    """Return why hands that come together are no clap; empty if they are one."""
    time_s = motion.time_s
    held = apart[_within(time_s, time_s[near], HELD_S)]
    if len(held) < 3 or np.median(held > most_m) > 0:
        return "the hands do not stay together"
    at = {name: motion.joint(name) for name in tpose.JOINTS}
    rest = {name: np.nanmedian(at[name][spell.frames], axis=0) for name in at}
    up = sum(rest[f"{s}_shoulder"] - rest[f"{s}_hip"] for s in tpose.SIDES)
    up = up / np.linalg.norm(up)
    forwards = np.cross(rest["left_wrist"] - rest["right_wrist"], up)
    forwards /= np.linalg.norm(forwards)
    arm_m = np.mean(
        [np.linalg.norm(rest[f"{s}_wrist"] - rest[f"{s}_shoulder"]) for s in tpose.SIDES]
    )
    meeting = _within(time_s, time_s[near], MEETING_S)
    hands = sum(at[f"{s}_wrist"] - at[f"{s}_shoulder"] for s in tpose.SIDES)[meeting] / 2
    hands = np.nanmedian(hands, axis=0)
    if hands @ forwards < -IN_FRONT * arm_m:
        return "the hands are not in front of the chest but behind: are left and right exchanged?"
    if not hands @ forwards > IN_FRONT * arm_m:
        return "the hands are not in front of the chest"
    if not abs(hands @ up) < LEVEL * arm_m:
        return "the hands are too high or too low"
    return ""


def _bent(motion: DeviceMotion, near: int, bend_deg: NDArray) -> str:
    """Return why arms on their way to a clap do not count; empty if they do."""
    bend = bend_deg[_within(motion.time_s, motion.time_s[near], ON_THE_WAY_S)]
    straight = np.isfinite(bend).any() and np.nanmedian(bend) < STRAIGHT_DEG
    return "" if straight else "the arms are bent"


def _fitted(motion, spell, number, apart, near_s) -> Clap | NoClap:
    usual_s = SMOOTHINGS_S[motion.kind]
    noise = contact_time.Noise.of(apart[spell.frames])
    least_m = max(REBOUND * np.nanmedian(apart[spell.frames]), REBOUND_NOISE * noise.sd)
    parted = _parted(motion.time_s, apart, near_s) > least_m
    # A rebound ends in the next contact, which the hinge does not model.
    least_s = REBOUND_FRAMES * interpolation.frame_step_s(motion.time_s) if parted else 0.0
    before_s, behind_s = max(BEFORE_S, least_s), max(REBOUND_S if parted else BEHIND_S, least_s)
    used = _within(motion.time_s, near_s, (-before_s, behind_s)) & motion.performed
    try:
        corner = contact_time.fit(
            motion.time_s[used],
            apart[used],
            near_s,
            REACH_S,
            usual_s=usual_s,
            noise=noise,
            rebounds=parted,
        )
    except ValueError as error:
        return NoClap(near_s, f"{error}")
    if corner.uncertainty_s > MOST_UNCERTAIN_S:
        why = f"its time is uncertain by {1e3 * corner.uncertainty_s:.0f} ms"
        return NoClap(corner.time_s, why)
    # Between the rest of the hands and their touch the contact is hidden.
    unseen_s = max(corner.floor - TOUCHING_M, 0.0) / np.clip(abs(corner.slope), *SPEEDS_M_S)
    return Clap(
        time_s=corner.time_s,
        uncertainty_s=float(np.hypot(corner.uncertainty_s, unseen_s)),
        tpose=number,
        distance_m=corner.floor,
        speed_m_s=corner.slope,
        smoothing_s=corner.smoothing_s,
        rebounds=corner.rises,
    )


def _parted(time_s: NDArray, apart: NDArray, near_s: float) -> float:
    """Return by how much the hands part again just after they meet."""
    after = apart[_within(time_s, near_s, (-0.03, 0.03 + REBOUND_S))]
    after = after[np.isfinite(after)]
    if len(after) < 3:
        return 0.0
    return float(np.max(after - np.minimum.accumulate(after)))
