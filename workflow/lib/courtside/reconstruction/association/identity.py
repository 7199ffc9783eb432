"""The probability that a tracked person is one person, and possible exchanges of persons."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from courtside.reconstruction.association.appearance import Looks
from courtside.reconstruction.association.candidates import Candidates

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md). Probabilities that a
# person is still the same one after people met, or after nobody was placed for a while.
MEET_M = 0.8  # of two bodies' centres, on the floor: closer, trackers confuse them
GAP_S = 0.5  # without a place
CARRIED = 0.995  # a camera's tracklet goes through without a cut
MOTION = 0.95  # only the motion says who is who
REACH_MS = 4.0  # who could be where the person is found again
TRUSTED = 6.0  # limit of a log-likelihood ratio: body lengths err together
LENGTH_SPREAD = 0.05  # of medians over up to 2 s of bones, as log ratio
SAME = 0.8  # if nothing else tells: found again after a gap is no stranger
# Standard deviations per axis, on the floor, of where a person is found again: at first, more by
# each second, at most that of strangers.
STAYS_M, GOES_MS, STRANGER_M = 0.5, 1.5, 4.0
OWN_SPREAD = 0.03  # as LENGTH_SPREAD, of the mean over one person's bones: best in 34 takes
STRANGER_SPREAD = 0.08  # of the bones of people, as log ratio


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

    def worn(self, looks: Looks) -> NDArray:
        """Return the colours (K, N, Q) of their clothes; NaN where unknown."""
        there = (self.chosen >= 0)[..., None]
        return np.where(there, looks.middle(self.candidates)[self.chosen], np.nan)


def doubts(
    people: Followed, time_s: NDArray, lengths_m: NDArray, looks: Looks | None = None
) -> NDArray:
    """Return the possible exchanges of persons (D, 5), by person and time.

    Each row holds: person; start and stop, s of the reference clock; the other person, -1 where
    nobody came near; the probability that the person is still the same. `time_s` (N,) is of the
    instants, `lengths_m` (K, N, B) are the lengths of bones, NaN where unknown; with `looks`, the
    clothes say whether a stranger came.
    """
    path, pieces = people.path(), people.pieces()
    worn = people.worn(looks) if looks else np.empty((len(path), 0))
    found = []
    for person in range(len(path)):
        for first, last, other in _occasions(path, time_s, person):
            kept = CARRIED
            if not _carried(pieces[person, first], pieces[person, last]):
                alike = 0.0
                if looks:
                    before, after = _around(worn[person], time_s, (first, last))
                    alike = -float(looks.cost(after - before, 1.0))
                kept = _kept(path, time_s, lengths_m, (person, other), (first, last), alike)
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
    """Return who could be where the person is found again after a gap; -1 for nobody.

    Who is placed throughout the gap, and far from both of its ends, is where he is placed.
    """
    during = slice(left, right + 1)
    around = path[:, during, None, :2] - path[person, [left, right], :2]
    near = np.nan_to_num(np.linalg.norm(around, axis=-1), nan=np.inf).min(axis=1)
    away = near[:, 1]
    for other, placed in enumerate(np.isfinite(path[:, during, 0])):
        known_s = time_s[[left, *(left + np.flatnonzero(placed)), right]]
        if np.diff(known_s).max() <= GAP_S and near[other].min() > REACH_MS * GAP_S:
            away[other] = np.inf
    away[person] = np.inf
    return int(np.argmin(away)) if away.min() <= REACH_MS * (time_s[right] - time_s[left]) else -1


def _carried(before: NDArray, after: NDArray) -> bool:
    return bool(((before == after) & (before >= 0)).any())


def _kept(
    path: NDArray, time_s: NDArray, lengths_m: NDArray, pair: tuple, between: tuple, alike: float
) -> float:
    """Return the probability that a person is the same after a meeting or gap as before.

    It is not, if exchanged with the other of the `pair`, or, after a gap, if a stranger came. The
    log odds that he is none by his clothes are `alike`.
    """
    against = []
    if pair[1] >= 0:
        against.append(np.log(MOTION / (1 - MOTION)) + _ratio(lengths_m, time_s, pair, between))
    if not np.isfinite(path[pair[0], between[0] + 1 : between[1], 0]).any():
        against.append(_familiar(path[pair[0]], time_s, lengths_m[pair[0]], between) + alike)
    return float(1 / (1 + np.exp(-np.array(against)).sum()))


def _familiar(path: NDArray, time_s: NDArray, lengths_m: NDArray, between: tuple) -> float:
    """Return the log odds that a person found again after a gap is no stranger."""
    first, last = between
    away_m = float(np.linalg.norm(path[last, :2] - path[first, :2]))
    stays_m = min(STAYS_M + GOES_MS * (time_s[last] - time_s[first]), STRANGER_M)
    odds = np.log(SAME / (1 - SAME)) + _likelier(away_m, stays_m, STRANGER_M, 2)
    before, after = _around(lengths_m, time_s, between)
    off = np.log(after) - np.log(before)
    off = off[np.isfinite(off)]
    if len(off):
        same = np.sqrt(2) * OWN_SPREAD
        other = np.sqrt(2) * np.hypot(OWN_SPREAD, STRANGER_SPREAD)
        odds += _likelier(off.mean(), same, other)
    return float(odds)


def _likelier(off: float, same: float, other: float, axes: int = 1) -> float:
    """Return the log-likelihood ratio of a deviation by two normal standard deviations per axis."""
    ratio = axes * np.log(other / same) - 0.5 * off**2 * (same**-2 - other**-2)
    return float(np.clip(ratio, -TRUSTED, TRUSTED))


def _around(lengths_m: NDArray, time_s: NDArray, between: tuple) -> tuple[NDArray, NDArray]:
    """Return a person's median lengths (B,) within 2 s before and after."""
    before = (time_s <= time_s[between[0]]) & (time_s > time_s[between[0]] - 2.0)
    after = (time_s >= time_s[between[1]]) & (time_s < time_s[between[1]] + 2.0)
    return _median(lengths_m[before]), _median(lengths_m[after])


def _ratio(lengths_m: NDArray, time_s: NDArray, pair: tuple, between: tuple) -> float:
    """Return the log-likelihood ratio, kept against exchanged, of lengths, which err together."""
    size = [_around(lengths_m[who], time_s, between) for who in pair]
    off = [[np.log(a[0]) - np.log(b[1]) for b in size] for a in size]
    kept, exchanged = off[0][0] ** 2 + off[1][1] ** 2, off[0][1] ** 2 + off[1][0] ** 2
    known = np.isfinite(kept) & np.isfinite(exchanged)
    if not known.any():
        return 0.0
    ratio = (exchanged - kept)[known].mean() / (4 * LENGTH_SPREAD**2) * np.sqrt(known.sum())
    return float(np.clip(ratio, -TRUSTED, TRUSTED))


def _median(values: NDArray) -> NDArray:
    """Return medians (B,) of at least five values, else NaN."""
    known = np.isfinite(values).sum(axis=0) >= 5
    filled = np.where(known, values, 1.0) if len(values) else np.ones((1, values.shape[1]))
    return np.where(known, np.nanmedian(filled, axis=0), np.nan)
