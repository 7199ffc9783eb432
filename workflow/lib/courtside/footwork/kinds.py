"""Classification of stances (step, lunge, landing of a split step or jump), and their tables."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from courtside.footwork.hops import JUMP_LASTS_S, NEAR_S, Hop
from courtside.footwork.stances import Stance
from courtside.records import footwork

Feet = Mapping[str, Sequence[Stance]]  # stances by foot, in order of time
# ASSUME: both feet leave the floor, and land, within this of one another: half of the time between
# two steps of a run.
TOGETHER_S = 0.12
LEAST_FLIGHT_S = 0.05  # ASSUME: shorter ones are errors of landing and end
JUMP_S = 0.3  # ASSUME: longer flights are jumps: the body rises by g t^2 / 8 = 0.11 m and more
HOP_M = 0.6  # ASSUME: a split step carries no further; a leap is a jump
# ASSUME: in a lunge the feet stand further apart than this, in lengths of the leg, for longer than
# the double support of walking.
LUNGE_LEGS, LUNGE_S = 0.9, 0.2


def tables(
    people: Mapping[str, tuple[Feet, float, Sequence[Hop] | None]],
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the steps and the events of a take: rows of `records.footwork`.

    `people` gives by person the stances of both feet, the length of the leg (m; NaN: unknown, and
    no stance is called a lunge), and the hops, which are split steps, or jumps if longer than
    `JUMP_S`: then no other flight is a split step. Where these are None, flights of the stances
    alone are.
    """
    steps: list[tuple] = []
    events: list[tuple] = []
    for person, (feet, leg_m, looked) in people.items():
        kinds: dict[tuple[str, int], str] = {}
        hops = looked or ()
        flights = [
            one
            for one in _flights(feet)
            if looked is None or (one[2] == "jump" and not _is_of(feet, one, hops))
        ]
        for left, right, kind in flights:
            kinds |= {("left", left): kind, ("right", right): kind}
        kinds |= {
            (side, at): _kind(hop)
            for side in feet
            for at, stance in enumerate(feet[side])
            for hop in hops
            if stance.onset_s == hop.land_s
        }
        own = []
        for side in feet:
            for at, stance in enumerate(feet[side]):
                kind = kinds.get((side, at), "step") if np.isfinite(stance.onset_s) else "stand"
                kind = "lunge" if kind == "step" and _is_lunge(feet, side, at, leg_m) else kind
                own.append((stance.since_s, (person, side, kind, *_row(stance))))
                if kind in ("step", "lunge") and _is_swing(feet[side], at):
                    events.append(_event(person, kind, side, [feet[side][at - 1]], [stance]))
        steps += [row for _, row in sorted(own, key=lambda each: each[0])]
        for left, right, kind in flights:
            landing = [feet["left"][left], feet["right"][right]]
            before = [feet["left"][left - 1], feet["right"][right - 1]]
            events.append(_event(person, kind, "both", before, landing))
        events += [_hop_event(person, hop, feet) for hop in hops]
    columns = list(footwork.STEP_COLUMNS), list(footwork.EVENT_COLUMNS)
    table = pd.DataFrame(events, columns=columns[1]).sort_values(["person", "stop_s"])
    return pd.DataFrame(steps, columns=columns[0]), table.reset_index(drop=True)


def _is_swing(stances: Sequence[Stance], at: int) -> bool:
    """Return whether a foot is seen all the time from the stance before the `at`-th to this one."""
    return at > 0 and stances[at - 1].seen_s == stances[at].seen_s


def _row(stance: Stance) -> tuple:
    times = stance.onset_s, stance.onset_sigma_s, stance.end_s, stance.end_sigma_s
    return *times, *stance.seen_s, *map(float, stance.xy), stance.sigma_m, stance.quality


def _event(
    person: str, kind: str, foot: str, before: Sequence[Stance], landing: Sequence[Stance]
) -> tuple:
    """Return the row of an event: the last foot leaves, the first lands."""
    last, first = max(before, key=lambda s: s.end_s), min(landing, key=lambda s: s.onset_s)
    times = last.end_s, last.end_sigma_s, first.onset_s, first.onset_sigma_s
    x_m, y_m = np.mean([stance.xy for stance in landing], axis=0)
    quality = min(stance.quality for stance in landing)
    return person, kind, foot, *times, float(x_m), float(y_m), quality


def _is_of(feet: Feet, flight: tuple[int, int, str], hops: Sequence[Hop]) -> bool:
    """Return whether a flight of both feet is one of the hops."""
    landed_s = min(feet["left"][flight[0]].onset_s, feet["right"][flight[1]].onset_s)
    return any(abs(landed_s - hop.land_s) <= NEAR_S for hop in hops)


def _kind(hop: Hop) -> str:
    return "jump" if hop.land_s - hop.off_s > JUMP_S else "split_step"


def _hop_event(person: str, hop: Hop, feet: Feet) -> tuple:
    """Return the row of a split step or jump: it lands where the feet stand next."""
    after = [next((one for one in feet[side] if one.until_s > hop.land_s), None) for side in feet]
    landing = [one for one in after if one]
    place = np.mean([one.xy for one in landing], axis=0) if landing else np.full(2, np.nan)
    times = hop.off_s, hop.off_sigma_s, hop.land_s, hop.land_sigma_s
    quality = min((one.quality for one in landing), default=np.nan)
    return person, _kind(hop), "both", *times, *map(float, place), quality


def _flights(feet: Feet) -> list[tuple[int, int, str]]:
    """Return the flights of both feet: the stances in which they end, and their kind."""
    found = []
    for left, landed in enumerate(feet["left"]):
        for right, other in enumerate(feet["right"]):
            if not abs(landed.onset_s - other.onset_s) <= TOGETHER_S:
                continue
            if not (_is_swing(feet["left"], left) and _is_swing(feet["right"], right)):
                continue
            before = feet["left"][left - 1], feet["right"][right - 1]
            if not abs(before[0].end_s - before[1].end_s) <= TOGETHER_S:
                continue
            lasts = min(landed.onset_s, other.onset_s) - max(one.end_s for one in before)
            if not LEAST_FLIGHT_S <= lasts <= JUMP_LASTS_S:
                continue
            went = (landed.xy + other.xy - before[0].xy - before[1].xy) / 2
            short = lasts <= JUMP_S and np.linalg.norm(went) <= HOP_M
            found.append((left, right, "split_step" if short else "jump"))
    return found


def _is_lunge(feet: Feet, side: str, at: int, leg_m: float) -> bool:
    """Return whether a foot lands far from the other, and both then stand."""
    own = feet[side][at]
    for other in feet["right" if side == "left" else "left"]:
        start, stop = max(own.onset_s, other.since_s), min(own.until_s, other.until_s)
        first = not other.onset_s > own.onset_s
        apart = float(np.linalg.norm(own.xy - other.xy))
        if first and stop - start > LUNGE_S and apart > LUNGE_LEGS * leg_m:
            return True
    return False
