"""Offsets and drifts of all clocks together, from what every pair of cameras says at every moment."""

from dataclasses import dataclass

import numpy as np
from scipy import stats

STEPS = 12
SMALLEST_S = 1e-5  # the adjustment ends with a smaller step
LARGEST_S = 0.05  # no step is larger
COVERAGE = 0.90
MEMORY_S = 1.5  # ASSUME: what two spans of this length say of the clocks is nearly independent
FEWEST_BLOCKS = 8  # but a take is cut into so many at least
PARTITIONS = 3  # ways to cut, averaged
EQUAL = 0.6  # so many blocks count: fast motion, and with it what is known, comes in bursts
SMALLEST_CURVATURE = 1e-3


@dataclass(frozen=True, eq=False)
class Adjusted:
    """Clocks as `own = t + offset + drift * (t - centre_s)`.

    Attributes
    ----------
    offset_s, drift : (C,) float
        At `centre_s` of the reference clock; the drift without unit.
    covariance : (2 C, 2 C) float
        Of offset 0, drift 0, offset 1, ...; zero for what was not sought, infinite where nothing holds it.
    centre_s : float
    """

    offset_s: np.ndarray
    drift: np.ndarray
    covariance: np.ndarray
    centre_s: float

    def own(self, camera, time_s):
        """Return what a camera's clock shows at times of the reference clock."""
        return time_s + self.offset_s[camera] + self.drift[camera] * (time_s - self.centre_s)


def adjust(terms, offset_s, time_s, unknowns):
    """Find the offsets and drifts that minimise the loss of all pairs.

    Parameters
    ----------
    terms : callable
        `terms(own)`, with `own` (C, T) what each clock shows, returns a dict of pairs (a, b) to
        `(slope, curvature, steepness)`, (T,) each: first derivative, second derivative and the part of
        the second one that is never negative, of the pair's loss by the offset of b against a.
    offset_s : (C,) float
        Where to start; camera 0 stays.
    time_s : (T,) float
        Times of the reference clock.
    unknowns : (C,) int
        2 where offset and drift are to be found, 1 where the drift is zero, 0 for a clock that stays.

    Returns
    -------
    adjusted : Adjusted

    Notes
    -----
    Newton's method. The covariance is that of the jackknife over blocks of time (MacKinnon & White 1985):
    it holds whatever the noise of neighbouring frames and of pairs with a camera in common has in
    common. It is widened as Student's t for the number of blocks.
    """
    centre_s = float(time_s.mean())
    free = _free(unknowns)
    state = np.column_stack([offset_s, np.zeros(len(offset_s))]).astype(float)
    lever = np.column_stack([np.ones_like(time_s), time_s - centre_s])
    for _ in range(STEPS):
        slope, curvature, steepness = _normal(terms(_own(state, lever, time_s)), lever, free)
        step = np.zeros(state.size)
        step[free] = _step(slope.sum(axis=0), curvature.sum(axis=0), steepness.sum(axis=0))
        step = step.reshape(state.shape)
        largest = np.abs(step @ lever[[0, -1]].T).max(initial=0.0)
        state += step * min(1.0, LARGEST_S / max(largest, 1e-300))
        if largest < SMALLEST_S:
            break
    slope, curvature, steepness = _normal(terms(_own(state, lever, time_s)), lever, free)
    covariance = _covariance(slope, curvature, steepness, MEMORY_S / (time_s[1] - time_s[0]))
    whole = np.zeros((state.size, state.size))
    whole[np.ix_(free, free)] = covariance
    return Adjusted(state[:, 0], state[:, 1], whole, centre_s)


def with_prior(adjusted, spread):
    """Return clocks that also obey what is known of drifts before any recording.

    Parameters
    ----------
    adjusted : Adjusted
        With a finite covariance.
    spread : float
        Standard deviation of a camera's drift about zero, without unit.
    """
    drifts = np.arange(3, len(adjusted.covariance), 2)
    gain = adjusted.covariance[:, drifts] @ np.linalg.inv(
        adjusted.covariance[np.ix_(drifts, drifts)] + spread**2 * np.eye(len(drifts))
    )
    state = np.column_stack([adjusted.offset_s, adjusted.drift]).ravel()
    state = (state - gain @ state[drifts]).reshape(-1, 2)
    covariance = adjusted.covariance - gain @ adjusted.covariance[drifts]
    return Adjusted(state[:, 0], state[:, 1], covariance, adjusted.centre_s)


def _free(unknowns):
    """Return the places of the parameters to find among offset 0, drift 0, offset 1, ..."""
    return np.array(
        [2 * c + k for c, count in enumerate(unknowns) for k in range(count)], dtype=int
    )


def _own(state, lever, time_s):
    return time_s + state @ lever.T


def _normal(pairs, lever, free):
    """Return slopes (T, K), curvatures and steepnesses (T, K, K) of every moment, by the free parameters."""
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


def _step(slope, curvature, steepness):
    """Return Newton's step where the curvature is fit for it, else the surer one of Gauss and Newton."""
    if not len(slope):
        return slope
    scale = np.sqrt(np.maximum(np.diag(steepness), 1e-300))
    newton, gauss = (matrix / np.outer(scale, scale) for matrix in (curvature, steepness))
    fit = np.linalg.eigvalsh(newton).min() > 0.1 * np.linalg.eigvalsh(gauss).min()
    return -(np.linalg.pinv(newton if fit else gauss, hermitian=True) @ (slope / scale)) / scale


def _covariance(slopes, curvature, steepness, memory):
    """Return the covariance (K, K) by leaving out blocks of time; infinite without enough curvature."""
    scale = np.sqrt(np.maximum(np.diag(steepness.sum(axis=0)), 1e-300))
    slopes, curvature = slopes / scale, curvature / np.outer(scale, scale)
    size = len(scale)
    if not size or np.linalg.eigvalsh(curvature.sum(axis=0)).min() <= SMALLEST_CURVATURE:
        return np.diag(np.full(size, np.inf))
    length = max(2, int(min(memory, len(slopes) / FEWEST_BLOCKS)))
    found = np.zeros((size, size))
    for first in range(0, length, max(1, length // PARTITIONS)):
        cuts = np.unique(np.r_[0, np.arange(first, len(slopes) - length // 2, length)])
        moves = _moves(np.add.reduceat(slopes, cuts), np.add.reduceat(curvature, cuts))
        found += moves.T @ moves * (len(cuts) - 1) / len(cuts)
    found /= len(range(0, length, max(1, length // PARTITIONS)))
    return found / np.outer(scale, scale) * student(EQUAL * (len(slopes) / length - 1)) ** 2


def _moves(slopes, curvature):
    """Return how the parameters move (B, K) as each block is left out."""
    rest = curvature.sum(axis=0) - curvature
    held = np.linalg.eigvalsh(rest).min(axis=1) > SMALLEST_CURVATURE
    rest = np.where(held[:, None, None], rest, curvature.sum(axis=0))
    return np.linalg.solve(rest, slopes[..., None])[..., 0]


def student(freedom):
    """Return by what factor Student's interval is wider than the normal one."""
    tail = (1 + COVERAGE) / 2
    return float(stats.t.ppf(tail, freedom) / stats.norm.ppf(tail))
