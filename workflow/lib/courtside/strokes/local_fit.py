"""Local quadratic fits of a path: place, velocity, acceleration, robust to lost and wrong frames.

Locally weighted regression with bisquare weights (Cleveland 1979).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

ROUNDS = 2  # of new weights
FEWEST = 4  # frames of a fit: one more than it has parameters
CUT = 6.0  # median distances from the fit at which a frame loses all weight
LEAST_M = 0.003  # ASSUME: least median distance, so that a smooth path keeps all frames


@dataclass(frozen=True, eq=False)
class Fit:
    """A path at each frame: metres and seconds; NaN where too few frames are known."""

    place: NDArray  # (T, n)
    velocity: NDArray  # (T, n)
    acceleration: NDArray  # (T, n)
    velocity_sigma: NDArray  # (T,): of each axis, from the residuals

    @property
    def speed(self) -> NDArray:
        """The speed (T,)."""
        return np.linalg.norm(self.velocity, axis=1)


def half_width(rate_hz: float, half_s: float) -> int:
    """Return how many frames a fit uses on each side."""
    return max(round(half_s * rate_hz), 2)


def fit(path: NDArray, rate_hz: float, half_s: float) -> Fit:
    """Fit a parabola to the frames within `half_s` of each frame of a path (T, n)."""
    if len(path) < FEWEST:
        nothing = np.full(path.shape, np.nan)
        return Fit(nothing, nothing, nothing, nothing[:, 0])
    half = half_width(rate_hz, half_s)
    lags = np.arange(-half, half + 1) / rate_hz
    rows = np.stack([np.ones_like(lags), lags, lags**2 / 2], axis=1)
    padded = np.pad(path, ((half, half), (0, 0)), constant_values=np.nan)
    near = np.lib.stride_tricks.sliding_window_view(padded, len(lags), axis=0).swapaxes(1, 2)
    known = np.isfinite(near).all(axis=2)
    near = np.where(known[..., None], near, 0.0)
    nearness = known * (1 - (np.abs(lags) / (lags[-1] + 1 / rate_hz)) ** 3) ** 3
    weights = nearness
    for _ in range(ROUNDS + 1):
        weighted = weights[:, :, None] * rows
        inverse = np.linalg.inv(rows.T @ weighted + 1e-12 * np.eye(3))
        found = inverse @ (weighted.swapaxes(1, 2) @ near)
        off = np.linalg.norm(near - rows @ found, axis=2)
        median = np.ma.median(np.ma.masked_array(off, ~known), axis=1).filled(0.0)
        scale = np.maximum(median, LEAST_M)[:, None]
        weights = nearness * np.clip(1 - (off / (CUT * scale)) ** 2, 0, 1) ** 2
    variance = (weights * off**2).sum(axis=1) / np.maximum(weights.sum(axis=1), 1e-9)
    spread = np.einsum("tij,kj,tk->tik", inverse, rows, weights)[:, 1]
    sigma = np.sqrt(variance / path.shape[1] * (spread**2).sum(axis=1))
    found[known.sum(axis=1) < FEWEST] = np.nan
    return Fit(
        found[:, 0], found[:, 1], found[:, 2], np.where(np.isnan(found[:, 0, 0]), np.nan, sigma)
    )
