"""Contacts, onsets and steps against the true feet of a virtual take.

A virtual foot stands while its lowest joint, ankle or base of the toes, is within 1 mm of where it
is when the foot is flat on the floor. It lands and leaves smoothly, so that its height between
frames goes with the square of the time from contact: the times at which it passes 1 mm are within
8 ms of those that the simulation planned.
"""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.records.footwork import Contacts
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.truth.take_truth import TakeTruth
from courtside.statistics.normal_errors import WITHIN_90

TOUCHES_M = 0.001
NEAR_S = 0.15  # ASSUME: a true and a found onset further apart are not of one step
EDGE_S = 0.1  # onsets and ends this near to the ends of what is known are not judged
BOUNDARIES = ("onset", "end")


def true_contact(truth: TakeTruth, person: str, foot: str) -> tuple[NDArray, dict[str, NDArray]]:
    """Return whether a foot stands at the truth's frames (T,), and its true onsets and ends, s."""
    joints, row = truth.joints.tolist(), truth.person_id.tolist().index(person)
    named = [joints.index(f"{foot}_ankle"), joints.index(f"rig_{foot}_toe")]
    height = truth.xyz[row][:, named, 2]
    above = (height - height.min(axis=0)).min(axis=1)
    root, level, time_s = np.sqrt(above), np.sqrt(TOUCHES_M), truth.time_s
    at = np.flatnonzero((root[1:] > level) != (root[:-1] > level))
    crossed = time_s[at] + (level - root[at]) / (root[at + 1] - root[at]) * np.diff(time_s)[at]
    lands = root[at] > level
    return above <= TOUCHES_M, {"onset": crossed[lands], "end": crossed[~lands]}


def table(
    points: Keypoints3D, contacts: Contacts, steps: pd.DataFrame, truth: TakeTruth
) -> pd.DataFrame:
    """Return a row of errors for each person and foot, see the data dictionary."""
    rows = []
    for at, person in enumerate(contacts.person_id.tolist()):
        if person not in truth.person_id.tolist():
            continue
        for side, foot in enumerate(contacts.foot.tolist()):
            own = steps[(steps.person == person) & (steps.foot == foot)]
            stands, true_s = true_contact(truth, person, foot)
            row = {"person": person, "foot": foot}
            row |= _frames(contacts.time_s, contacts.probability[at, :, side], stands, true_s)
            row |= _boundaries(contacts.time_s, own, true_s)
            row |= _movement(points, person, foot, own)
            rows.append(row)
    return pd.DataFrame(rows)


def _frames(
    time_s: NDArray, probability: NDArray, stands: NDArray, true_s: dict[str, NDArray]
) -> dict[str, float]:
    changes = np.sort(np.concatenate(list(true_s.values())))
    true = (np.searchsorted(changes, time_s) % 2 == 1) != stands[0]
    known = np.isfinite(probability)
    n = int(known.sum())
    right = (probability > 0.5)[known] == true[known]
    off = (probability[known] - true[known]) ** 2
    return {
        "n_frames": n,
        "right_percent": 100 * float(right.mean()) if n else np.nan,
        "brier": float(off.mean()) if n else np.nan,
    }


def paired(
    time_s: NDArray, steps: pd.DataFrame, true_s: NDArray, what: str
) -> tuple[NDArray, int, int]:
    """Return errors and sigmas (N, 2) of pairs, and how many true and found times there are."""
    inside = (time_s[0] + EDGE_S, time_s[-1] - EDGE_S)
    true = true_s[(true_s > inside[0]) & (true_s < inside[1])]
    found = steps[steps[f"{what}_s"].between(*inside)]
    at_s, sigma_s = (found[f"{what}_{end}"].to_numpy() for end in ("s", "sigma_s"))
    rows = [(at_s[j] - true[i], sigma_s[j]) for i, j in _pairs(true, at_s)]
    return np.array(rows).reshape(-1, 2), len(true), len(found)


def _boundaries(
    time_s: NDArray, steps: pd.DataFrame, true_s: dict[str, NDArray]
) -> dict[str, float]:
    """Return counts of true and found steps and the errors of both boundaries."""
    row: dict[str, float] = {}
    for what in BOUNDARIES:
        pairs, n_true, n_found = paired(time_s, steps, true_s[what], what)
        size, known = abs(pairs[:, 0]), len(pairs) > 0
        row |= {f"n_true_{what}": n_true, f"n_found_{what}": n_found}
        row |= {
            f"n_matched_{what}": len(pairs),
            f"{what}_bias_ms": 1000 * float(np.median(pairs[:, 0])) if known else np.nan,
            f"{what}_median_ms": 1000 * float(np.median(size)) if known else np.nan,
            f"{what}_p90_ms": 1000 * float(np.quantile(size, 0.9)) if known else np.nan,
            f"{what}_sigma_ms": 1000 * float(np.median(pairs[:, 1])) if known else np.nan,
            f"{what}_within_90": int((size <= WITHIN_90 * pairs[:, 1]).sum()),
        }
    return row


def _pairs(true: NDArray, found: NDArray) -> Iterator[tuple[int, int]]:
    """Yield pairs (true, found) of times that are nearest to one another, within `NEAR_S`."""
    for i, time_s in enumerate(true):
        j = int(np.argmin(abs(found - time_s))) if len(found) else 0
        if len(found) and abs(found[j] - time_s) <= NEAR_S and np.argmin(abs(true - found[j])) == i:
            yield i, j


def _movement(points: Keypoints3D, person: str, foot: str, steps: pd.DataFrame) -> dict[str, float]:
    """Return how far the middle of the measured foot moves while it is held to stand, mm.

    Root mean square distance on the floor from its mean of the stance, of the middle half of each.
    """
    named = skeleton.heel_and_toe(points.joints.tolist(), foot)
    row, squares = points.person_id.tolist().index(person), []
    for step in steps.itertuples():
        start, stop = (float(step.onset_s), float(step.end_s))
        quarter = (stop - start) / 4
        inside = (points.time_s >= start + quarter) & (points.time_s <= stop - quarter)
        if named and inside.sum() > 1:
            xy = points.xyz[row][inside][:, named, :2].mean(axis=1)
            squares.append(((xy - xy.mean(axis=0)) ** 2).sum(axis=1))
    moved = np.sqrt(np.concatenate(squares).mean()) if squares else np.nan
    return {"moved_rms_mm": 1000 * float(moved)}
