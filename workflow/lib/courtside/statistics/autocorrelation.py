"""Shares and means of values that are correlated in time, with their uncertainty."""

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

LEVEL = 0.95  # of intervals, as is usual
MOST_CORRELATED = 0.95  # beyond this a series is too short to tell from a drift


def frames_per_trial(hits: ArrayLike) -> float:
    """Return how many frames in a row, of (T,) bool, count as one independent trial.

    1 + 2 * the sum of the autocorrelations up to the first pair of lags whose sum is not positive,
    at least 1 and at most T; 1 where all frames are alike, which shows no correlation.

    Geyer 1992, initial positive sequence.
    """
    hits = np.asarray(hits, dtype=float)
    centred = hits - hits.mean()
    if len(hits) < 4 or not centred.any():
        return 1.0
    full = np.correlate(centred, centred, mode="full")[len(hits) - 1 :]
    correlation = full / full[0]
    pairs = correlation[: len(hits) // 2 * 2].reshape(-1, 2).sum(axis=1)
    last = int(np.argmax(pairs <= 0)) if (pairs <= 0).any() else len(pairs)
    return float(np.clip(2 * pairs[:last].sum() - 1, 1, len(hits)))


def interval(share: float, n_effective: float) -> tuple[float, float]:
    """Return Wilson's interval of a share (0 to 1) of so many independent trials.

    Wilson 1927, J. Am. Stat. Assoc. 22, 209. It holds near 0 and 1 as well, where the normal
    interval has no width.
    """
    if not n_effective > 0:
        return 0.0, 1.0
    z = scipy.special.ndtri((1 + LEVEL) / 2)
    middle = share + z**2 / (2 * n_effective)
    half = z * np.sqrt(share * (1 - share) / n_effective + z**2 / (4 * n_effective**2))
    scale = 1 + z**2 / n_effective
    # Rounding must not put a share of 0 or 1 outside its own interval.
    low, high = min(share, (middle - half) / scale), max(share, (middle + half) / scale)
    return max(0.0, low), min(1.0, high)


def share(hits: ArrayLike, least_frames: float = 1.0) -> dict[str, float]:
    """Return n_frames, n_effective, share, low and high of a share of frames (T,) bool.

    At least `least_frames` in a row count as one trial: the duration of a pose, for hits so alike
    that their correlation cannot be seen.
    """
    hits = np.asarray(hits, dtype=bool)
    count = len(hits)
    if not count:
        return {"n_frames": 0, "n_effective": 0.0, "share": np.nan, "low": 0.0, "high": 1.0}
    effective = count / min(max(frames_per_trial(hits), least_frames), count)
    low, high = interval(hits.mean(), effective)
    found = {"n_frames": count, "n_effective": effective, "share": hits.mean()}
    return {**found, "low": low, "high": high}


def covariance_of_sum(series: NDArray) -> NDArray:
    """Return the long-run covariance (K, K) of the sum of a series (T, K) with mean zero.

    Bartlett's kernel with the automatic width of Andrews (1991), after prewhitening of each column
    by an autoregression of order 1 (Andrews & Monahan 1992). Rather too large than too small.
    """
    count = len(series)
    if count < 3:
        return series.T @ series
    rho = _lag_1(series)
    white = series[1:] - rho * series[:-1]
    width = _width(white)
    weights = 1 - np.arange(1, min(int(width) + 1, count - 2)) / (width + 1)
    colour = 1 / (1 - rho)
    return _weighted(white, weights) * np.outer(colour, colour) * count / (count - 1)


def _lag_1(series: NDArray) -> NDArray:
    """Return the autocorrelation (K,) of each column at lag 1, limited."""
    own = (series**2).sum(axis=0)
    rho = (series[1:] * series[:-1]).sum(axis=0) / np.where(own > 0, own, 1.0)
    return np.clip(rho, -MOST_CORRELATED, MOST_CORRELATED)


def _weighted(series: NDArray, weights: NDArray) -> NDArray:
    total = series.T @ series
    for lag, weight in enumerate(weights, start=1):
        product = series[lag:].T @ series[:-lag] * weight
        total += product + product.T
    return total


def _width(white: NDArray) -> float:
    rho = _lag_1(white)
    strength = np.max(4 * rho**2 / ((1 - rho) ** 2 * (1 + rho) ** 2))
    return 1.1447 * (strength * len(white)) ** (1 / 3)


def distinct(difference: NDArray) -> float:
    """Return by how many of its standard deviations the mean of a series (T,) exceeds zero.

    0 for fewer than 3 values.
    """
    if len(difference) < 3:
        return 0.0
    mean = difference.mean()
    spread = np.sqrt(covariance_of_sum((difference - mean)[:, None])[0, 0]) / len(difference)
    return float(mean / spread) if spread > 0 else 0.0
