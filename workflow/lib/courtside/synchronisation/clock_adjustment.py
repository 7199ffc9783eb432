"""Offsets and drifts of all clocks together, from the losses of every pair of cameras over time."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

STEPS = 12  # Newton steps at most; SMALLEST_S is usually reached earlier
SMALLEST_S = 1e-5  # the adjustment ends with a smaller step: far below a millisecond
LARGEST_S = 0.05  # limit of a step, about a frame: the loss is smooth only over such times
COVERAGE = 0.90  # of the intervals that the study states
MEMORY_S = 1.5  # ASSUME: two spans of this length carry nearly independent information
FEWEST_BLOCKS = 8  # but the evidence is cut into at least this many blocks,
SHORTEST_S = 0.3  # ASSUME: none shorter than this: errors of networks last about a third of it
PARTITIONS = 3  # ways to cut, averaged
# ASSUME: effective share of the blocks: fast motion, and with it information, comes in bursts.
EQUAL = 0.6
SMALLEST_CURVATURE = 1e-3  # relative to the scaled steepness: a flatter direction is undetermined

# Losses of pairs of cameras: see `adjust`.
Terms = Callable[[NDArray], Mapping[tuple[int, int], tuple[NDArray, ...]]]


@dataclass(frozen=True, eq=False)
class Adjusted:
    """Clocks as `own = t + offset + drift * (t - centre_s)`."""

    offset_s: NDArray  # (C,): at `centre_s` of the reference clock
    drift: NDArray  # (C,): without unit
    # (2 C, 2 C), of offset 0, drift 0, offset 1, ...: zero for fixed parameters, infinite for
    # undetermined ones.
    covariance: NDArray
    centre_s: float

    def own(self, camera: int, time_s: NDArray) -> NDArray:
        """Return what a camera's clock shows at times of the reference clock."""
        return time_s + self.offset_s[camera] + self.drift[camera] * (time_s - self.centre_s)


def adjust(
    terms: Terms,
    offset_s: Sequence[float] | NDArray,
    time_s: NDArray,
    unknowns: NDArray,
    drift: Sequence[float] | NDArray | None = None,
) -> Adjusted:
    """Find the offsets and drifts that minimise the loss of all pairs.

    `terms(own)`, with `own` (C, T) what each clock shows, returns for pairs (a, b) `(slope,
    curvature, steepness)`, (T,) each: first derivative, second derivative and its never negative
    part, of the pair's loss by the offset of b against a. `offset_s` and `drift` (C,), by default
    zero, are start values; camera 0 stays. `time_s` (T,) are of the reference clock. `unknowns`
    (C,) are 2 to estimate offset and drift, 1 for the offset with zero drift, 0 for a fixed clock.

    Newton's method. The covariance is that of the jackknife over blocks of time (MacKinnon & White
    1985), valid for correlated noise of neighbouring frames and of pairs with a common camera. It
    is widened as Student's t for the number of blocks.
    """
    centre_s = float(time_s.mean())
    # Indices of the free parameters among offset 0, drift 0, offset 1, ...
    free = np.array([2 * c + k for c, count in enumerate(unknowns) for k in range(count)], int)
    drift = np.zeros(len(offset_s)) if drift is None else drift
    state = np.column_stack([offset_s, drift]).astype(float)
    lever = np.column_stack([np.ones_like(time_s), time_s - centre_s])
    for _ in range(STEPS):
        slope, curvature, steepness = _normal(terms(_own(state, lever, time_s)), lever, free)
        step = np.zeros(state.size)
        step[free] = _step(slope.sum(axis=0), curvature.sum(axis=0), steepness.sum(axis=0))
        move = step.reshape(state.shape)
        largest = np.abs(move @ lever[[0, -1]].T).max(initial=0.0)
        state += move * min(1.0, LARGEST_S / max(largest, 1e-300))
        if largest < SMALLEST_S:
            break
    slope, curvature, steepness = _normal(terms(_own(state, lever, time_s)), lever, free)
    covariance = _covariance(slope, curvature, steepness, time_s[1] - time_s[0])
    whole = np.zeros((state.size, state.size))
    whole[np.ix_(free, free)] = covariance
    return Adjusted(state[:, 0], state[:, 1], whole, centre_s)


def with_prior(adjusted: Adjusted, spread: float) -> Adjusted:
    """Apply a prior of standard deviation `spread`, without unit, about zero to all drifts.

    The covariance of the drifts in `adjusted` must be finite.
    """
    drifts = np.arange(3, len(adjusted.covariance), 2)
    gain = adjusted.covariance[:, drifts] @ np.linalg.inv(
        adjusted.covariance[np.ix_(drifts, drifts)] + spread**2 * np.eye(len(drifts))
    )
    state = np.column_stack([adjusted.offset_s, adjusted.drift]).ravel()
    state = (state - gain @ state[drifts]).reshape(-1, 2)
    covariance = adjusted.covariance - gain @ adjusted.covariance[drifts]
    return Adjusted(state[:, 0], state[:, 1], covariance, adjusted.centre_s)


def _own(state: NDArray, lever: NDArray, time_s: NDArray) -> NDArray:
    return time_s + state @ lever.T


def _normal(pairs, lever, free) -> tuple[NDArray, ...]:
    """Return slopes (T, K), curvatures and steepnesses (T, K, K) by the free parameters."""
    size = free.max(initial=0) + 2
    slopes = np.zeros((len(lever), size))
    seconds = np.zeros((2, len(lever), size, size))
    for (a, b), (slope, *parts) in pairs.items():
        at = [2 * a, 2 * a + 1, 2 * b, 2 * b + 1]
        derivative = np.column_stack([-lever, lever])
        slopes[:, at] += slope[:, None] * derivative
        square = derivative[:, :, None] * derivative[:, None, :]
        for total, part in zip(seconds, parts, strict=True):
            total[np.ix_(range(len(lever)), at, at)] += part[:, None, None] * square
    return slopes[:, free], *seconds[:, :, free][..., free]


def _step(slope: NDArray, curvature: NDArray, steepness: NDArray) -> NDArray:
    """Return Newton's step if the curvature is positive enough, else the Gauss-Newton step."""
    if not len(slope):
        return slope
    scale = np.sqrt(np.maximum(np.diag(steepness), 1e-300))
    newton, gauss = (matrix / np.outer(scale, scale) for matrix in (curvature, steepness))
    fit = np.linalg.eigvalsh(newton).min() > 0.1 * np.linalg.eigvalsh(gauss).min()
    return -(np.linalg.pinv(newton if fit else gauss, hermitian=True) @ (slope / scale)) / scale


def _covariance(slopes: NDArray, curvature: NDArray, steepness: NDArray, step_s: float) -> NDArray:
    """Return the covariance (K, K) by leaving out blocks of time; infinite without curvature.

    Blocks are of times with evidence: leaving out others moves nothing. Parameters with less of it
    than two of the shortest blocks are infinitely uncertain too.
    """
    live = np.trace(steepness, axis1=1, axis2=2) > 0
    slopes, curvature, steepness = slopes[live], curvature[live], steepness[live]
    scale = np.sqrt(np.maximum(np.diag(steepness.sum(axis=0)), 1e-300))
    slopes, curvature = slopes / scale, curvature / np.outer(scale, scale)
    size, few = len(scale), _seen(steepness) < 2 * SHORTEST_S / step_s
    if few.all() or np.linalg.eigvalsh(curvature.sum(axis=0)).min() <= SMALLEST_CURVATURE:
        return np.diag(np.full(size, np.inf))
    usual = min(MEMORY_S / step_s, len(slopes) / FEWEST_BLOCKS)
    length = max(2, int(max(usual, SHORTEST_S / step_s)))
    found = np.zeros((size, size))
    for first in range(0, length, max(1, length // PARTITIONS)):
        cuts = np.unique(np.r_[0, np.arange(first, len(slopes) - length // 2, length)])
        moves = _moves(np.add.reduceat(slopes, cuts), np.add.reduceat(curvature, cuts))
        found += moves.T @ moves * (len(cuts) - 1) / len(cuts)
    found /= len(range(0, length, max(1, length // PARTITIONS)))
    found *= student(EQUAL * (len(slopes) / length - 1)) ** 2 / np.outer(scale, scale)
    found[few | few[:, None]] = 0.0
    found[few, few] = np.inf
    return found


def _seen(steepness: NDArray) -> NDArray:
    """Return the number of times (K,) at which there is evidence of each parameter."""
    return (np.diagonal(steepness, axis1=1, axis2=2) > 0).sum(axis=0)


def _moves(slopes: NDArray, curvature: NDArray) -> NDArray:
    """Return how the parameters move (B, K) as each block is left out."""
    rest = curvature.sum(axis=0) - curvature
    held = np.linalg.eigvalsh(rest).min(axis=1) > SMALLEST_CURVATURE
    rest = np.where(held[:, None, None], rest, curvature.sum(axis=0))
    return np.linalg.solve(rest, slopes[..., None])[..., 0]


def student(freedom: float) -> float:
    """Return the ratio of Student's interval to the normal one."""
    tail = (1 + COVERAGE) / 2
    return float(scipy.special.stdtrit(freedom, tail) / scipy.special.ndtri(tail))
