"""Errors of a simulated take's strokes against the true hits, and of each hypothesis by itself."""

import pandas as pd

from courtside.evaluation import detection
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.truth.take_truth import TakeTruth
from courtside.statistics.normal_errors import WITHIN_90
from courtside.strokes import cues, signals

SAME_S = 0.25  # a stroke this near to a hit is that hit
CUT_S = 0.25  # hits and strokes nearer to an end of the take do not count
COLUMNS = [
    "person", "result", "true_s", "time_s", "error_ms", "sigma_ms", "within_90_percent", "hand",
    "overhead", *(f"{cue}_ms" for cue in cues.CUES),
]  # fmt: skip


def table(strokes: pd.DataFrame, points: Keypoints3D, truth: TakeTruth) -> pd.DataFrame:
    """Compare strokes with the true hits, person by person, in columns `COLUMNS`.

    `result` is `found`, `missed`, `false`, or `cut` where the take begins or ends too near.
    `points` are the skeletons that the strokes were found in: the hypotheses see the same.
    """
    rows, ends = [], points.time_s[[0, -1]] + (CUT_S, -CUT_S)
    for at, person in enumerate(map(str, points.person_id)):
        found, own = signals.of_person(points, at), strokes[strokes.person == person]
        remaining = own.index.tolist()
        for true_s in hits(truth, person):
            near = [k for k in remaining if abs(own.time_s[k] - true_s) <= SAME_S]
            row = {"person": person, "true_s": true_s, "result": "missed"}
            if near:
                best = min(near, key=lambda k: abs(own.time_s[k] - true_s))
                remaining.remove(best)
                row |= {"result": "found", **_errors(own.loc[best], true_s, found)}
            rows.append(row if ends[0] < true_s < ends[1] else {**row, "result": "cut"})
        for k in remaining:
            result = "false" if ends[0] < own.time_s[k] < ends[1] else "cut"
            rows.append({"person": person, "result": result, **_words(own.loc[k])})
    return pd.DataFrame(rows, columns=COLUMNS)


def hits(truth: TakeTruth, person: str) -> list[float]:
    """Return the true times of a person's hits, s, in order."""
    events = truth.events.get(person, {})
    return sorted(time_s for name, time_s in events.items() if detection.is_hit(name))


def _words(stroke: pd.Series) -> dict[str, object]:
    return {key: stroke[key] for key in ("time_s", "hand", "overhead")}


def _errors(stroke: pd.Series, true_s: float, found: signals.Signals) -> dict[str, object]:
    error_s = stroke.time_s - true_s
    cue_times_s = cues.times(found, stroke.hand, stroke.time_s)
    return {
        **_words(stroke),
        "error_ms": 1000 * error_s,
        "sigma_ms": 1000 * stroke.sigma_s,
        "within_90_percent": bool(abs(error_s) <= WITHIN_90 * stroke.sigma_s),
        **{f"{cue}_ms": 1000 * (time_s - true_s) for cue, time_s in cue_times_s.items()},
    }
