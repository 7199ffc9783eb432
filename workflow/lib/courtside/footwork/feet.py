"""Footwork of a take from its skeletons: contacts, steps and events."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.footwork import hops, kinds, stances, tracks
from courtside.records import footwork
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.study.execution import log


def find(
    points: Keypoints3D, cutoff_hz: Sequence[float]
) -> tuple[footwork.Contacts, pd.DataFrame, pd.DataFrame]:
    """Return contacts, steps and events of every person.

    `points` are filtered skeletons, `cutoff_hz` (J,) the cut-off of each joint. A skeleton without
    heel and toe gives no contacts.
    """
    n_people, n_frames = points.xyz.shape[:2]
    probability = np.full((n_people, n_frames, 2, 3), np.nan)
    floor = np.full((n_people, 2, 2), np.nan)
    people = {}
    for at, person in enumerate(points.person_id.tolist()):
        feet, own = {}, hops.find(points, at)
        for foot, side in enumerate(footwork.FEET):
            found, floor[at, foot] = tracks.tracks(points, at, side, cutoff_hz)
            stood, known = stances.of_tracks(found, n_frames)
            feet[side] = hops.cut(stood, own or ())
            probability[at, :, foot] = hops.lifted(points.time_s, known, feet[side], own or ())
        people[person] = feet, leg_length(points, at), own
    _warn(points, np.isfinite(floor).any(axis=2))
    contacts = footwork.Contacts(
        points.person_id,
        np.array(footwork.FEET),
        points.time_s,
        probability[..., 0],
        probability[..., 1:],
        floor,
    )
    return contacts, *kinds.tables(people)


def _warn(points: Keypoints3D, known: NDArray) -> None:
    """Tell why contacts are missing or inaccurate; `known` (P, S): which feet are."""
    names = points.joints.tolist()
    for person, foot in np.argwhere(~known & known.any(axis=1, keepdims=True)):
        log.logger.warning(
            "%s: expected heel and toe of the %s foot in %d frames in a row, found none: contacts "
            "and steps are those of the other foot alone",
            points.person_id[person],
            footwork.FEET[foot],
            tracks.LEAST_FRAMES,
        )
    if not (some := known.any(axis=1)).all():
        there = any(skeleton.heel_and_toe(names, side) for side in footwork.FEET)
        log.logger.warning(
            "%s: expected heels and toes of at least one foot in %d frames in a row, found none: "
            "no contacts; %s",
            ", ".join(points.person_id[~some]),
            tracks.LEAST_FRAMES,
            "film people for longer, with their feet in view of two cameras"
            if there
            else "take a network whose skeleton has them",
        )
    if some.any() and points.rate_hz < hops.LEAST_HZ:
        log.logger.warning(
            "%.3g frames per second are few for footwork: stances begin too early and end too late,"
            " by 0.03 s each at 15 frames per second; sigma contains this",
            points.rate_hz,
        )


def leg_length(points: Keypoints3D, person: int) -> float:
    """Return the length of thigh and shank, m: median over frames and sides; NaN if unknown."""
    names = points.joints.tolist()
    lengths = []
    for side in footwork.FEET:
        hip, knee, ankle = (
            points.xyz[person][:, names.index(f"{side}_{joint}")]
            for joint in ("hip", "knee", "ankle")
        )
        lengths.append(np.linalg.norm(hip - knee, axis=1) + np.linalg.norm(knee - ankle, axis=1))
    known = np.concatenate(lengths)
    known = known[np.isfinite(known)]
    return float(np.median(known)) if len(known) else float("nan")
