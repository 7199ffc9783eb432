"""Smoothed tracks of one camera or device, with velocity and acceleration at any time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.geometry import interpolation

LONGEST_GAP = 3  # ASSUME: missing frames that are bridged, 0.1 s at 30 Hz
REACH = 3.0  # standard deviations at which the kernel is cut off: 0.3 % of its weight is beyond
LONGEST_STEP = 1.5  # in frames: further apart, a frame is missing
GLANCE = 0.5  # ASSUME: share of another camera's time from which a camera sees enough
ROUNDING = 1e-6  # of the time between two frames: times that differ by less are one


@dataclass(frozen=True, eq=False)
class Track:
    """Values (P, T, J, K) on uniform times, NaN where unknown.

    Times start at `start_s` on the camera's own clock; a step is half a frame.
    """

    start_s: float
    step_s: float
    values: NDArray


def build(time_s: NDArray, values: NDArray, sigma_s: float) -> Track:
    """Smooth tracks with a Gaussian.

    Frame times (T,) increase, perhaps with dropped frames; values (P, T, J, K) are NaN where
    missing; the standard deviation of the kernel is at least 0.8 frames: see below. The track has
    two values per frame. Up to `LONGEST_GAP` missing frames are bridged linearly; longer gaps stay
    NaN, with the kernel's reach about them.

    Both cameras of a pair need the same kernel: a symmetric filter shifts no event in time. Without
    it the noise of interpolated tracks would be lowest half-way between frames and bias every
    offset there; with it, and half-way values that are means of their own, the noise is even within
    1 %.
    """
    step_s = float(np.median(np.diff(time_s)))
    count = round((time_s[-1] - time_s[0]) / step_s) + 1
    uniform = time_s[0] + step_s * np.arange(count)
    values = _on_grid(time_s, values, uniform, step_s)
    smooth = np.empty((len(values), 2 * count - 1, *values.shape[2:]))
    smooth[:, ::2] = _smoothed(values, sigma_s / step_s, 0.0)
    smooth[:, 1::2] = _smoothed(values, sigma_s / step_s, 0.5)[:, :-1]
    return Track(float(time_s[0]), step_s / 2, smooth)


def _smoothed(values: NDArray, sigma: float, ahead: float) -> NDArray:
    """Return the Gaussian mean about the places `ahead` of each frame; all in frames."""
    reach = int(np.ceil(REACH * sigma))
    weight = np.exp(-0.5 * ((np.arange(-reach, reach + 1) - ahead) / sigma) ** 2)
    weight[weight < np.exp(-0.5 * REACH**2)] = 0.0
    weight /= weight.sum()
    return scipy.ndimage.correlate1d(values, weight, axis=1, mode="constant", cval=np.nan)


def _on_grid(time_s: NDArray, values: NDArray, uniform: NDArray, step_s: float) -> NDArray:
    """Interpolate linearly over missing values, except gaps longer than `LONGEST_GAP` frames."""
    persons, _, joints, parts = values.shape
    result = np.full((persons, len(uniform), joints, parts), np.nan)
    longest = (LONGEST_GAP + LONGEST_STEP) * step_s
    for person, joint in np.ndindex(persons, joints):
        known = np.isfinite(values[person, :, joint]).all(axis=-1)
        if known.sum() < 2:
            continue
        at = time_s[known]
        before, share = interpolation.shares(at, uniform)
        gap_s = at[before + 1] - at[before]
        inside = np.abs(uniform - np.clip(uniform, at[0], at[-1])) < ROUNDING * gap_s
        on_frame = np.abs(share - np.rint(share)) < ROUNDING
        bridged = inside & (on_frame | (gap_s <= longest))
        wanted_s = np.where(on_frame, at[before + np.rint(share).astype(int)], uniform)
        found = interpolation.linear(at, values[person, known, joint], wanted_s)
        result[person, :, joint] = np.where(bridged[:, None], found, np.nan)
    return result


def sample(track: Track, time_s: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Return value, velocity and acceleration (P, N, J, K) at times (N,) of the camera's own clock.

    They are per second and per second squared, NaN where one of the four values around is unknown.
    The interpolant is the cubic through the two values beside, with their central differences as
    slopes (Catmull & Rom 1974), whose slope is continuous.
    """
    place = (np.asarray(time_s) - track.start_s) / track.step_s
    left = np.floor(place).astype(int)
    share = place - left
    inside = (left >= 1) & (left <= track.values.shape[1] - 3)
    share = np.where(inside, share, np.nan)[:, None, None]
    last = track.values.shape[1] - 1
    p0, p1, p2, p3 = (track.values[:, np.clip(left + k, 0, last)] for k in (-1, 0, 1, 2))
    linear = (p2 - p0) / 2
    square = p0 - 2.5 * p1 + 2 * p2 - 0.5 * p3
    cube = 1.5 * (p1 - p2) + 0.5 * (p3 - p0)
    value = ((cube * share + square) * share + linear) * share + p1
    velocity = (3 * cube * share + 2 * square) * share + linear
    acceleration = 6 * cube * share + 2 * square
    return value, velocity / track.step_s, acceleration / track.step_s**2


def counterparts(
    first: Track, at: NDArray, second: Track, lags_s: NDArray
) -> tuple[NDArray, NDArray]:
    """Return which values of a second track belong to values `at` (N,) of the first.

    `lags_s`, (L,) or (N, L), are offsets of the second clock against the first. The indices (N, L)
    are of the nearest value; the second result (N, L) tells whether the track has it.
    """
    own_s = first.start_s + first.step_s * at[:, None] + lags_s
    index = np.rint((own_s - second.start_s) / second.step_s).astype(int)
    return index, (index >= 0) & (index < second.values.shape[1])


def compared(first: Track, second: Track, most: int) -> tuple[NDArray, bool]:
    """Return the values (N,) at which two tracks are compared, and whether they are the second's.

    They are about `most` of the first one. If one of the two shows somebody for less than `GLANCE`
    of the time of the other, they are within that time: few of the whole take would be.
    """
    count = first.values.shape[1]
    shown = [np.flatnonzero(np.isfinite(one.values).any(axis=(0, 2, 3))) for one in (first, second)]
    long_s = [len(at) * one.step_s for at, one in zip(shown, (first, second), strict=True)]
    if not 0 < min(long_s) < GLANCE * max(long_s):
        return np.arange(0, count, max(1, count // most)), False
    shorter = int(np.argmin(long_s))
    start, stop = shown[shorter][0], shown[shorter][-1] + 1
    return np.arange(start, stop, max(1, (stop - start) // most)), shorter == 1


def product_terms(first: Sequence[NDArray], second: Sequence[NDArray]) -> tuple[NDArray, ...]:
    """Return slope, curvature and steepness of minus the product, by the second's offset.

    `first` and `second` are value, velocity and acceleration of two signals, of any one shape. With
    equal values on both sides the curvature is that of the values' own slopes.
    """
    (value_a, slope_a, bend_a), (value_b, slope_b, bend_b) = first, second
    slope = -0.5 * (value_a * slope_b - slope_a * value_b)
    curvature = -0.25 * (value_a * bend_b - 2 * slope_a * slope_b + bend_a * value_b)
    return slope, curvature, 0.5 * (slope_a**2 + slope_b**2)
