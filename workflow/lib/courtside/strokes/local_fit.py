"""Local quadratic fits of a path: place, velocity, acceleration, robust to lost and wrong frames.

Locally weighted regression with bisquare weights (Cleveland 1979).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.geometry.interpolation import window

ROUNDS = 2  # of new weights
FEWEST = 4  # frames of a fit: one more than it has parameters
SIDE, SIDE_SHARE = 2, 1 / 3  # ASSUME: known frames on each side of a sure speed, and their share
CUT = 6.0  # median distances from the fit at which a frame loses all weight
LEAST_M = 0.003  # ASSUME: least median distance, so that a smooth path keeps all frames


@dataclass(frozen=True, eq=False)
class Fit:
    """A path at each frame: metres and seconds; NaN where too few frames are known.

    So are missing frames with known ones on one side only: a parabola would be a guess there.
    """

    place: NDArray  # (T, n)
    velocity: NDArray  # (T, n)
    acceleration: NDArray  # (T, n)
    velocity_sigma: NDArray  # (T,): of each axis, from the residuals
    inside: NDArray  # (T,) bool: enough frames are known on both sides

    @property
    def speed(self) -> NDArray:
        """The speed (T,)."""
        return np.linalg.norm(self.velocity, axis=1)

    @property
    def sure_speed(self) -> NDArray:
        """The speed (T,); NaN at the edges of gaps, where noise may make it many times the truth.

        That is what shows movement; a smallest speed may also lie at an edge.
        """
        return np.where(self.inside, self.speed, np.nan)


def half_width(rate_hz: float, half_s: float) -> int:
    """Return how many frames a fit uses on each side."""
    return max(window(half_s, rate_hz), 2)


def fit(path: NDArray, rate_hz: float, half_s: float) -> Fit:
    """Fit a parabola to the frames within `half_s` of each frame of a path (T, n)."""
    if len(path) < FEWEST:
        nothing = np.full(path.shape, np.nan)
        return Fit(nothing, nothing, nothing, nothing[:, 0], np.zeros(len(path), bool))
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
    side = _least_of_sides(known[:, half], half)
    found[(known.sum(axis=1) < FEWEST) | ~known[:, half] & (side == 0)] = np.nan
    sigma[np.isnan(found[:, 0, 0])] = np.nan
    return Fit(found[:, 0], found[:, 1], found[:, 2], sigma, side >= max(SIDE, SIDE_SHARE * half))


def _least_of_sides(known: NDArray, half: int) -> NDArray:
    """Return how many frames (T,) of a fit are known before or after each frame, the fewer.

    A take that begins or ends with a known frame has no gap there.
    """
    padded = np.pad(known, half, mode="edge")
    near = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1)
    return np.minimum(near[:, :half].sum(axis=1), near[:, half + 1 :].sum(axis=1))
