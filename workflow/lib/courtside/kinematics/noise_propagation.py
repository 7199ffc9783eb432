"""Keypoint noise that remains in filtered paths, speeds and accelerations.

The noise of a joint has the stated covariance. A share of it is white, new in every frame; the rest
is a first-order autoregressive process, whose correlation falls to 1/e within a memory time.

Throughout, `rate_hz` is the frame rate, `cutoff_hz` the -3 dB frequency and `order` the effective
order of the zero-lag filter, and `derivative` 0 for the path, 1 for the velocity, 2 for the
acceleration.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.kinematics import filtering

EDGE_PERIODS = 2.0  # of the cut-off: nearer to an end of a run, the ends change the filter
MEMORIES_S = np.geomspace(0.01, 2.0, 40)  # ASSUME: spans the memories of keypoint noise
# ASSUME: changes between these shares of half the frame rate, and faster ones, are noise.
BANDS = (0.45, 0.7)
SHARP = 8  # ASSUME: order of the filters that separate the bands
CLIP = 4.0  # ASSUME: standard deviations to which single changes are cut, for motion and outliers
SQUARES_PER_POINT = 3  # one per axis
CHI2_MEDIAN = 2.366  # of 3 degrees of freedom
MIN_FRAMES = 30  # ASSUME: fewer give no steady estimate
SERIES = 16  # differentiated at once: splines need ten times the memory of their values


@dataclass(frozen=True)
class Noise:
    """Noise of one point."""

    # Time in which the correlation of its slow part falls to 1/e; 0 if all of it is white.
    memory_s: float
    white: float = 0.0  # share of its variance that is white
    scale: float = 1.0  # its variance over the stated one


def differentiate(lines: NDArray, rate_hz: float) -> NDArray:
    """Return the time derivative of series (T, n), per second, by cubic splines.

    Each run of known frames by itself; NaN in runs of fewer than 3 frames.

    The splines' derivative is exact to 2 % up to a fifth of the frame rate and to 0.1 % up to a
    tenth, where central differences lose 24 and 6 %.
    """
    derivative = np.full(np.shape(lines), np.nan)
    for start, stop in filtering.runs(np.isfinite(lines).all(axis=1)):
        if stop - start > 2:
            time_s = np.arange(stop - start) / rate_hz
            for first in range(0, lines.shape[1], SERIES):
                some = slice(first, first + SERIES)
                spline = scipy.interpolate.CubicSpline(time_s, lines[start:stop, some])
                derivative[start:stop, some] = spline(time_s, 1)
    return derivative


@lru_cache(maxsize=256)
def _operator(
    n_frames: int, rate_hz: float, cutoff_hz: float, order: int, derivative: int
) -> NDArray:
    """Return (n, n): the filter, and the derivative after it, as a matrix on a run of n frames."""
    matrix = filtering.zero_lag(np.eye(n_frames), rate_hz, cutoff_hz, order)
    for _ in range(derivative):
        matrix = differentiate(matrix, rate_hz)
    return matrix


def _block(n_frames: int, rate_hz: float, cutoff_hz: float) -> int:
    """Return the length of a run whose ends do not affect its middle frame, at most `n_frames`."""
    if n_frames < 2:  # of a take of one frame no rate is known
        return n_frames
    return min(n_frames, 2 * int(np.ceil(EDGE_PERIODS * rate_hz / cutoff_hz)) + 1)


def correlation(n_frames: int, rate_hz: float, noise: Noise) -> NDArray:
    """Return the (n, n) correlation over time of noise."""
    if noise.memory_s <= 0:
        return np.eye(n_frames)
    lag_s = np.abs(np.subtract.outer(np.arange(n_frames), np.arange(n_frames))) / rate_hz
    slow = np.exp(-lag_s / noise.memory_s)
    return noise.white * np.eye(n_frames) + (1 - noise.white) * slow


@lru_cache(maxsize=1024)
def block_covariance(
    n_frames: int, rate_hz: float, cutoff_hz: float, order: int, noise: Noise, derivative: int
) -> NDArray:
    """Return the covariance (n, n) over time of filtered noise whose stated variance is 1.

    `n_frames` is the length of the run; n is at most four periods of the cut-off. Units:
    s^(-2 derivative).
    """
    n_block = _block(n_frames, rate_hz, cutoff_hz)
    matrix = _operator(n_block, rate_hz, cutoff_hz, order, derivative)
    return noise.scale * matrix @ correlation(n_block, rate_hz, noise) @ matrix.T


@lru_cache(maxsize=64)
def weights(rate_hz: float, cutoff_hz: float, order: int) -> NDArray:
    """Return the sizes of the filter's weights far from ends, an odd number, of sum 1."""
    matrix = _operator(_block(10**6, rate_hz, cutoff_hz), rate_hz, cutoff_hz, order, 0)
    found = np.abs(matrix[len(matrix) // 2])
    return found / found.sum()


def autocorrelation(
    n_lags: int, rate_hz: float, cutoff_hz: float, order: int, noise: Noise, derivative: int
) -> NDArray:
    """Return the correlation (n_lags,) of filtered noise 0, 1, ... frames apart, far from ends."""
    matrix = _operator(_block(10**6, rate_hz, cutoff_hz), rate_hz, cutoff_hz, order, derivative)
    kernel = matrix[len(matrix) // 2]
    raw = correlation(n_lags + len(kernel), rate_hz, noise)[0]
    spread = np.convolve(np.convolve(kernel, kernel[::-1]), np.concatenate([raw[:0:-1], raw]))
    middle = len(spread) // 2
    return spread[middle : middle + n_lags] / spread[middle]


def gains(
    n_frames: int, rate_hz: float, cutoff_hz: float, order: int, noise: Noise, derivative: int
) -> NDArray:
    """Return the variance (n_frames,) of filtered noise of stated variance 1, by frame of a run."""
    found = np.diag(block_covariance(n_frames, rate_hz, cutoff_hz, order, noise, derivative))
    middle = len(found) // 2
    return np.concatenate(
        [found[:middle], np.full(n_frames - len(found) + 1, found[middle]), found[middle + 1 :]]
    )


def filtered_covariance(
    covariance: NDArray,
    known: NDArray,
    noise: Noise,
    rate_hz: float,
    cutoff_hz: float,
    order: int,
    derivative: int = 0,
) -> NDArray:
    """Return the covariance (T, 3, 3) of a filtered path or of its derivative.

    `covariance` (T, 3, 3) is of the raw points, NaN where unknown; `known` (T,) says which frames
    have a value, measured or filled in. The result is NaN where no frame within the filter's reach
    has a covariance. In filled gaps it is that of the frames around them, which is too small.

    The raw covariance is averaged with the filter's squared weights, which is exact for white
    noise, and for any noise while the covariance changes slowly.
    """
    matrix = _operator(
        _block(len(known), rate_hz, cutoff_hz), rate_hz, cutoff_hz, order, derivative
    )
    kernel = matrix[len(matrix) // 2] ** 2
    kernel = np.append(kernel, 0.0) if len(kernel) % 2 == 0 else kernel
    has = np.isfinite(covariance).all(axis=(1, 2)) & known
    flat = np.where(has[:, None], covariance.reshape(len(known), 9), 0.0)
    both = np.column_stack([flat, has])
    summed = scipy.signal.oaconvolve(both, (kernel / kernel.sum())[:, None], mode="full", axes=0)
    summed = summed[len(kernel) // 2 :][: len(known)]
    share = np.where(summed[:, 9:] > 1e-6, summed[:, 9:], np.nan)
    mean = (summed[:, :9] / share).reshape(-1, 3, 3)
    gain = np.full(len(known), np.nan)
    for start, stop in filtering.runs(known):
        gain[start:stop] = gains(stop - start, rate_hz, cutoff_hz, order, noise, derivative)
    return mean * gain[:, None, None]


def summed_covariance(
    parts: Mapping[float, NDArray],
    known: NDArray,
    noise: Noise,
    rate_hz: float,
    order: int,
    derivative: int = 0,
) -> NDArray:
    """Return the covariance (T, 3, 3) of a sum of filtered paths, or of its derivative.

    `parts` maps each cut-off in Hz to the raw covariance (T, 3, 3) of all that is filtered at it;
    the noise of different parts is independent. The rest is as for `filtered_covariance`.
    """
    return np.sum(
        [
            filtered_covariance(part, known, noise, rate_hz, cutoff_hz, order, derivative)
            for cutoff_hz, part in parts.items()
        ],
        axis=0,
    )


@lru_cache(maxsize=64)
def _band_gains(rate_hz: float) -> tuple[NDArray, NDArray]:
    """Return the shares in both bands of white noise (2,) and of noise with each memory (M, 2)."""
    cutoffs_hz = [band * rate_hz / 2 for band in BANDS]
    n_block = _block(10**6, rate_hz, cutoffs_hz[0] / 2)
    low, high = (_operator(n_block, rate_hz, at, SHARP, 0)[n_block // 2] for at in cutoffs_hz)
    rows = (high - low, (np.arange(n_block) == n_block // 2) - high)
    slow = [
        [row @ correlation(n_block, rate_hz, Noise(float(memory))) @ row for row in rows]
        for memory in MEMORIES_S
    ]
    return np.array([row @ row for row in rows]), np.array(slow)


def estimate(xyz: NDArray, covariance: NDArray, rate_hz: float) -> Noise:
    """Estimate the noise from the part of a raw path (T, 3) that is too fast for motion.

    Short gaps are filled; `covariance` (T, 3, 3) is as stated for the raw points, NaN in filled
    frames. The result is white with a scale above 1 where there is more fast noise than the stated
    covariance can explain, and white of scale 1 where there are too few frames.

    The power in two bands, 0.45 to 0.7 of half the frame rate and above, fixes the white share and
    the memory of the rest, given the stated variance. The extrapolation to slower noise holds just
    below these bands, where it matters for speeds and path lengths: a variance stated too large
    leads to a memory that is too long, and both errors nearly cancel. Views that were interpolated
    to common times lost part of their fast noise: the memory is then too long. Motion in these
    bands, as at a hit, counts as noise; single changes are cut to 4 standard deviations.
    """
    power = _band_powers(xyz, covariance, rate_hz)
    if power is None:
        return Noise(0.0)
    white, slow = _band_gains(float(rate_hz))
    # One share for each memory, by least squares of the bands' ratios to what is found.
    a, b = (white - slow) / power, 1 - slow / power
    share = np.clip(np.sum(a * b, axis=1) / np.sum(a * a, axis=1), 0.0, 1.0)
    misfit = np.sum((share[:, None] * a - b) ** 2, axis=1)
    best = int(np.argmin(misfit))
    if share[best] >= 1.0:
        return Noise(0.0, scale=float(max(1.0, np.mean(power / white))))
    return Noise(float(MEMORIES_S[best]), float(share[best]))


def _band_powers(xyz: NDArray, covariance: NDArray, rate_hz: float) -> NDArray | None:
    """Return the mean variance in both bands over the stated one, or None with too few frames."""
    low, high = (filtering.zero_lag(xyz, rate_hz, band * rate_hz / 2, SHARP) for band in BANDS)
    known = np.isfinite(covariance).all(axis=(1, 2)) & np.isfinite(high).all(axis=1)
    if known.sum() < MIN_FRAMES:
        return None
    inverse = np.linalg.pinv(covariance[known], hermitian=True)
    powers = []
    for part in ((high - low)[known], (xyz - high)[known]):
        squares = np.einsum("ti,tij,tj->t", part, inverse, part)
        most = np.median(squares) / CHI2_MEDIAN * CLIP**2
        powers.append(np.minimum(squares, most).mean() / SQUARES_PER_POINT)
    return np.maximum(powers, 1e-12)
