"""Whether a part of a camera's video has another offset than its clock: frames are missing."""

from collections.abc import Collection, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.records.devices.clocks import Clock
from courtside.statistics import autocorrelation
from courtside.synchronisation import smooth_tracks
from courtside.synchronisation.epipolar import Epipolar
from courtside.synchronisation.speed import Speeds

# ASSUME: this block was chosen on takes of 24 s of `players-b`, from which 6 frames of 30 a second
# were taken out in one camera after a quarter or three quarters. None of the 34 whole takes of the
# development sessions is doubted. They last 3 to 10 s: missing frames are not noticed there either.
# Parts of longer takes are checked on synthetic takes of 2 to 15 minutes.
REACH_S, STEP_S = 1.0, 1 / 30  # offsets about the found one
PARTS, PART_S = 8, 5.0  # of a take, compared each for itself: so many, or more of so many s
DISTINCT = 3.0  # standard deviations by which another offset must be better, in a part or all
LEAST_RUN = 2  # parts one after the other that must prefer the same offset
LEAST_S = 0.1  # less is within what clocks and networks are wrong by


def doubt(
    evidence: Epipolar | Speeds, camera: int, own: Sequence[Clock], used: Collection[int]
) -> tuple[float, str]:
    """Return a clause if some part of a camera's video prefers another offset, and how clearly.

    The clause is empty if none does; the number is in standard deviations. `own` are the clocks
    that were found, of all cameras; `used` are the cameras to compare it with.
    """
    lags_s = STEP_S * np.arange(-round(REACH_S / STEP_S), round(REACH_S / STEP_S) + 1)
    track = evidence.tracks[camera]
    shown_s = track.step_s * np.isfinite(track.values).any(axis=(0, 2, 3)).sum()
    n_parts = max(PARTS, round(shown_s / PART_S))
    most, losses = evidence.scan_times * n_parts // PARTS, []
    for other in sorted(set(used) - {camera}):
        at, swapped = smooth_tracks.compared(track, evidence.tracks[other], most)
        if not swapped and len(at) >= n_parts:
            time_s = track.start_s + track.step_s * at
            other_s = own[other].from_reference(own[camera].to_reference(time_s))
            losses.append(evidence.scan(camera, other, (other_s - time_s)[:, None] - lags_s, most))
    if not losses or any(len(loss) != len(losses[0]) for loss in losses):
        return 0.0, ""
    loss = np.nanmean(losses, axis=0)
    parts = np.array_split(np.arange(len(loss)), n_parts)
    preferred = np.array([_preferred(loss[part], lags_s) for part in parts])
    for first, last in _runs(preferred, len(lags_s) // 2):
        at = np.concatenate(parts[first : last + 1])
        best = int(np.median(preferred[first : last + 1]))
        rows = [at, *parts[first : last + 1]]
        better = max(_better(loss[row], best, len(lags_s) // 2) for row in rows)
        if better > DISTINCT:
            return better, (
                f"from {time_s[at[0]]:.0f} to {time_s[at[-1]]:.0f} s of its video, it agrees "
                f"better {1e3 * lags_s[best]:+.0f} ms beside this clock: frames are probably "
                "missing; give the parts before and after as takes of their own"
            )
    return 0.0, ""


def _preferred(loss: NDArray, lags_s: NDArray) -> int:
    """Return the index of the offset with the least loss in a part (N, L) of the take.

    It is that of the found one where another is near it, or nothing is known of both.
    """
    here = len(lags_s) // 2
    known = np.isfinite(loss)
    total = np.where(known, loss, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    best = int(np.argmin(np.where(known.mean(axis=0) >= 0.5, total, np.inf)))
    told = known[:, [best, here]].any(axis=0).all() and abs(lags_s[best]) >= LEAST_S
    return best if told else here


def _better(loss: NDArray, best: int, here: int) -> float:
    """Return by how many standard deviations one offset of losses (N, L) is better than another."""
    apart = loss[:, here] - loss[:, best]
    return autocorrelation.distinct(apart[np.isfinite(apart)])


def _runs(preferred: NDArray, here: int) -> Iterator[tuple[int, int]]:
    """Yield first and last of parts, in a row, that prefer the same other offset."""
    first = 0
    for at in range(1, len(preferred) + 1):
        if at < len(preferred) and abs(preferred[at] - preferred[first]) <= 1:
            continue
        if at - first >= LEAST_RUN and preferred[first] != here:
            yield first, at - 1
        first = at
