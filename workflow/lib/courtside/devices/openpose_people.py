"""Persons from frame to frame, in files that list them anew in every frame."""

import numpy as np
from scipy.optimize import linear_sum_assignment

# ASSUME: people move by less than a third of their size in the picture from where they were last seen.
FARTHEST = 0.33
LONGEST_GAP = 10  # frames
LEAST_SIZE_PX = 30.0  # of what is seen of a person: less says little of how far they may move


def link(people):
    """Follow persons through the frames of one camera.

    Parameters
    ----------
    people : list of (K, J, 3) float, length T
        Persons in each frame: x, y in px, NaN where unseen, and score.

    Returns
    -------
    tracks : (P, T, J, 3) float
        NaN where a person is not in a frame; in the order in which they appear.

    Notes
    -----
    Each frame's persons are given to the tracks so that the median distances between keypoints that both have
    are least in sum (Kuhn 1955); who is too far from all begins a new track. Crossing persons may be
    exchanged.
    """
    tracks, last_seen = [], []
    for at, found in enumerate(people):
        open_tracks = [k for k, seen in enumerate(last_seen) if at - seen <= LONGEST_GAP]
        costs = np.full((len(found), len(open_tracks)), np.inf)
        for row, person in enumerate(found):
            for column, k in enumerate(open_tracks):
                costs[row, column] = _distance(tracks[k][last_seen[k]], person)
        owner = _assign(costs)
        for row, person in enumerate(found):
            if row in owner:
                k = open_tracks[owner[row]]
            else:
                k = len(tracks)
                tracks.append({})
                last_seen.append(at)
            tracks[k][at], last_seen[k] = person, at
    return _stacked(tracks, people)


def _distance(before, after):
    """Return how far a person moved, as a share of what is allowed; inf without a common point."""
    step = np.linalg.norm(after[:, :2] - before[:, :2], axis=1)
    both = np.isfinite(step)
    if not both.any():
        return np.inf
    seen = before[np.isfinite(before[:, 0]), :2]
    size_px = max(np.ptp(seen, axis=0).max(), LEAST_SIZE_PX)
    return float(np.median(step[both]) / size_px / FARTHEST)


def _assign(costs):
    """Return {row: column} of the pairs that are near enough."""
    if not costs.size:
        return {}
    near = costs <= 1
    rows, columns = linear_sum_assignment(np.where(near, costs, 1e6))
    return {int(r): int(c) for r, c in zip(rows, columns, strict=True) if near[r, c]}


def _stacked(tracks, people):
    n_joints = people[0].shape[1] if people else 0
    whole = np.full((len(tracks), len(people), n_joints, 3), np.nan)
    for k, track in enumerate(tracks):
        for at, person in track.items():
            whole[k, at] = person
    return whole
