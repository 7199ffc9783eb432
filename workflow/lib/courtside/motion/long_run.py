"""How uncertain the sum of a series is whose neighbours resemble one another."""

import numpy as np

MOST_CORRELATED = 0.95  # beyond this a series is too short to tell from a drift


def covariance_of_sum(series):
    """Return the covariance (K, K) of the sum of a series (T, K) with mean zero, whatever its memory.

    Parameters
    ----------
    series : (T, K) float

    Returns
    -------
    covariance : (K, K) float

    Notes
    -----
    Bartlett's kernel with the automatic width of Andrews (1991), after each column was whitened by an
    autoregression of order 1 (Andrews & Monahan 1992). Rather too large than too small.
    """
    count = len(series)
    if count < 3:
        return series.T @ series
    own = (series**2).sum(axis=0)
    rho = (series[1:] * series[:-1]).sum(axis=0) / np.where(own > 0, own, 1.0)
    rho = np.clip(rho, -MOST_CORRELATED, MOST_CORRELATED)
    white = series[1:] - rho * series[:-1]
    width = _width(white)
    weights = 1 - np.arange(1, min(int(width) + 1, count - 2)) / (width + 1)
    colour = 1 / (1 - rho)
    return _weighted(white, weights) * np.outer(colour, colour) * count / (count - 1)


def _weighted(series, weights):
    total = series.T @ series
    for lag, weight in enumerate(weights, start=1):
        product = series[lag:].T @ series[:-lag] * weight
        total += product + product.T
    return total


def _width(white):
    own = (white**2).sum(axis=0)
    rho = (white[1:] * white[:-1]).sum(axis=0) / np.where(own > 0, own, 1.0)
    rho = np.clip(rho, -MOST_CORRELATED, MOST_CORRELATED)
    strength = np.max(4 * rho**2 / ((1 - rho) ** 2 * (1 + rho) ** 2))
    return 1.1447 * (strength * len(white)) ** (1 / 3)


def distinct(difference):
    """Return by how many standard deviations the mean of a series (T,) lies above zero."""
    if len(difference) < 3:
        return 0.0
    mean = difference.mean()
    spread = np.sqrt(covariance_of_sum((difference - mean)[:, None])[0, 0]) / len(difference)
    return float(mean / spread) if spread > 0 else 0.0
