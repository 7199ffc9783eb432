"""Claps after a T-pose: when the palms first touch, between frames.

The distance of the wrists is taken along the line that joined them in the T-pose. In three dimensions the
noise of a camera's depth alone would keep them apart: at contact they are a hand's width from one another.
"""

from dataclasses import asdict, dataclass

import numpy as np

from courtside.events import contact_time
from courtside.events import tpose as tposes
from courtside.kinematics import filtering
from courtside.study.errors import InputError

MOST_S = 3.0  # from the T-pose to its clap
CLOSE = 0.25  # of the T-pose's wrist distance: hands nearer than that may clap
TOGETHER = 0.2  # of it: hands that are held together are nearer than that
FLAT = 0.06  # of it: hands that near to where they come to rest have nearly met
HELD_S = (0.03, 0.2)  # after they come near, where they rest
HELD_APART = 0.12  # of the wrist distance: held hands, or rebounding ones, do not part further
BEFORE_S, BEHIND_S = 0.15, 0.22  # of the contact: what the hinge is fitted to
REBOUND_S = 0.12  # behind it, where a rebound shows
REBOUND = 0.015  # of the T-pose's wrist distance: hands part by more, a filter swings over by less
REACH_S = 0.08  # the contact is sought about the first guess
IN_FRONT = 0.5  # of the arm's length: hands are before the shoulders by that at least
LEVEL = 0.6  # of the arm's length: they are above or below the shoulders by that at most
STRAIGHT_DEG = 45.0  # elbows bend less on the way, median of both arms
# Before hands meet; when they do, they hide the arms from a camera that they point to.
ON_THE_WAY_S = (-0.4, -0.1)
REBOUND_NOISE = 1.5  # standard deviations of the noise that hands must part by as well
MOST_UNCERTAIN_S = 0.04
TOUCHING_M = 0.14  # wrists of hands that touch, seen by any device, are not further apart
SPEEDS_M_S = 0.5, 3.0  # of wrists that come together in a clap
SMOOTHINGS_S = {"rgb": 0.01, "rgbd": 0.01, "cameras": 0.03, "inertial": 0.03}


@dataclass(frozen=True)
class Clap:
    """One clap.

    Attributes
    ----------
    time_s : float
        When the palms first touch, on the device's own clock.
    uncertainty_s : float
        Standard deviation; 90 % of errors should lie within 1.645 of it. A constant delay of the device is
        not in it.
    tpose : int
        Number of the T-pose before it, from 0.
    distance_m : float
        Of the wrists while the hands are held together, along their line in the T-pose.
    speed_m_s : float
        At which that distance falls on contact.
    smoothing_s : float
        By which the device rounds the event off.
    rebounds : bool
        Whether the hands fly apart again at once.
    """

    time_s: float
    uncertainty_s: float
    tpose: int
    distance_m: float
    speed_m_s: float
    smoothing_s: float
    rebounds: bool

    def as_dict(self):
        """Return the numbers for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class Candidate:
    """A time at which the hands come together.

    Attributes
    ----------
    time_s : float
    clap : Clap or None
    why : str
        Why it is no clap to go by; empty where it is one.
    """

    time_s: float
    clap: Clap | None
    why: str


def find(motion, spells):
    """Find the claps of a take.

    Parameters
    ----------
    motion : courtside.records.devices.device_motion.DeviceMotion
    spells : list of courtside.events.tpose.TPose
        Of this motion, in order of time.

    Returns
    -------
    claps : list of Clap
        In order of time, one or more; at most one after each T-pose, its first.

    Raises
    ------
    InputError
        If there is none; the line names the times at which hands came together, and why they do not count.
    """
    found = candidates(motion, spells)
    claps = [one.clap for one in found if one.clap]
    if claps:
        return claps
    line = f"{motion.source}: expected a clap with straight arms within {MOST_S:g} s of a T-pose"
    times = "; ".join(f"{one.time_s:.2f} s ({one.why})" for one in found)
    found = (
        f"hands together only at {times}" if times else "no time at which the hands come together"
    )
    raise InputError(
        f"{line}, found {found}; clap after the T-pose, or give the device's offset_s under "
        "clocks of the take"
    )


def candidates(motion, spells):
    """Return every time at which the hands come together, as a list of Candidate.

    Parameters
    ----------
    motion : courtside.records.devices.device_motion.DeviceMotion
    spells : list of courtside.events.tpose.TPose
    """
    after, taken = [], []
    bend_deg = tposes.measure(motion)["bend_deg"] if spells else None
    for number, spell in enumerate(spells):
        stop_s = spell.stop_s + MOST_S
        if number + 1 < len(spells):
            stop_s = min(stop_s, spells[number + 1].start_s)
        judged = _after(motion, spell, number, stop_s, bend_deg)
        if judged:
            after.append(judged)
            taken.append((judged.time_s - 0.5, stop_s))
    others = [
        Candidate(at_s, None, "no T-pose just before it")
        for at_s in _together(motion, spells)
        if not any(first <= at_s <= last for first, last in taken)
    ]
    return sorted([*after, *others], key=lambda one: one.time_s)


def separation(motion, spell):
    """Return the distance of the wrists along their line in a T-pose, (T,) m."""
    across = motion.joint("left_wrist") - motion.joint("right_wrist")
    line = np.nanmedian(across[spell.frames], axis=0)
    return across @ (line / np.linalg.norm(line))


def wrist_distance(motion):
    """Return the distance of the wrists in space, (T,) m."""
    return np.linalg.norm(motion.joint("left_wrist") - motion.joint("right_wrist"), axis=1)


def _together(motion, spells):
    """Return when the wrists come within `CLOSE` of their distance in the T-poses."""
    apart = wrist_distance(motion)
    span_m = (
        np.median([np.nanmedian(apart[spell.frames]) for spell in spells]) if spells else np.nan
    )
    close = (apart < CLOSE * span_m) & motion.performed
    starts, last_s = [], -np.inf
    for first, stop in filtering.runs(close):
        if motion.time_s[first] - last_s > 0.5:
            starts.append(float(motion.time_s[first]))
        last_s = motion.time_s[stop - 1]
    return starts


def _after(motion, spell, number, stop_s, bend_deg):
    """Return the Candidate after a T-pose, or None if the hands do not come together."""
    apart, time_s = separation(motion, spell), motion.time_s
    span_m = float(np.nanmedian(apart[spell.frames]))
    later = motion.performed & (time_s > spell.stop_s) & (time_s <= stop_s)
    close = np.flatnonzero(later & (apart < CLOSE * span_m))
    if not len(close):
        return None
    rest = apart[_within(time_s, time_s[close[0]], HELD_S)]
    floor = float(np.nanmedian(rest)) if np.isfinite(rest).any() else float(apart[close[0]])
    met = np.flatnonzero(later & (apart < floor + FLAT * span_m))
    near = int(met[0] if len(met) else close[0])
    near_s = float(time_s[near])
    most_m = floor + HELD_APART * span_m if floor < TOGETHER * span_m else 0.0
    why = _why_not(motion, spell, near, apart, most_m) or _bent(motion, near, bend_deg)
    if why:
        return Candidate(near_s, None, why)
    return _fitted(motion, spell, number, apart, near_s)


def _within(time_s, at_s, span):
    return (time_s >= at_s + span[0]) & (time_s <= at_s + span[1])


def _why_not(motion, spell, near, apart, most_m):
    """Return why hands that come together are no clap, empty if they are one."""
    time_s = motion.time_s
    held = apart[_within(time_s, time_s[near], HELD_S)]
    if len(held) < 3 or np.median(held > most_m) > 0:
        return "the hands do not stay together"
    at = {name: motion.joint(name) for name in tposes.JOINTS}
    rest = {name: np.nanmedian(at[name][spell.frames], axis=0) for name in at}
    up = sum(rest[f"{s}_shoulder"] - rest[f"{s}_hip"] for s in tposes.SIDES)
    up = up / np.linalg.norm(up)
    forwards = np.cross(rest["left_wrist"] - rest["right_wrist"], up)
    forwards /= np.linalg.norm(forwards)
    arm_m = np.mean(
        [np.linalg.norm(rest[f"{s}_wrist"] - rest[f"{s}_shoulder"]) for s in tposes.SIDES]
    )
    together = _within(time_s, time_s[near], (-0.02, HELD_S[1]))
    hands = sum(at[f"{s}_wrist"] - at[f"{s}_shoulder"] for s in tposes.SIDES)[together] / 2
    hands = np.nanmedian(hands, axis=0)
    if not hands @ forwards > IN_FRONT * arm_m:
        return "the hands are not in front of the chest"
    if not abs(hands @ up) < LEVEL * arm_m:
        return "the hands are too high or too low"
    return ""


def _bent(motion, near, bend_deg):
    """Return why arms on their way to a clap are none to go by, empty if they are."""
    bend = bend_deg[_within(motion.time_s, motion.time_s[near], ON_THE_WAY_S)]
    straight = np.isfinite(bend).any() and np.nanmedian(bend) < STRAIGHT_DEG
    return "" if straight else "the arms are bent"


def _fitted(motion, spell, number, apart, near_s):
    usual_s = SMOOTHINGS_S.get(motion.kind, contact_time.USUAL_S)
    noise = contact_time.Noise.of(apart[spell.frames])
    parted = _parted(motion.time_s, apart, near_s) > max(
        REBOUND * np.nanmedian(apart[spell.frames]), REBOUND_NOISE * noise.sd
    )
    # A rebound ends in the next contact, which no hinge has.
    behind_s = REBOUND_S if parted else BEHIND_S
    used = _within(motion.time_s, near_s, (-BEFORE_S, behind_s)) & motion.performed
    how = {"usual_s": usual_s, "noise": noise, "rebounds": parted}
    try:
        corner = contact_time.fit(motion.time_s[used], apart[used], near_s, REACH_S, **how)
    except ValueError as error:
        return Candidate(near_s, None, f"{error}")
    if corner.uncertainty_s > MOST_UNCERTAIN_S:
        why = f"its time is uncertain by {1e3 * corner.uncertainty_s:.0f} ms"
        return Candidate(corner.time_s, None, why)
    clap = Clap(
        time_s=corner.time_s,
        uncertainty_s=float(np.hypot(corner.uncertainty_s, _never_met_s(corner))),
        tpose=number,
        distance_m=corner.floor,
        speed_m_s=corner.slope,
        smoothing_s=corner.smoothing_s,
        rebounds=corner.rises,
    )
    return Candidate(corner.time_s, clap, "")


def _never_met_s(corner):
    """Return the time, s, from where hands seem to be held to where hands touch: it hides the contact."""
    speed = np.clip(abs(corner.slope), *SPEEDS_M_S)
    return max(corner.floor - TOUCHING_M, 0.0) / speed


def _parted(time_s, apart, near_s):
    """Return by how much the hands part again just after they meet."""
    after = apart[_within(time_s, near_s, (-0.03, 0.03 + REBOUND_S))]
    after = after[np.isfinite(after)]
    if len(after) < 3:
        return 0.0
    return float(np.max(after - np.minimum.accumulate(after)))
