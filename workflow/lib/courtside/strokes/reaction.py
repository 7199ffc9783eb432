"""Reaction: from a stroke to the opponent's split step and first step.

The feet are those of `courtside.records.footwork`: events with `start_s` (the last foot leaves the
floor, of a split step; the foot leaves, of a step) and `stop_s` (the first foot lands).
"""

from collections.abc import Hashable

import numpy as np
import pandas as pd

from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.strokes import REACTION_COLUMNS

# ASSUME: limits of a reaction to a stroke; no source is recorded.
EARLY_S = 0.3  # a split step may begin before the stroke: players foresee it,
LANDS_EARLY_S = 0.1  # and land before it, or seem to
LATEST_S = 1.2  # what begins later answers something else
STEPS = ("step", "lunge")
ABOUT_S = 0.5  # ASSUME: before and after a stroke nobody changes the half of the court


def join(
    strokes: pd.DataFrame,
    events: pd.DataFrame,
    points: Keypoints3D | None = None,
    net_y_m: float | None = None,
) -> pd.DataFrame:
    """Return a row for each stroke and each other person who has events: `REACTION_COLUMNS`.

    With the skeletons `points` and the place of a net, partners of who hits have no row: those on
    the same half of the court, and of more than two people those whose half is not known.

    `strokes` are of `courtside.strokes.detect.table`, `events` have the columns `person`, `event`,
    `start_s`, `start_sigma_s`, `stop_s`, `stop_sigma_s`. Intervals end when the split step lands
    and when the first foot leaves the floor after that, or after the stroke without a split step.
    Empty: there was none before the next stroke (of anybody) or within `LATEST_S`. Sigmas take the
    errors of both ends as independent.
    """
    rows = []
    for hit in strokes.itertuples():
        after = strokes.time_s[strokes.time_s > hit.time_s]
        stop_s = min([hit.time_s + LATEST_S, *after])
        partners = {str(hit.person), *_partners(hit.person, hit.time_s, points, net_y_m)}
        for person in sorted(set(events.person.astype(str)) - partners):
            own = events[events.person.astype(str) == person]
            reacted = _reaction(hit.time_s, hit.sigma_s, own, stop_s)
            rows.append({"person": person, "opponent": hit.person, "hit_s": hit.time_s, **reacted})
    return pd.DataFrame(rows, columns=REACTION_COLUMNS)


def _partners(
    person: Hashable, hit_s: float, points: Keypoints3D | None, net_y_m: float | None
) -> set[str]:
    """Return who may be on the half of the court of a person at a hit; nobody without a net."""
    if points is None or net_y_m is None:
        return set()
    about = np.abs(points.time_s - hit_s) <= ABOUT_S
    trunk = np.isin(points.joints, skeleton.TRUNK)
    y_m = np.ma.masked_invalid(points.xyz[:, about][:, :, trunk, 1])
    beyond = np.sign(np.ma.median(y_m, axis=(1, 2)).filled(np.nan) - net_y_m)
    own = beyond[points.person_id == person]
    if not len(own):
        return set()
    may_be = beyond != -own if len(points.person_id) > 2 else beyond == own
    return set(points.person_id[may_be].astype(str))


def _reaction(hit_s: float, sigma_s: float, own: pd.DataFrame, stop_s: float) -> dict[str, float]:
    begins = own.start_s.between(hit_s - EARLY_S, stop_s)
    lands = own.stop_s > hit_s - LANDS_EARLY_S
    splits = own[(own.event == "split_step") & begins & lands].sort_values("stop_s")
    steps, found = own[own.event.isin(STEPS) & (own.start_s <= stop_s)], {}
    from_s, from_sigma_s = hit_s, 0.0
    if len(splits):
        split = splits.iloc[0]
        from_s, from_sigma_s = split.stop_s, split.stop_sigma_s
        found = {"split_start_s": split.start_s, "split_stop_s": split.stop_s}
        found["to_split_s"] = split.stop_s - hit_s
        found["to_split_sigma_s"] = float(np.hypot(sigma_s, split.stop_sigma_s))
    steps = steps[steps.start_s >= from_s].sort_values("start_s")
    if len(steps):
        step = steps.iloc[0]
        found |= {"first_step_s": step.start_s, "to_step_s": step.start_s - hit_s}
        found["to_step_sigma_s"] = float(np.hypot(sigma_s, step.start_sigma_s))
        if len(splits):
            found["split_to_step_s"] = step.start_s - from_s
            found["split_to_step_sigma_s"] = float(np.hypot(from_sigma_s, step.start_sigma_s))
    return found
