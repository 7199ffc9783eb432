"""Fill short gaps in 3D keypoints, leave out uncertain frames, filter series without delay.

Nothing is changed in place.
"""

from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D

# Of known frames beside a gap: of those next to it, and of those beyond, whose mean places count;
# below 40 Hz it is one frame each. Chosen on true joints of the development bodies with noise of
# 0 to 10 mm: 50 to 240 Hz, gaps of 0.1 and 0.2 s.
NEXT_S, BEYOND_S = 0.02, 0.05
UNCERTAIN_TIMES = 4.0  # ASSUME: times the usual standard deviation
PAD_PERIODS = 1.0  # ASSUME: mirrored padding at both ends, in periods of the cut-off


def fill_gaps(points: Keypoints3D, max_gap_s: float) -> Keypoints3D:
    """Interpolate gaps of at most `max_gap_s`, cubically; longer ones and those at the ends stay.

    `points` has uniform times. Filled values have reason INTERPOLATED and no covariance. They are
    on a cubic Hermite spline (Fritsch & Butland 1984, as scipy's PCHIP), which does not overshoot,
    through two places on either side, the means of the known frames within `NEXT_S` and of those of
    `BEYOND_S` after them: the slope between single frames is mostly noise at high frame rates.
    """
    xyz, reason = points.xyz.copy(), points.reason.copy()
    rate_hz = points.rate_hz if len(points.time_s) > 1 else 0.0
    most, *some = (int(np.floor(s * rate_hz + 1e-6)) for s in (max_gap_s, NEXT_S, BEYOND_S))
    near, far = (max(number, 1) for number in some)
    for person, joint in np.ndindex(xyz.shape[0], xyz.shape[2]):
        line = xyz[person, :, joint]
        known = np.isfinite(line).all(axis=1)
        holes = _short_gaps(~known, most)
        for start, stop in runs(holes):
            spline = _across(points.time_s, line, np.flatnonzero(known), start, near, far)
            line[start:stop] = spline(points.time_s[start:stop])
        reason[person, holes, joint] = missing_reason.INTERPOLATED
    return replace(points, xyz=xyz, reason=reason)


def _across(
    time_s: NDArray, line: NDArray, known: NDArray, start: int, near: int, far: int
) -> "scipy.interpolate.PchipInterpolator":
    """Return a spline across the gap from `start` on, through means of near and far frames.

    `known` are the indices of the known frames of the line (T, 3), on both sides. `near` and `far`
    are how many of them count on each.
    """
    after = int(np.searchsorted(known, start))
    edges = np.array([-near - far, -near, 0, near, near + far]) + after
    parts = [known[first:last] for first, last in pairwise(np.maximum(edges, 0))]
    parts = [part for part in parts if len(part)]
    places = [line[part].mean(axis=0) for part in parts]
    return scipy.interpolate.PchipInterpolator([time_s[part].mean() for part in parts], places)


def leave_out_uncertain(points: Keypoints3D) -> Keypoints3D:
    """Leave out frames that are far more uncertain than the rest of the take.

    For each joint, its stated standard deviation over its own median in the take; a frame is left
    out (reason UNCERTAIN) where the median of this ratio over the joints exceeds
    `UNCERTAIN_TIMES`. This happens where few cameras see a person, and from nearly one side.
    """
    sigma = np.sqrt(np.trace(points.covariance_2d, axis1=-2, axis2=-1))
    stated = np.ma.masked_invalid(sigma)
    ratio = np.ma.median(stated / np.ma.median(stated, axis=1, keepdims=True), axis=2)
    dropped = (ratio.filled(0.0) > UNCERTAIN_TIMES)[..., None] & np.isfinite(points.xyz[..., 0])
    return points.without(dropped)


def _short_gaps(missing: NDArray, most: int) -> NDArray:
    """Return (T,) bool: missing frames in runs of at most `most`, not touching an end."""
    chosen = np.zeros_like(missing)
    for start, stop in runs(missing):
        if stop - start <= most and start > 0 and stop < len(missing):
            chosen[start:stop] = True
    return chosen


def runs(flags: NDArray) -> list[tuple[int, int]]:
    """Return the (start, stop) of every run of True in (T,) bool, in order."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int8), [0]])))
    return list(zip(edges[::2], edges[1::2], strict=True))


def corrected_cutoff(cutoff_hz: float, rate_hz: float, order: int) -> float:
    """Return the cut-off of one pass of this order so that two passes have -3 dB at `cutoff_hz`.

    Filtering forwards and backwards squares the gain, which would lower the -3 dB frequency. The
    correction (sqrt 2 - 1)^(-1 / (2 order)) acts on the tangent of the digital frequency (Winter
    2009, sec. 2.2.4.4; Robertson & Dowling 2003).
    """
    warped = np.tan(np.pi * cutoff_hz / rate_hz)
    corrected = warped / (np.sqrt(2) - 1) ** (1 / (2 * order))
    return float(np.arctan(corrected) * rate_hz / np.pi)


@lru_cache(maxsize=64)  # all joints of a group have the same; designing it takes as long as its use
def _one_pass(cutoff_hz: float, rate_hz: float, order: int) -> NDArray:
    """Return the second-order sections of one pass of `zero_lag`."""
    one_pass_hz = corrected_cutoff(cutoff_hz, rate_hz, order)
    return scipy.signal.butter(order, one_pass_hz, fs=rate_hz, output="sos")


def zero_lag_points(xyz: NDArray, rate_hz: float, cutoff_hz: float, order: int) -> NDArray:
    """Apply `zero_lag` to points (T, n, 3), those that are known in the same frames at once."""
    known = np.isfinite(xyz).all(axis=2)
    _, alike = np.unique(known, axis=1, return_inverse=True)
    filtered = np.empty(xyz.shape)
    for at in range(alike.max() + 1 if alike.size else 0):
        lines = xyz[:, alike == at].reshape(len(xyz), -1)
        done = zero_lag(lines, rate_hz, cutoff_hz, order)
        filtered[:, alike == at] = done.reshape(len(xyz), -1, 3)
    return filtered


def zero_lag(lines: NDArray, rate_hz: float, cutoff_hz: float, order: int) -> NDArray:
    """Filter series (T, n) forwards and backwards, each run of known frames by itself.

    A frame is known where all its values are finite; the others become NaN. Runs of one or two
    frames stay as they are. `cutoff_hz` is the -3 dB frequency of the whole filter, `order` its
    effective order: twice that of each pass. Each end of a run is extended by its odd reflection
    over one period of the cut-off.
    """
    filtered = np.full(np.shape(lines), np.nan)
    for start, stop in runs(np.isfinite(lines).all(axis=1)):
        run = filtered[start:stop] = lines[start:stop]
        if stop - start > 2:
            sections = _one_pass(float(cutoff_hz), float(rate_hz), order // 2)
            pad = min(round(PAD_PERIODS * rate_hz / cutoff_hz), len(run) - 1)
            filtered[start:stop] = scipy.signal.sosfiltfilt(
                sections, run, axis=0, padtype="odd", padlen=pad
            )
    return filtered
