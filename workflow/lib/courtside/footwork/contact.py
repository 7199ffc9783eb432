"""Probability of foot contact: a hidden Markov model of the speed and height of heel and toe.

The foot swings, or it stands on its heel, flat or on its toe. With markers, thresholds on speed and
height of heel and toe detect gait events ([OConnor2007]; Zeni et al. 2008). Here thresholds do not
work, because joints are noisy and feet also shuffle. Instead, each state has a density for velocity
and height of both points, widened by their stated variance. The posterior of the states over time
comes from the forward-backward algorithm (Rabiner 1989, sec. III).

Networks often place the toe of a foot that stands on its toe too high. A model that allows for this
finds the end of a stance better, but takes some low steps or hops for standing on the toe; a strict
model does not. Flights that only the strict one sees are its own.
"""

import numpy as np
from numpy.typing import NDArray

from courtside.footwork.tracks import Track
from courtside.kinematics import filtering

# Chosen on the takes of players-dev, and on hops that the virtual gym plans. Standard deviations
# per axis and mean heights, beside what the stated errors add: m/s and m.
STILL_M_S, STILL_M = 0.15, 0.008  # of a point that stands
ODD, ODD_TIMES = 0.01, 3.0  # share and widening of a standing point's gross errors
# Mean height of a toe on which the foot stands, heel up, and its standard deviation: chosen on six
# takes of players-dev, where it is seen up to 4 cm high, and on simulated feet, whose toe dips. The
# strict model has those of a flat foot.
TIPTOE, STRICT = (0.01, 0.02), (0.0, STILL_M)
SWING_M_S = (0.6, 1.5, 4.0)  # of a swinging point: shuffling, stepping and running alike
SWING_M, SWING_SD_M = 0.05, 0.05  # its height
RAISED_M_S, RAISED_M, RAISED_SD_M = 0.9, 0.04, 0.04  # of the other end of a tilted foot
# ASSUME: a foot that goes further than this without a swing, and faster than the small steps of
# somebody who waits, does not stand: it rides on wheels, or is dragged. In the study's takes it
# goes 0.35 m at most.
FURTHEST_M, RIDES_M_S = 0.5, 0.15
# Mean durations of states, s, and where they go: swing, heel, flat, toe. Forwards, a foot lands on
# its heel and leaves with its toe; backwards the other way round (Winter, Pluck & Yang 1989).
RATES = np.array(
    [
        [0.0, 0.35 / 0.3, 0.35 / 0.3, 0.3 / 0.3],
        [1 / 0.3, 0.0, 1 / 0.07, 0.0],
        [1 / 0.6, 0.5 / 0.6, 0.0, 1 / 0.25],
        [1 / 0.15, 0.0, 1 / 0.6, 0.0],
    ]
)
START = np.array([0.1, 0.1, 0.7, 0.1])


def probability(track: Track) -> NDArray:
    """Return posterior probabilities (N, 3) of contact of the foot, its heel and its toe.

    By the model `TIPTOE`, and around flights that it alone misses by the model `STRICT`; 0 while
    the foot goes further than `FURTHEST_M`, faster than `RIDES_M_S`.
    """
    found, strict = _posterior(track, TIPTOE), _posterior(track, STRICT)
    flies = np.concatenate([[False], strict[:, 0] <= 0.5, [False]])
    bounds = np.flatnonzero(flies[1:] != flies[:-1]).reshape(-1, 2)
    last = np.concatenate([[0], bounds[:, 1]])
    following = np.concatenate([bounds[:, 0], [len(strict)]])
    chosen = found.copy()
    for at, (start, stop) in enumerate(bounds.tolist()):
        if (found[start:stop, 0] > 0.5).all():
            around = slice((last[at] + start) // 2, (stop + following[at + 1]) // 2)
            chosen[around] = strict[around]
    for start, stop in filtering.runs(chosen[:, 0] > 0.5):
        went_m = np.linalg.norm(np.ptp(track.place[start:stop, :, :2].mean(axis=1), axis=0))
        if went_m > max(FURTHEST_M, RIDES_M_S * np.ptp(track.time_s[start:stop])):
            chosen[start:stop] = 0.0
    return chosen


def _posterior(track: Track, tiptoe: tuple[float, float]) -> NDArray:
    """Return the probabilities (N, 3) of contact by one model.

    Errors of filtered points are correlated over time: per period of the cut-off, only two times of
    the grid count as independent.
    """
    step_s = float(np.mean(np.diff(track.time_s)))
    weight = min(1.0, 2 * track.cutoff_hz * step_s)
    moves = RATES * step_s
    moves += np.diag(1 - moves.sum(axis=1))
    swing, heel, flat, toe = _smoothed(weight * _log_densities(track, tiptoe), moves).T
    return np.stack([1 - swing, heel + flat, flat + toe], axis=1)


def _log_densities(track: Track, tiptoe: tuple[float, float]) -> NDArray:
    """Return the log densities (N, 4) of the observations in each state."""
    heel, toe = _standing(track, *STRICT).T
    on_toe = _standing(track, *tiptoe)[:, 1]
    moving, raised = _of_points(track)
    (heel_up, toe_up), (heel_off, toe_off) = raised.T, moving.T
    return np.stack([heel_off + toe_off, heel + toe_up, heel + toe, heel_up + on_toe], axis=1)


def _standing(track: Track, height_m: float, sigma_m: float) -> NDArray:
    """Return log densities (N, 2) of heel and toe standing at a height with its deviation."""
    v, h = track.velocity, track.height - height_m
    v_var, h_var = track.velocity_variance, track.variance[..., 2]
    calm = _normal(v, STILL_M_S**2 + v_var).sum(axis=2) + _normal(h, sigma_m**2 + h_var)
    odd = _normal(v, (ODD_TIMES * STILL_M_S) ** 2 + v_var).sum(axis=2)
    odd += _normal(h, (ODD_TIMES * sigma_m) ** 2 + h_var)
    return np.logaddexp(np.log(1 - ODD) + calm, np.log(ODD) + odd)


def _of_points(track: Track) -> tuple[NDArray, NDArray]:
    """Return log densities (N, 2) of heel and toe: swinging, raised."""
    v, h = track.velocity, track.height
    v_var, h_var = track.velocity_variance, track.variance[..., 2]
    speeds = [_normal(v, own**2 + v_var).sum(axis=2) for own in SWING_M_S]
    moving = np.logaddexp.reduce(speeds, axis=0) - np.log(len(SWING_M_S))
    moving += _normal(h - SWING_M, SWING_SD_M**2 + h_var)
    raised = _normal(v, RAISED_M_S**2 + v_var).sum(axis=2)
    return moving, raised + _normal(h - RAISED_M, RAISED_SD_M**2 + h_var)


def _normal(x: NDArray, variance: NDArray) -> NDArray:
    return -0.5 * (np.log(2 * np.pi * variance) + x**2 / variance)


def _smoothed(log_densities: NDArray, moves: NDArray) -> NDArray:
    """Return the posterior (N, K) of states by the forward-backward algorithm, scaled."""
    seen = np.exp(log_densities - log_densities.max(axis=1, keepdims=True))
    forward, backward = np.empty_like(seen), np.ones_like(seen)
    scale = np.ones(len(seen))
    now = START
    for at, each in enumerate(seen):
        now = (now @ moves if at else now) * each
        scale[at] = now.sum()
        forward[at] = now = now / scale[at]
    for at in range(len(seen) - 2, -1, -1):
        backward[at] = moves @ (seen[at + 1] * backward[at + 1]) / scale[at + 1]
    both = forward * backward
    return both / both.sum(axis=1, keepdims=True)
