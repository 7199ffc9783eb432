"""Clock offsets and drifts of devices, from claps and motion."""

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.records.devices.clocks import Clock
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.events import Clap, Events
from courtside.study.errors import InputError
from courtside.synchronisation import clock_adjustment, clock_doubts, motion_signals
from courtside.synchronisation.motion_signals import Signals

# ASSUME: standard deviation of devices' drifts; 200 ppm is not rare for phones and suits.
PRIOR_DRIFT = 200e-6
# ASSUME: a network or an inertial suit errs with the pose, which looks like a shift in time.
MOTION_BIAS_S = 0.005
LEAST_CORRELATION = 0.3  # ASSUME: least median correlation of the signals for the motion to be used
HOPELESS = 10.0  # ASSUME: a drift less certain than this many priors is not estimated
DISAGREE = 3.0  # standard deviations between clap and motion that the note mentions
MAX_UNCERTAINTY_S = 0.03  # ASSUME: a less certain clock, about a frame, stops the take

Pairs = list[tuple[Clap, Clap]]


@dataclass(frozen=True, eq=False)
class Found:
    """Clock of one source and the estimates that it combines."""

    clock: Clock  # against the reference, by the times of the same events: with the device's delay
    claps: Pairs  # of the reference and of this source
    # By the claps alone: the offset with this clock's drift, at their mean time; the drift NaN with
    # fewer than two.
    clap_offset_s: float = np.nan
    clap_uncertainty_s: float = np.nan
    clap_drift_ppm: float = np.nan
    clap_drift_uncertainty_ppm: float = np.nan
    # By the motion alone, at the middle of what both recorded.
    motion_offset_s: float = np.nan
    motion_uncertainty_s: float = np.nan
    motion_drift_ppm: float = np.nan
    motion_drift_uncertainty_ppm: float = np.nan
    disagree_s: float = np.nan  # offset by the motion minus offset by the claps, at one time
    # The device's stated delay: the offset of the clock itself is `clock.offset_s` minus this (if
    # the reference has none).
    latency_s: float = 0.0
    latency_uncertainty_s: float = 0.0


def synchronise(
    motions: Sequence[DeviceMotion],
    events_of: Mapping[str, Events],
    *,
    devices: Mapping[str, str],
    known: Mapping[str, Clock],
    latency: Mapping[str, tuple[float, float]],
) -> dict[str, Found]:
    """Find the clock of every source against the first one's.

    `events_of` holds the events of every source, `devices` its device: sources of one device share
    its clock. Clocks `known` against the reference are used as they are, with what the motion says
    against them. The stated delay of a source (`latency`, with its standard deviation, s) is
    reported, not subtracted: places must be compared at the times of the same event. An
    `InputError` if the claps of a source cannot be paired with those of the reference, are not the
    same by the motion, or leave its clock uncertain.
    """
    reference, *others = motions
    found = {reference.source: Found(Clock(status="reference", note="the take's clock"), [])}
    for motion in others:
        if motion.source in known:
            found[motion.source] = Found(_stated(reference, motion, known, events_of), [])
        elif devices[motion.source] == devices[reference.source]:
            clock = Clock(note="one device with the reference: one clock")
            found[motion.source] = Found(clock, [])
        elif still := [m.source for m in (reference, motion) if not events_of[m.source].claps]:
            note = f"no clap of {' and '.join(still)}"
            clock = Clock(status="unknown", note=note, uncertainty_s=np.inf)
            found[motion.source] = Found(clock, [])
        else:
            found[motion.source] = _against(reference, motion, events_of)
    shared = _shared(found, [m for m in others if m.source not in known], devices)
    shared |= {source: _twice(shared[source], line) for source, line in _copies(motions)}
    for source, (delay_s, sigma_s) in latency.items():
        if source in shared:
            one = shared[source]
            shared[source] = replace(one, latency_s=delay_s, latency_uncertainty_s=sigma_s)
    return shared


def checks(found: Mapping[str, Found]) -> pd.DataFrame:
    """Return one row per source: its clock, and the estimates that this rests on."""
    rows = []
    for source, one in found.items():
        clock = {key: getattr(one.clock, key) for key in ("offset_s", "drift_ppm", "uncertainty_s")}
        rest = {key: value for key, value in vars(one).items() if key not in ("clock", "claps")}
        about = {"source": source, "status": one.clock.status, **clock}
        about["drift_uncertainty_ppm"] = one.clock.drift_uncertainty_ppm
        rows.append(about | {"n_claps": len(one.claps)} | rest | {"doubt": one.clock.doubt})
    return pd.DataFrame(rows)


def _shared(found, motions, devices) -> dict[str, Found]:
    """Give the sources of one device the surest of their clocks."""
    surest: dict[str, str] = {}
    for motion in motions:
        device = devices[motion.source]
        best = surest.get(device, motion.source)
        own, other = (found[source].clock.uncertainty_s for source in (motion.source, best))
        surest[device] = motion.source if own < other else best
    taken = {motion.source: surest[devices[motion.source]] for motion in motions}
    return {source: found[taken.get(source, source)] for source in found}


def _against(reference, motion, events_of) -> Found:
    """Find the clock of one source against another."""
    where = f"{motion.source} against {reference.source}"
    claps = events_of[reference.source].claps, events_of[motion.source].claps
    unaligned = Signals(reference, motion)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "All-NaN|Mean of empty|Degrees of freedom")
        pairs = pair(*claps, _likeness(unaligned, reference, motion), where)
        if len(pairs) == 1:
            clock_doubts.refuse_other_claps(unaligned, offset_s(pairs), where)
        spells = events_of[reference.source].tposes, events_of[motion.source].tposes
        chosen = [spell[clap.tpose] for spell, clap in zip(spells, pairs[0], strict=True)]
        axes = motion_signals.common_axes((reference, motion), chosen)
        signals = Signals(reference, motion, axes)
        moved = _by_motion(signals, reference, motion, offset_s(pairs))
        one = _joined(pairs, moved, reference, where)
        time_s = _both(reference, motion, offset_s(pairs))
        doubts = clock_doubts.doubts(
            (reference, motion), chosen, signals, time_s, one.clock, PRIOR_DRIFT
        )
    doubts += filter(None, [clock_doubts.unpaired(claps, pairs, one.clock)])
    doubt = "; ".join(doubts) or _unlike(unaligned, reference, motion, one.clock, events_of)
    return replace(one, clock=replace(one.clock, doubt=doubt))


def _copies(motions: Sequence[DeviceMotion]) -> Iterator[tuple[str, str]]:
    """Yield the sources that repeat an earlier one to the last digit, with a line."""
    for one, other in combinations(motions, 2):
        if np.array_equal(one.xyz, other.xyz, equal_nan=True):
            yield (
                other.source,
                f"expected a motion of its own, found that of {one.source} to the last digit: one "
                "recording was given twice",
            )


def _twice(found: Found, line: str) -> Found:
    doubt = "; ".join(filter(None, [found.clock.doubt, line]))
    return replace(found, clock=replace(found.clock, doubt=doubt))


def _stated(reference, motion, known, events_of) -> Clock:
    """Return the clock that the session states, with what speaks against it."""
    clock = known[motion.source]
    claps = events_of[reference.source].claps, events_of[motion.source].claps
    is_shown = any(
        abs(clock.to_reference(second.time_s) - first.time_s) <= SAME_S
        for first, second in product(*claps)
    )
    doubt = "" if is_shown else clock_doubts.unpaired(claps, [], clock)
    signals = Signals(reference, motion)
    doubt = doubt or _unlike(signals, reference, motion, clock, events_of)
    return replace(clock, doubt=doubt) if doubt else clock


def _unlike(signals, reference, motion, clock, events_of) -> str:
    """Return what the whole motion says against a clock, as of two takes; empty if nothing."""
    time_s = _both(reference, motion, clock.offset_s)
    events = [events_of[each.source] for each in (reference, motion)]
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "All-NaN|Mean of empty|Degrees of freedom")
        return clock_doubts.unlike((reference, motion), signals, time_s, clock, events)


def _likeness(signals, reference, motion) -> Callable[[float], float]:
    """Return a function of an offset: the correlation of the motions with it."""

    def likeness(offset_s: float) -> float:
        time_s = _both(reference, motion, offset_s)
        if len(time_s) < 2:
            return -1.0
        return float(np.median(signals.correlation(np.stack([time_s, time_s + offset_s]))))

    return likeness


def _both(reference: DeviceMotion, motion: DeviceMotion, offset_s: float) -> NDArray:
    """Return uniform times of the reference at which both ran."""
    step_s = float(np.median(np.diff(reference.time_s)))
    start = max(reference.time_s[0], motion.time_s[0] - offset_s)
    stop = min(reference.time_s[-1], motion.time_s[-1] - offset_s)
    return start + step_s * np.arange(max(0, int((stop - start) / step_s)))


def _by_motion(signals, reference, motion, offset_s) -> clock_adjustment.Adjusted | None:
    """Return the clock by the whole motion, or None if the motion does not determine it."""
    time_s = _both(reference, motion, offset_s)
    if len(time_s) < 2:
        return None
    own = np.stack([time_s, time_s + offset_s])
    if np.median(signals.correlation(own)) < LEAST_CORRELATION:
        return None
    for _ in range(2):
        signals.weigh(own)
        adjusted = clock_adjustment.adjust(
            signals.terms, [0.0, own[1, 0] - time_s[0]], time_s, np.array([0, 2])
        )
        if not adjusted.covariance[3, 3] < (HOPELESS * PRIOR_DRIFT) ** 2:
            return None
        own = np.stack([time_s, adjusted.own(1, time_s)])
    return adjusted


def _joined(pairs, moved, reference, where) -> Found:
    """Combine claps and motion by least squares: offset, the motion's own bias, and drift."""
    at_s = np.array([first.time_s for first, _ in pairs])
    apart_s = np.array([second.time_s - first.time_s for first, second in pairs])
    sigma_s = np.array([np.hypot(*(clap.uncertainty_s for clap in pair)) for pair in pairs])
    centre_s = moved.centre_s if moved else float(at_s.mean())
    near_s = float(apart_s[0])  # clocks may count from 1970: sums of squares are of small numbers
    rows = np.column_stack([np.ones(len(pairs)), np.zeros(len(pairs)), at_s - centre_s])
    information = np.diag([0.0, MOTION_BIAS_S**-2, PRIOR_DRIFT**-2])
    information += (rows / sigma_s[:, None] ** 2).T @ rows
    moments = rows.T @ ((apart_s - near_s) / sigma_s**2)
    if moved:
        rows = np.array([[1.0, 1, 0], [0, 0, 1]])
        inverse = np.linalg.inv(moved.covariance[2:, 2:])
        information += rows.T @ inverse @ rows
        moments += rows.T @ inverse @ [moved.offset_s[1] - near_s, moved.drift[1]]
    covariance = np.linalg.inv(information)
    state = covariance @ moments
    ends = reference.time_s[[0, -1]] - centre_s
    lever = np.stack([np.ones(2), np.zeros(2), ends], axis=1)
    spread_s = float(np.sqrt(np.einsum("ni,ij,nj->n", lever, covariance, lever).max()))
    numbers = _alone(pairs, at_s, apart_s, sigma_s, moved, state, centre_s)
    if spread_s > MAX_UNCERTAINTY_S:
        raise InputError(
            f"{where}: expected claps and motion that place its clock within "
            f"{1e3 * MAX_UNCERTAINTY_S:.0f} ms, found {1e3 * spread_s:.0f} ms with {len(pairs)} "
            f"clap(s) at {', '.join(f'{t:.2f}' for t in at_s)} s; clap again at the end, or give "
            "its offset_s under clocks of the take"
        )
    clock = Clock(
        offset_s=float(near_s + state[0] - state[2] * centre_s),
        drift_ppm=float(1e6 * state[2]),
        uncertainty_s=spread_s,
        drift_uncertainty_ppm=float(1e6 * np.sqrt(covariance[2, 2])),
        status="found",
        note=_note(pairs, moved, numbers),
    )
    return Found(clock, pairs, **numbers)


def _alone(pairs, at_s, apart_s, sigma_s, moved, state, centre_s) -> dict[str, float]:
    """Return the estimates of claps and motion by themselves."""
    weight = sigma_s**-2 / (sigma_s**-2).sum()
    mean_s = float(weight @ at_s)
    spread = float(np.sqrt((sigma_s**-2 * (at_s - mean_s) ** 2).sum()))
    numbers = {
        "clap_offset_s": float(weight @ apart_s),
        "clap_uncertainty_s": float((sigma_s**-2).sum() ** -0.5),
    }
    if len(pairs) > 1:
        slope = float((sigma_s**-2 * (at_s - mean_s)) @ apart_s) / spread**2
        numbers |= {"clap_drift_ppm": 1e6 * slope, "clap_drift_uncertainty_ppm": 1e6 / spread}
    if moved:
        by_clap = numbers["clap_offset_s"] + state[2] * (centre_s - mean_s)
        numbers |= {
            "motion_offset_s": float(moved.offset_s[1]),
            "motion_uncertainty_s": float(np.sqrt(moved.covariance[2, 2])),
            "motion_drift_ppm": float(1e6 * moved.drift[1]),
            "motion_drift_uncertainty_ppm": float(1e6 * np.sqrt(moved.covariance[3, 3])),
            "disagree_s": float(moved.offset_s[1] - by_clap),
        }
    return numbers


def _note(pairs: Pairs, moved: clock_adjustment.Adjusted | None, numbers: dict[str, float]) -> str:
    line = f"{len(pairs)} clap(s) paired"
    if not moved:
        return f"{line}; the motions are too little alike to say more"
    line += f"; motion is {1e3 * numbers['disagree_s']:+.1f} ms from them"
    spread = (numbers["clap_uncertainty_s"], numbers["motion_uncertainty_s"], MOTION_BIAS_S)
    if abs(numbers["disagree_s"]) > DISAGREE * np.linalg.norm(spread):
        line += ", more than both allow: look at the wrist distance"
    return line


# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
SAME_S = 0.12  # claps that differ by less, after the offset, may be one
SAME_PPM = 500.0  # tolerance of drift, of the time between two claps
BETTER = 0.15  # correlation by which the motion must prefer one pairing


def pair(
    first: Sequence[Clap], second: Sequence[Clap], likeness: Callable[[float], float], where: str
) -> Pairs:
    """Pair the claps of two devices: the most pairs that one offset explains.

    Of several such offsets, the one with the more similar motions is taken: `likeness` returns
    their correlation with an offset in seconds. `where` begins an error message. An `InputError` if
    several offsets explain equally many claps and the motion does not tell them apart.
    """
    choices = {}
    for one, other in product(first, second):
        offset = other.time_s - one.time_s
        pairs = _matched(first, second, one, offset)
        choices[tuple((first.index(a), second.index(b)) for a, b in pairs)] = pairs
    most = max(map(len, choices.values()))
    best = sorted(
        ((likeness(offset_s(pairs)), pairs) for pairs in choices.values() if len(pairs) == most),
        key=lambda choice: -choice[0],
    )
    if len(best) > 1 and best[0][0] < best[1][0] + BETTER:
        times = [", ".join(f"{clap.time_s:.2f}" for clap in claps) for claps in (first, second)]
        offsets = ", ".join(f"{offset_s(pairs):.2f}" for _, pairs in best)
        raise InputError(
            f"{where}: expected claps that pair in one way, found {len(best)} ways (offsets "
            f"{offsets} s): claps at {times[1]} s against {times[0]} s; {_stretch(first, second)}"
            "give the device's offset_s under clocks of the take, or, if a file lacks frames "
            "between them, its parts as takes of their own"
        )
    return best[0][1]


def _stretch(first: Sequence[Clap], second: Sequence[Clap]) -> str:
    """Return a clause on how claps that are as many would pair in order; empty for others."""
    if not len(first) == len(second) > 1:
        return ""
    ratio = (second[-1].time_s - second[0].time_s) / (first[-1].time_s - first[0].time_s)
    return (
        f"if these are the same {len(first)} in order, the times between them are {ratio:.4f} "
        "times as long: look whether a file states a wrong rate or lacks frames; else "
    )


def offset_s(pairs: Pairs) -> float:
    """Return the mean offset of the second device of pairs of claps, weighted by their variance."""
    weight = [1 / (a.uncertainty_s**2 + b.uncertainty_s**2) for a, b in pairs]
    return float(np.average([b.time_s - a.time_s for a, b in pairs], weights=weight))


def _matched(first: Sequence[Clap], second: Sequence[Clap], anchor: Clap, offset: float) -> Pairs:
    """Return the pairs of claps that an offset explains, given at one clap of the first device."""
    pairs = []
    for one in first:
        apart = [abs(other.time_s - one.time_s - offset) for other in second]
        nearest = int(np.argmin(apart))
        if apart[nearest] <= SAME_S + 1e-6 * SAME_PPM * abs(one.time_s - anchor.time_s):
            pairs.append((one, second[nearest]))
    return pairs
