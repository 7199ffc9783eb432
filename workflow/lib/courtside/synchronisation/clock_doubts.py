"""What speaks against the clock of a device that its claps gave: the motion of the whole take."""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.events import claps
from courtside.records.devices.clocks import Clock
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.events import CLAP_WITHIN_S, Clap, Events, TPose
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError
from courtside.synchronisation import motion_signals, smooth_tracks
from courtside.synchronisation.motion_signals import Signals

BETTER = 0.15  # ASSUME: correlation by which motion must prefer something else, as for two pairings
# ASSUME: least correlation at another offset. The true one has 0.85 with a network of one camera
# and 0.99 with good sources; wrong ones had 0.25 at most on takes of the virtual gym.
LEAST_ALIKE = 0.5
# ASSUME: share of the shorter recording that devices of one take have in common, and the shortest
# time in which chance does not make motions alike.
COMMON_SHARE, COMMON_S = 0.5, 10.0
SAME_S = 1.0  # ASSUME: offsets that differ by less are one: the motion's peak is that wide
# ASSUME: of a drift, more prior deviations than any clock has: of the devices' 200 ppm, 800 ppm;
# of the cameras' 100 ppm, 400 ppm.
# Frames that a file lost look like a drift; 100 ms of them in 90 s gave 1100 ppm.
MOST_DRIFT = 4.0
# ASSUME: times and offsets at which motion is compared with a found clock: a window has several
# strokes or steps, a connection that is lost for longer is seen otherwise.
WINDOW_S, REACH_S, LAG_STEP_S = 6.0, 1.5, 0.05
LEAST_RUN = 2  # ASSUME: windows one after the other that must prefer the same offset
ALIKE_S = 0.1  # ASSUME: offsets that differ by less are the same
# ASSUME: around a T-pose and its clap, which are alike in every take: until arms hang again.
RAISED_S, LOWERED_S = 1.5, 1.0
# ASSUME: of the correlations of all distances, the one that a quarter exceeds: limbs that hardly
# move show noise. Files of one take of the virtual gym had 0.66 and more with it, of two takes 0.41
# at most.
QUANTILE = 0.75
# ASSUME: of the largest wrist distance: wrists of somebody who stands still move by less, as nine
# tenths of the frames show them. In takes of the virtual gym with free motion they move by 0.42.
LEAST_MOVED = 0.1
WRIST_PAIRS = 7  # of the signals' pairs, from the first


def refuse_other_claps(signals: Signals, offset_s: float, where: str) -> None:
    """Raise `InputError` if the motions say that one clap of each device is not the same clap.

    Each device may have missed another clap. That is told by another offset with much common time,
    at which the motions are more alike than at `offset_s` of the claps; or about as alike, where
    the claps leave little in common. `where` begins the message.
    """
    offsets_s, alike, common_s, least_s = _scan(signals)
    here = int(np.argmin(np.abs(offsets_s - offset_s)))
    there = (np.abs(offsets_s - offset_s) > SAME_S) & (common_s >= max(least_s, COMMON_S))
    if not there.any():
        return
    best = int(np.argmax(np.where(there, alike, -np.inf)))
    least = alike[here] + (-BETTER if common_s[here] < least_s else BETTER)
    if alike[best] < max(LEAST_ALIKE, least):
        return
    raise InputError(
        f"{where}: expected motions that are most alike where the claps meet, at an offset of "
        f"{offset_s:.2f} s, found a correlation of {alike[here]:.2f} over {common_s[here]:.0f} s "
        f"there, and {alike[best]:.2f} over {common_s[best]:.0f} s at {offsets_s[best]:.2f} s: "
        "each device probably missed the other's clap; give the device's offset_s under clocks of "
        "the take"
    )


def _scan(signals: Signals) -> tuple[NDArray, NDArray, NDArray, float]:
    """Return offsets (L,), correlation and common time (L,) s, and the least common time, s."""
    step_s = max(track.step_s for track in signals.tracks)
    starts_s, values = [], []
    for track in signals.tracks:
        count = int((track.values.shape[1] - 1) * track.step_s / step_s) + 1
        time_s = track.start_s + step_s * np.arange(count)
        values.append(smooth_tracks.sample(track, time_s)[0][0, :, :, 0])
        starts_s.append(track.start_s)
    known = [np.isfinite(value).astype(float) for value in values]
    first, second = (np.nan_to_num(value) for value in values)

    def across(one: NDArray, other: NDArray) -> NDArray:
        return scipy.signal.fftconvolve(one, other[::-1], axes=0)

    size = across(second**2, known[0]) * across(known[1], first**2)
    size = np.sqrt(np.where(size > 1e-9 * size.max(), size, np.inf))
    alike = np.median(across(second, first) / size, axis=1)
    shown = [each.any(axis=1).astype(float)[:, None] for each in known]
    common_s = step_s * across(shown[1], shown[0])[:, 0]
    lags = np.arange(len(alike)) - (len(first) - 1)
    least_s = COMMON_SHARE * step_s * min(each.sum() for each in shown)
    return starts_s[1] - starts_s[0] + step_s * lags, alike, common_s, float(least_s)


def doubts(
    motions: Sequence[DeviceMotion],
    spells: Sequence[TPose],
    signals: Signals,
    time_s: NDArray,
    clock: Clock,
    prior_drift: float,
) -> list[str]:
    """Return lines on what speaks against a found clock of the second of two devices.

    `spells` are those of the same T-pose, `signals` on its axes, `time_s` (T,) uniform times of the
    first device's clock, `prior_drift` the standard deviation of drifts.
    """
    said = [
        _exchanged(motions, spells, signals, time_s, clock),
        drift(clock.drift_ppm, prior_drift),
    ]
    said += _beside(signals, time_s, clock)
    return [line for line in said if line]


def unlike(
    motions: Sequence[DeviceMotion],
    signals: Signals,
    time_s: NDArray,
    clock: Clock,
    events: Sequence[Events],
) -> str:
    """Return a line if the motions do not show one take: T-pose and clap are in every other, too.

    `events` are those of both devices, `time_s` (T,) uniform times of the first one's clock. The
    line is empty where little time is left beside T-poses and claps, or somebody stands still then.
    """
    apart = _apart(time_s, clock, events)
    own = np.stack([time_s, clock.from_reference(time_s)])[:, apart]
    known = np.any([one[0] for one in signals.sampled(own)], axis=(0, 2))
    common_s = known.sum() * (time_s[1] - time_s[0]) if len(time_s) > 1 else 0.0
    if not (common_s >= COMMON_S and min(map(_moved, motions, own)) >= LEAST_MOVED):
        return ""
    found = float(np.quantile(signals.correlation(own), QUANTILE))
    if found >= LEAST_ALIKE:
        return ""
    other = "its stated clock is right" if clock.status == "assumed" else "none lacks frames"
    return (
        f"expected motions with a correlation of {LEAST_ALIKE:g} or more beside T-poses and claps, "
        f"found {found:.2f} over {common_s:.0f} s: look whether both files are of this take, and "
        f"{other}"
    )


def unpaired(
    shown: Sequence[Sequence[Clap]], pairs: Sequence[tuple[Clap, Clap]], clock: Clock
) -> str:
    """Return a line if a clap of each device is left over, both at nearly the same time.

    `shown` are the claps of both devices, `pairs` those that are one by the `clock` of the second.
    A device may miss a clap that the other shows; then it shows no other one at nearly that time.
    """
    used = list(zip(*pairs, strict=True)) or [(), ()]
    left = [[clap for clap in own if clap not in one] for own, one in zip(shown, used, strict=True)]
    apart = [
        (float(clock.to_reference(second.time_s)) - first.time_s, first.time_s)
        for first, second in itertools.product(*left)
    ]
    apart_s, at_s = min(apart, key=lambda one: abs(one[0]), default=(np.inf, np.nan))
    if abs(apart_s) > CLAP_WITHIN_S:
        return ""
    line = f"the clap at {at_s:.2f} s is {1e3 * apart_s:+.0f} ms beside the clock"
    if not pairs:
        return f"{line}: look whether it is stated right, and both files are of this take"
    return (
        f"{line} that another clap gives: a file probably lacks frames between them, or states a "
        "wrong rate; give the parts before and after as takes of their own"
    )


def _moved(motion: DeviceMotion, own_s: NDArray) -> float:
    """Return how far the wrists move against each other and the hips at times (T,), in spans."""
    across = claps.wrist_distance(motion)
    spread_m = []
    for first, second in motion_signals.PAIRS[:WRIST_PAIRS]:
        apart_m = np.linalg.norm(motion.joint(first) - motion.joint(second), axis=1)
        then_m = np.interp(own_s, motion.time_s, apart_m)
        spread_m.append(np.subtract(*np.nanquantile(then_m, [0.9, 0.1])))
    return float(np.median(spread_m) / np.nanquantile(across, 0.95))


def _apart(time_s: NDArray, clock: Clock, events: Sequence[Events]) -> NDArray:
    """Return which times (T,) of the first device are not around a T-pose with a clap of either."""
    apart = np.ones(len(time_s), dtype=bool)
    for own, read in zip(events, (time_s, clock.from_reference(time_s)), strict=True):
        for clap in own.claps:
            start_s = own.tposes[clap.tpose].start_s
            apart &= (read < start_s - RAISED_S) | (read > clap.time_s + LOWERED_S)
    return apart


def drift(drift_ppm: float, prior_drift: float) -> str:
    """Return a line if no clock drifts as much; `prior_drift` is the standard deviation of drifts.

    It is empty otherwise.
    """
    most_ppm = 1e6 * MOST_DRIFT * prior_drift
    if abs(drift_ppm) <= most_ppm:
        return ""
    return (
        f"expected a drift of at most {most_ppm:.0f} ppm, found {drift_ppm:.0f} ppm: look "
        "whether a file lacks frames, or states a wrong rate"
    )


def _exchanged(motions, spells, signals, time_s, clock) -> str:
    """Return a line if the motions are more alike with left and right of one exchanged."""
    reference, motion = motions
    mirrored = _mirrored(motion)
    axes = motion_signals.common_axes((reference, mirrored), spells)
    own = np.stack([time_s, clock.from_reference(time_s)])
    found, other = (
        float(np.median(each.correlation(own)))
        for each in (signals, Signals(reference, mirrored, axes))
    )
    if other < max(LEAST_ALIKE, found + BETTER):
        return ""
    return (
        f"the motions have a correlation of {found:.2f}, and of {other:.2f} with left and right of "
        "one exchanged: look whether sensors are worn on the wrong side, or a video is mirrored"
    )


def _mirrored(motion: DeviceMotion) -> DeviceMotion:
    """Return the motion of a mirror image, in which left and right are exchanged."""
    names = [skeleton.other_side(str(name)) for name in motion.joints]
    return replace(motion, joints=np.array(names), xyz=motion.xyz * [-1.0, 1.0, 1.0])


def _beside(signals: Signals, time_s: NDArray, clock: Clock) -> Iterator[str]:
    """Yield a line for each time in which the motion prefers one other offset throughout."""
    if len(time_s) < 2:
        return
    window = max(1, round(WINDOW_S / (time_s[1] - time_s[0])))
    starts = np.arange(0, len(time_s) - window + 1, window)
    lags_s = LAG_STEP_S * np.arange(-round(REACH_S / LAG_STEP_S), round(REACH_S / LAG_STEP_S) + 1)
    if not len(starts):
        return
    alike = np.array([_alike(signals, time_s, clock, lag_s, starts) for lag_s in lags_s])
    best = alike.argmax(axis=0)
    least = np.maximum(LEAST_ALIKE, alike[len(lags_s) // 2] + BETTER)
    preferred_s = np.where(alike.max(axis=0) >= least, lags_s[best], np.nan)
    for first, last in _runs(preferred_s):
        yield (
            f"from {time_s[starts[first]]:.0f} to {time_s[starts[last] + window - 1]:.0f} s, "
            f"the motions agree {1e3 * np.median(preferred_s[first : last + 1]):+.0f} ms beside "
            "the clock: a file probably lacks frames there; give the parts before and after as "
            "takes of their own"
        )


def _alike(signals, time_s, clock, lag_s, starts) -> NDArray:
    """Return the correlation (W,) of the motions, later by `lag_s`, in windows from `starts`."""
    own = np.stack([time_s, clock.from_reference(time_s) + lag_s])
    first, second = (one[0] for one in signals.sampled(own))
    sums = [np.add.reduceat(part, starts) for part in (first * second, first**2, second**2)]
    size = np.sqrt(sums[1] * sums[2])
    return np.median(sums[0] / np.where(size > 0, size, np.inf), axis=1)


def _runs(preferred_s: NDArray) -> Iterator[tuple[int, int]]:
    """Yield first and last of the windows, in a row, that prefer the same offset (W,)."""
    first = 0
    for at in range(1, len(preferred_s) + 1):
        ends = at == len(preferred_s) or not (abs(preferred_s[at] - preferred_s[at - 1]) <= ALIKE_S)
        if ends:
            if at - first >= LEAST_RUN:
                yield first, at - 1
            first = at
