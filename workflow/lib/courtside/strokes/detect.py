"""Detect strokes: the wrist is far from the waist, after a run or in a swing above the head.

The time of an overhead stroke is the time at which the wrist is farthest from the waist. The time
of a low stroke, played in a lunge, is derived from the instant at which the trunk stops. Both are
hypotheses (`courtside.strokes.cues` tests them). Their errors were estimated on virtual players
with scripted strokes.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
import scipy
from numpy.typing import NDArray

from courtside.geometry.interpolation import window
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.strokes import STROKE_COLUMNS
from courtside.strokes import local_fit, signals
from courtside.strokes.signals import HANDS, Arm, Signals

# ASSUME: limits from the development takes (players-dev); no source is recorded. Reaches and
# heights are shares of arm and trunk.
FAR = {"overhead": 0.85, "low": 0.63}  # reach of a stroke; ready at the base it is 0.5 to 0.6
OVERHEAD = 0.2  # height of the wrist over the shoulders above which a stroke is overhead
APART_S = 1.0  # between two strokes of one player
TRAVEL_S, TRAVEL_M_S = 1.0, 0.8  # before a low stroke the trunk has moved this fast,
STOPPED = 0.4  # and then moves slower than this share of it
REACHED_S = (0.3, 0.1)  # before and after the trunk stops: where the median reach is far
LEAST_MEASURED = 0.5  # ASSUME: share of a swing's frames that shows its largest speed
SWING_S, SWING_M_S = 0.3, 2.0  # around an overhead stroke the wrist moves this fast
PEAK_S = 0.1  # around an extremum: what a parabola is fitted to
# Of the extremum after the hit, and its standard deviation, seconds; from virtual strokes of the
# development bodies (benchmarks/strokes.py).
LEAD_S = {"overhead": (-0.002, 0.016), "low": (0.102, 0.021)}
# Of low strokes with a gap of trunk or wrist within `SWING_S`: the stop may lie in it. From virtual
# rallies with gaps of 0.3 to 1.3 s (errors of 0.10 to 0.19 s, root mean square).
GAP_SIGMA_S = 0.17
SLOW_HZ = 15.0  # ASSUME: below this rate errors grow with the square of the frame interval


@dataclass(frozen=True)
class Stroke:
    """One stroke: its time, the nearest frame, and the racket hand."""

    time_s: float
    sigma_s: float
    frame: int
    hand: str
    overhead: bool


def find(found: Signals, hand: str) -> list[Stroke]:
    """Return the strokes that a hand plays, in order of time.

    A low stroke close to an overhead one is its preparation or recovery.
    """
    arm = found.arms[hand]
    strokes = _timed(found, hand, True, [_farthest(found, arm, at) for at in _swings(found, arm)])
    for low in _timed(found, hand, False, [_stop(found, at) for at in _lunges(found, arm)]):
        if all(abs(low.time_s - other.time_s) > APART_S for other in strokes):
            strokes.append(low)
    return sorted(strokes, key=lambda stroke: stroke.time_s)


def _timed(
    found: Signals, hand: str, overhead: bool, extrema: list[tuple[float, float] | None]
) -> list[Stroke]:
    lead_s, spread_s = LEAD_S["overhead" if overhead else "low"]
    slower = max(1.0, SLOW_HZ / found.rate_hz) ** 2
    half, strokes = window(SWING_S, found.rate_hz), []
    for time_s, sigma_s in filter(None, extrema):
        hit_s = time_s - lead_s
        frame = int(np.argmin(np.abs(found.time_s - hit_s)))
        near = _around(frame, half, half, len(found.time_s))
        known = np.isfinite(np.column_stack([found.trunk_path, found.arms[hand].reach])[near])
        least_s = 0.0 if overhead or known.all() else GAP_SIGMA_S
        sigma_s = max(slower * float(np.hypot(sigma_s, spread_s)), least_s)
        strokes.append(Stroke(hit_s, sigma_s, frame, hand, overhead))
    return strokes


def _swings(found: Signals, arm: Arm) -> list[int]:
    """Return the frames at which a wrist over the head is farthest, in a swing."""
    apart = max(1, window(APART_S, found.rate_hz))
    high = np.where(arm.above > OVERHEAD, arm.reach, 0.0)
    peaks, _ = scipy.signal.find_peaks(high, height=FAR["overhead"], distance=apart)
    speed = arm.from_waist.sure_speed
    fastest = [_most(speed, at, found.rate_hz, SWING_S, SWING_S) for at in peaks]
    return [int(at) for at, speed in zip(peaks, fastest, strict=True) if speed >= SWING_M_S]


def _lunges(found: Signals, arm: Arm) -> list[int]:
    """Return the frames at which the trunk stops after a run while the wrist is far."""
    speed, rate_hz, chosen = found.trunk.speed, found.rate_hz, []
    sure = found.trunk.sure_speed
    stops, _ = scipy.signal.find_peaks(-np.nan_to_num(speed, nan=np.inf))
    before, after = (window(part_s, rate_hz) for part_s in REACHED_S)
    for at in stops:
        fastest = _most(sure, at, rate_hz, TRAVEL_S, 0.0)
        near = arm.reach[_around(at, before, after, len(speed))]
        known = near[np.isfinite(near)]
        reached = np.median(known) if len(known) else 0.0
        stopped = fastest >= TRAVEL_M_S and speed[at] <= STOPPED * fastest
        if stopped and reached >= FAR["low"] and not arm.above[at] > OVERHEAD:
            chosen.append(int(at))
    return chosen


def _farthest(found: Signals, arm: Arm, at: int) -> tuple[float, float] | None:
    sigma_m_s = arm.from_waist.velocity_sigma[at]
    return _extremum(found, -arm.reach * found.size_m, at, sigma_m_s, order=1)


def _stop(found: Signals, at: int) -> tuple[float, float] | None:
    return _extremum(found, found.trunk.speed**2, at, found.trunk.velocity_sigma[at], order=2)


def _around(at: int, before: int, after: int, n_frames: int) -> NDArray:
    return np.arange(max(at - before, 0), min(at + after + 1, n_frames))


def _most(speed: NDArray, at: int, rate_hz: float, before_s: float, after_s: float) -> float:
    near = speed[_around(at, window(before_s, rate_hz), window(after_s, rate_hz), len(speed))]
    return float(np.nanmax(near)) if np.isfinite(near).any() else 0.0


def _extremum(
    found: Signals, values: NDArray, at: int, sigma_m_s: float, order: int
) -> tuple[float, float] | None:
    """Return the time of the smallest value near a frame, and its sigma, s.

    `values` are a distance (order 1) or the square of a speed (order 2). Their second derivative
    determines the shift of the time by an error of the velocity, `sigma_m_s`.
    """
    half = max(2, window(PEAK_S, found.rate_hz))
    near = _around(at, half, half, len(values))
    near = near[np.isfinite(values[near])]
    if len(near) < 4:
        return None
    lag = found.time_s[near] - found.time_s[at]
    bend, slope, _ = np.polyfit(lag, values[near], 2)
    if bend <= 0:
        return None
    slowing = 2 * bend if order == 1 else np.sqrt(bend)  # m/s2
    shift = float(np.clip(-slope / (2 * bend), -PEAK_S, PEAK_S))
    return float(found.time_s[at]) + shift, float(min(sigma_m_s / slowing, PEAK_S))


def playing_hand(found: Signals) -> str | None:
    """Return the hand that is in front when the trunk stops; None if it never does so after a run.

    The racket hand reaches in the direction of movement. In a run both hands are in front in turn;
    therefore a mere dip of the speed says nothing. One stop alone says little: in one of 20 virtual
    takes with hits it shows the wrong hand.
    """
    speed, sure, rate_hz = found.trunk.speed, found.trunk.sure_speed, found.rate_hz
    stops, _ = scipy.signal.find_peaks(
        -np.nan_to_num(speed, nan=9.0), distance=max(1, window(0.5, rate_hz))
    )
    ahead = dict.fromkeys(HANDS, 0.0)
    for stop in stops:
        before = _around(stop, window(0.5, rate_hz), 0, len(speed))
        fastest = before[np.nanargmax(sure[before])] if np.isfinite(sure[before]).any() else stop
        if not (sure[fastest] >= TRAVEL_M_S and speed[stop] <= STOPPED * sure[fastest]):
            continue
        way = found.trunk.velocity[fastest, :2] / speed[fastest]
        for hand in HANDS:
            reached = found.arms[hand].from_waist.place[stop, :2] @ way
            ahead[hand] += float(np.nan_to_num(reached))
    return max(HANDS, key=lambda hand: ahead[hand]) if any(ahead.values()) else None


def table(points: Keypoints3D, hand_of: Mapping[str, str | None]) -> pd.DataFrame:
    """Return the strokes of all persons of a take, in the columns `STROKE_COLUMNS`.

    `hand_of` is the stated playing hand by person, "left", "right" or None: then it is found.
    Positions are in the world: of the trunk on the floor (x, y), of the wrist over it (height).
    """
    rows: list[dict[str, object]] = []
    people = points.person_id.tolist() if len(points.time_s) >= local_fit.FEWEST else []
    for at, person in enumerate(people):
        found = signals.of_person(points, at)
        stated = hand_of.get(person)
        hand = stated or playing_hand(found)
        for stroke in find(found, hand) if hand else []:
            source = "stated" if stated else "found"
            rows.append({"person": person, "hand_from": source, **_row(found, stroke)})
    made = pd.DataFrame(rows, columns=STROKE_COLUMNS)
    return made.sort_values(["time_s", "person"], ignore_index=True)


def _row(found: Signals, stroke: Stroke) -> dict[str, object]:
    arm, rate_hz = found.arms[stroke.hand], found.rate_hz
    half = window(SWING_S, rate_hz)
    swing = _around(stroke.frame, half, half, len(arm.measured))
    speed, quality = arm.speed(rate_hz)[swing], arm.measured[swing].mean()
    is_known = quality >= LEAST_MEASURED and np.isfinite(speed).any()
    x, y = found.trunk.place[stroke.frame, :2]
    return {
        "time_s": stroke.time_s,
        "sigma_s": stroke.sigma_s,
        "hand": stroke.hand,
        "overhead": stroke.overhead,
        "height_m": arm.wrist.place[stroke.frame, 2],
        "x_m": x,
        "y_m": y,
        "speed_m_s": np.nanmax(speed) if is_known else np.nan,
        "quality": quality,
    }
