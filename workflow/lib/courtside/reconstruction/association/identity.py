"""The probability that a tracked person is one person, and possible exchanges of persons."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from courtside.reconstruction.association.candidates import Candidates

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md). Probabilities that a
# person is still the same one after people met, or after nobody was placed for a while.
MEET_M = 0.8  # of two bodies' centres, on the floor: closer, trackers confuse them
GAP_S = 0.5  # without a place
CARRIED = 0.995  # a camera's tracklet goes through without a cut
MOTION = 0.95  # only the motion says who is who
REACH_MS = 4.0  # who could be where the person is found again
TRUSTED = 6.0  # limit of the log-likelihood ratio of body lengths, which err together


@dataclass(frozen=True)
class Followed:
    """People followed at N instants: their candidates."""

    chosen: NDArray  # (K, N): index of each one's place among the candidates, -1 for none
    seen_alone: NDArray  # (K, N): index of the ray of a single view, -1 for none
    candidates: Candidates
    piece: NDArray  # (M, C): uncut piece of each candidate's row in each camera, -1 without one

    def path(self) -> NDArray:
        """Return places (K, N, 3), m; NaN where there is none."""
        there = (self.chosen >= 0)[..., None]
        return np.where(there, self.candidates.xyz[self.chosen], np.nan)

    def pieces(self) -> NDArray:
        """Return the piece (K, N, C) of each camera that shows each person; -1 for none."""
        either = np.where(self.chosen >= 0, self.chosen, self.seen_alone)
        return np.where((either >= 0)[..., None], self.piece[either], -1)


def doubts(people: Followed, time_s: NDArray, lengths_m: NDArray) -> NDArray:
    """Return the possible exchanges of persons (D, 5), by person and time.

    Each row holds: person; start and stop, s of the reference clock; the other person, -1 where
    nobody came near; the probability that the person is still the same. `time_s` (N,) is of the
    instants, `lengths_m` (K, N, B) are the lengths of bones, NaN where unknown.
    """
    path, pieces = people.path(), people.pieces()
    found = []
    for person in range(len(path)):
        for first, last, other in _occasions(path, time_s, person):
            kept = CARRIED if _carried(pieces[person, first], pieces[person, last]) else MOTION
            if kept != CARRIED and other >= 0:
                odds = np.log(kept / (1 - kept))
                odds += _ratio(lengths_m, time_s, (person, other), (first, last))
                kept = float(1 / (1 + np.exp(-odds)))
            found.append((person, time_s[first], time_s[last], other, kept))
    return np.array(found, float).reshape(-1, 5)


def confidence(doubts_: NDArray, n_persons: int) -> NDArray:
    """Return the probability (K,) that each person is one person throughout."""
    found = np.ones(n_persons)
    for person, _, _, _, kept in doubts_:
        found[int(person)] *= kept
    return found


def _occasions(path: NDArray, time_s: NDArray, person: int) -> list[tuple[int, int, int]]:
    """Return the instants around meetings and gaps of a person, and the other person or -1."""
    placed = np.isfinite(path[..., 0])
    own = np.flatnonzero(placed[person]).tolist()
    found = []
    for left, right in pairwise(own):
        if time_s[right] - time_s[left] > GAP_S:
            found.append((left, right, _who_could_be(path, time_s, person, left, right)))
    apart = np.linalg.norm(path[:, :, :2] - path[person, :, :2], axis=-1)
    for other in (o for o in range(len(path)) if o != person):
        near = np.flatnonzero(np.nan_to_num(apart[other], nan=np.inf) < MEET_M)
        far = np.flatnonzero(placed[person] & ~(np.nan_to_num(apart[other], nan=np.inf) < MEET_M))
        for group in _groups(near, time_s):
            before, after = far[far < group[0]], far[far > group[-1]]
            if len(before) and len(after):
                found.append((int(before[-1]), int(after[0]), other))
    return sorted(found)


def _groups(at: NDArray, time_s: NDArray) -> list[NDArray]:
    """Return runs of instants, shorter pauses included."""
    if not len(at):
        return []
    return np.split(at, np.flatnonzero(np.diff(time_s[at]) > GAP_S) + 1)


def _who_could_be(path: NDArray, time_s: NDArray, person: int, left: int, right: int) -> int:
    """Return who could be where the person is found again after a gap; -1 for nobody."""
    reach = REACH_MS * (time_s[right] - time_s[left])
    around = path[:, left : right + 1, :2] - path[person, right, :2]
    away = np.nan_to_num(np.linalg.norm(around, axis=-1), nan=np.inf).min(axis=1)
    away[person] = np.inf
    return int(np.argmin(away)) if away.min() <= reach else -1


def _carried(before: NDArray, after: NDArray) -> bool:
    return bool(((before == after) & (before >= 0)).any())


def _ratio(lengths_m: NDArray, time_s: NDArray, pair: tuple, between: tuple) -> float:
    """Return the log-likelihood ratio of body lengths: kept against exchanged.

    # ASSUME: medians over up to 2 s of bones have a standard deviation of 5 %, and err together.
    """
    before = (time_s <= time_s[between[0]]) & (time_s > time_s[between[0]] - 2.0)
    after = (time_s >= time_s[between[1]]) & (time_s < time_s[between[1]] + 2.0)
    size = [[_median(lengths_m[who][when]) for when in (before, after)] for who in pair]
    off = [[np.log(a[0]) - np.log(b[1]) for b in size] for a in size]
    kept, exchanged = off[0][0] ** 2 + off[1][1] ** 2, off[0][1] ** 2 + off[1][0] ** 2
    known = np.isfinite(kept) & np.isfinite(exchanged)
    if not known.any():
        return 0.0
    ratio = (exchanged - kept)[known].mean() / (4 * 0.05**2) * np.sqrt(known.sum())
    return float(np.clip(ratio, -TRUSTED, TRUSTED))


def _median(values: NDArray) -> NDArray:
    """Return medians (B,) of at least five values, else NaN."""
    known = np.isfinite(values).sum(axis=0) >= 5
    filled = np.where(known, values, 1.0) if len(values) else np.ones((1, values.shape[1]))
    return np.where(known, np.nanmedian(filled, axis=0), np.nan)
