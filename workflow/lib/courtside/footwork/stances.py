"""Stances of one foot from its probability of contact: onset and end between frames, with sigma."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.footwork import contact
from courtside.footwork.tracks import Track

# Fitted on the takes of players-dev. A foot comes to rest smoothly, and its last millimetres are
# as slow as a standing foot's noise: contact seems to begin early and to end late, the more so the
# slower the swing: by these metres over its highest speed.
LATE = {"onset": 0.075, "end": -0.05}
SLOWEST_M_S = 1.2  # swings are taken for no slower
# Not so a foot that falls onto the floor, from a box or after a leap, or is thrown off it: such
# times are not moved. ASSUME: its fastest fall in the time before it lands, or rise after it
# leaves, m/s, times the share that this is of the swing's highest speed. Steps, runs, lunges and
# split steps of the development bodies have up to 0.74, of the study's takes 0.85; made drops from
# 0.2 to 0.6 m 1.1 to 2.7, leaps from foot to foot of 0.45 s or longer 0.6 to 2.4.
FALLS_M_S, FALLS_S = (0.9, 1.1), 0.05
FALL_SIGMA_S = 0.02  # ASSUME: beside `SIGMA`, of these; such landings seem 0.01 to 0.03 s late
# Standard deviation: of each boundary, s; metres over the swing's highest speed; and how many times
# the spread of the posterior's own.
SIGMA = {"onset": (0.005, 0.02, 0.6), "end": (0.005, 0.02, 0.8)}
# And of both, times what a frame lasts longer than at this rate: filters of slow cameras are slow,
# and onsets early, ends late. On the same takes as if filmed at 8 to 25 frames per second, the
# filter's 0.45 of the rate, root mean square: 0.4 to 0.8.
SLOW, USUAL_HZ = 0.7, 30.0


@dataclass(frozen=True, eq=False)
class Stance:
    """One time in which a foot stands; NaN where the foot is not seen to land or to leave."""

    onset_s: float
    onset_sigma_s: float
    end_s: float
    end_sigma_s: float
    xy: NDArray  # (2,): mean of the middle of heel and toe, m
    sigma_m: float  # standard deviation of `xy` per axis, from the keypoints
    quality: float  # mean probability of contact in between
    seen_s: tuple[float, float]  # from when until when the foot is seen without a gap

    @property
    def since_s(self) -> float:
        """The time from which the foot is known to stand, s."""
        return self.onset_s if np.isfinite(self.onset_s) else self.seen_s[0]

    @property
    def until_s(self) -> float:
        """The time until which the foot is known to stand, s."""
        return self.end_s if np.isfinite(self.end_s) else self.seen_s[1]


def of_tracks(tracks: Sequence[Track], n_frames: int) -> tuple[list[Stance], NDArray]:
    """Return the stances of one foot in order of time, and its probabilities (T, 3) of contact.

    Of the foot, its heel and its toe.
    """
    found, frames = [], np.full((n_frames, 3), np.nan)
    for track in tracks:
        stances, frames[track.frames] = _of_track(track, contact.probability(track))
        found += stances
    return found, frames


def _of_track(track: Track, posterior: NDArray) -> tuple[list[Stance], NDArray]:
    """Return the stances in a run of frames, and the probabilities of contact at its frames.

    Those are the posterior (N, 3), its times moved as the onsets and ends are.
    """
    probability = posterior[:, 0]
    time_s, stands = track.time_s, probability > 0.5
    at = np.flatnonzero(stands[1:] != stands[:-1])
    share = (0.5 - probability[at]) / (probability[at + 1] - probability[at])
    raw_s = time_s[at] + share * (time_s[at + 1] - time_s[at])
    kinds = ["onset" if stands[i + 1] else "end" for i in at]
    moved_s, sigma_s = np.empty_like(raw_s), np.empty_like(raw_s)
    edges_s = np.concatenate([time_s[:1], raw_s, time_s[-1:]])
    speed = np.linalg.norm(track.velocity.mean(axis=1), axis=1)
    for k, what in enumerate(kinds):
        swing_s = edges_s[k : k + 2] if what == "onset" else edges_s[k + 1 : k + 3]
        fastest = max(SLOWEST_M_S, speed[_between(time_s, swing_s)].max(initial=0.0))
        smooth = _smooth(track, what, raw_s[k], fastest)
        moved_s[k] = raw_s[k] + smooth * LATE[what] / fastest
        middles = (edges_s[k] + raw_s[k]) / 2, (raw_s[k] + edges_s[k + 2]) / 2
        own_s = _sigma(track, probability, what, fastest, middles)
        sigma_s[k] = np.hypot(own_s, (1 - smooth) * FALL_SIGMA_S)
    moved_s = np.maximum.accumulate(moved_s)  # a very short stance may vanish
    before, after = time_s[:1] - 1, time_s[-1:] + 1
    moved, raw = (np.concatenate([before, each, after]) for each in (moved_s, raw_s))
    at_s = np.interp(time_s[:: track.step], moved, raw)
    frames = np.stack([np.interp(at_s, time_s, each) for each in posterior.T], axis=1)
    first = 0 if stands[0] else 1
    bounds = np.concatenate([[np.nan], moved_s, [np.nan]])
    sigmas = np.concatenate([[np.nan], sigma_s, [np.nan]])
    starts = [k for k in range(first, len(bounds) - 1, 2) if not bounds[k + 1] <= bounds[k]]
    return [_stance(track, probability, edges_s, bounds, sigmas, k) for k in starts], frames


def _smooth(track: Track, what: str, at_s: float, fastest: float) -> float:
    """Return 1 for a foot that is set down or lifted smoothly, 0 for one that falls or jumps."""
    span_s, sign = ((at_s - FALLS_S, at_s), -1) if what == "onset" else ((at_s, at_s + FALLS_S), 1)
    vertical = sign * track.velocity[_between(track.time_s, span_s), :, 2].mean(axis=1)
    return float(np.interp(max(0.0, vertical.max()) ** 2 / fastest, FALLS_M_S, (1.0, 0.0)))


def _sigma(
    track: Track,
    probability: NDArray,
    what: str,
    fastest: float,
    within_s: tuple[float, float],
) -> float:
    """Return the standard deviation of an onset or end, s."""
    least, length, times = SIGMA[what]
    inside = _between(track.time_s, within_s)
    time_s, before = track.time_s[inside], probability[inside]
    rising = np.maximum.accumulate(before if what == "onset" else 1 - before)
    weight = np.diff(rising, prepend=0.0)
    weight /= max(weight.sum(), 1e-12)
    spread = np.sqrt(max(0.0, weight @ time_s**2 - (weight @ time_s) ** 2)) if len(time_s) else 0
    slow = SLOW * max(0.0, track.frame_s - 1 / USUAL_HZ)
    return float(np.sqrt(least**2 + (length / fastest) ** 2 + (times * spread) ** 2 + slow**2))


def _stance(
    track: Track, probability: NDArray, edges_s: NDArray, bounds: NDArray, sigmas: NDArray, k: int
) -> Stance:
    """Return the stance between the k-th and the next boundary."""
    inside = _between(track.time_s, edges_s[k : k + 2])
    weight = probability[inside] / probability[inside].sum()
    variance = track.variance[inside][..., :2].mean(axis=(1, 2))
    return Stance(
        onset_s=float(bounds[k]),
        onset_sigma_s=float(sigmas[k]),
        end_s=float(bounds[k + 1]),
        end_sigma_s=float(sigmas[k + 1]),
        xy=weight @ track.place[inside][..., :2].mean(axis=1),
        sigma_m=float(np.sqrt(weight @ variance)),
        quality=float(probability[inside].mean()),
        seen_s=(float(np.fmin(edges_s[0], bounds[1])), float(np.fmax(edges_s[-1], bounds[-2]))),
    )


def _between(time_s: NDArray, span_s: Sequence[float] | NDArray) -> NDArray:
    """Return which times (N,) lie in a span; the next one where none does."""
    inside = (time_s >= span_s[0]) & (time_s <= span_s[1])
    inside[min(np.searchsorted(time_s, span_s[0]), len(time_s) - 1)] |= not inside.any()
    return inside
