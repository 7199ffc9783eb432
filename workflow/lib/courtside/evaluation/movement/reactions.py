"""Errors of a simulated take's split steps, and of the reactions to hits, against the truth."""

from collections.abc import Iterator
from itertools import count

import numpy as np
import pandas as pd

from courtside.evaluation.movement import strokes
from courtside.records.truth.take_truth import TakeTruth
from courtside.statistics.normal_errors import WITHIN_90

SAME_S = 0.15  # ASSUME: a landing this near to a true one is that split step's
CUT_S = strokes.CUT_S
SPLIT = "split_step"
INTERVALS = ("to_split", "to_step", "split_to_step")
COLUMNS = [
    "person", "what", "result", "hit_s", "true_s", "found_s", "error_ms", "sigma_ms",
    "within_90_percent",
]  # fmt: skip


def answers(truth: TakeTruth, person: str) -> pd.DataFrame:
    """Return a person's true answers to hits: `hit_s`, `split_stop_s`, `first_step_s`, s.

    NaN: the answer is to a shuttle that nobody in the take hit; it was without a split step.
    """
    events, rows = truth.events.get(person, {}), []
    others = set(truth.events) - {person}
    hits_s = np.sort([hit_s for other in others for hit_s in strokes.hits(truth, other)])
    for number in count(1):
        step_s = events.get(f"first_step_{number}")
        if step_s is None:
            break
        before = hits_s[hits_s < step_s]
        split_s = events.get(f"split_{number}_stop", np.nan)
        rows.append((before[-1] if len(before) else np.nan, split_s, step_s))
    return pd.DataFrame(rows, columns=["hit_s", "split_stop_s", "first_step_s"])


def table(
    reactions: pd.DataFrame, events: pd.DataFrame, truth: TakeTruth, span_s: tuple[float, float]
) -> pd.DataFrame:
    """Compare split steps and intervals with the truth, in columns `COLUMNS`.

    `reactions` are of `courtside.strokes.reaction.join`, `events` of `courtside.records.footwork`,
    `span_s` the first and last time of the skeletons. `result` is `found`, `missed`, `false`, or
    `cut` where the take begins or ends within `CUT_S`. Hits that were missed, or are none, are not
    repeated here: `courtside.evaluation.movement.strokes` counts them.
    """
    inside, rows = (span_s[0] + CUT_S, span_s[1] - CUT_S), []
    for person in map(str, truth.person_id):
        true, mine = answers(truth, person), events[events.person.astype(str) == person]
        landed = mine[mine.event == SPLIT]
        own = reactions[reactions.person.astype(str) == person]
        for row in [*_splits(true, landed, inside), *_intervals(true, own, inside)]:
            rows.append({"person": person, **row})
    return pd.DataFrame(rows, columns=COLUMNS)


def _splits(
    true: pd.DataFrame, landed: pd.DataFrame, inside: tuple[float, float]
) -> Iterator[dict[str, object]]:
    """Yield a row for each true and each false split step; times are of the landing."""
    remaining = landed.index.tolist()
    for answer in true.dropna(subset="split_stop_s").itertuples():
        true_s = answer.split_stop_s
        near = [k for k in remaining if abs(landed.stop_s[k] - true_s) <= SAME_S]
        row = {"what": SPLIT, "hit_s": answer.hit_s, "true_s": true_s, "result": "missed"}
        if near:
            best = min(near, key=lambda k: abs(landed.stop_s[k] - true_s))
            remaining.remove(best)
            row |= _compared(true_s, landed.stop_s[best], landed.stop_sigma_s[best])
        yield row if inside[0] < true_s < inside[1] else {**row, "result": "cut"}
    for k in remaining:
        result = "false" if inside[0] < landed.stop_s[k] < inside[1] else "cut"
        yield {"what": SPLIT, "result": result, "found_s": landed.stop_s[k]}


def _intervals(
    true: pd.DataFrame, own: pd.DataFrame, inside: tuple[float, float]
) -> Iterator[dict[str, object]]:
    """Yield a row for each interval of each answer to a hit that was found."""
    for answer in true.dropna(subset="hit_s").itertuples():
        near = own[(own.hit_s - answer.hit_s).abs() <= strokes.SAME_S]
        if near.empty:
            continue
        found = near.loc[(near.hit_s - answer.hit_s).abs().idxmin()]
        to_split, to_step = answer.split_stop_s - answer.hit_s, answer.first_step_s - answer.hit_s
        cut = not (inside[0] < answer.hit_s and answer.first_step_s < inside[1])
        for what, true_s in zip(INTERVALS, (to_split, to_step, to_step - to_split), strict=True):
            row = {"what": what, "hit_s": answer.hit_s, "true_s": true_s}
            found_s = found[f"{what}_s"]
            if np.isfinite(true_s) and np.isfinite(found_s):
                row |= _compared(true_s, found_s, found[f"{what}_sigma_s"])
            elif np.isfinite(true_s) or np.isfinite(found_s):
                row |= {"result": "missed" if np.isfinite(true_s) else "false", "found_s": found_s}
            else:
                continue
            yield {**row, "result": "cut"} if cut else row


def _compared(true_s: float, found_s: float, sigma_s: float) -> dict[str, object]:
    return {
        "result": "found",
        "found_s": found_s,
        "error_ms": 1000 * (found_s - true_s),
        "sigma_ms": 1000 * sigma_s,
        "within_90_percent": bool(abs(found_s - true_s) <= WITHIN_90 * sigma_s),
    }
