"""Interpolation of samples in time: linear, and the cubic's deviation from the line."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

EXACT = 1e-9  # relative: the median interval of unrounded times is nearer to their mean than this


def frame_step_s(time_s: NDArray) -> float:
    """Return the time between two frames, s; of a single frame 1.

    `time_s` (T,) increase; some frames may be missing. Containers such as Matroska round times to
    milliseconds: the median interval at 60 Hz is then 17 ms, the mean interval is right.
    """
    apart = np.diff(time_s)
    if not len(apart):
        return 1.0
    usual = np.median(apart)
    mean = apart.sum() / np.rint(apart / usual).clip(1).sum()
    return float(usual if abs(mean - usual) <= EXACT * usual else mean)


def window(seconds: float, rate_hz: float) -> int:
    """Return the frames of a time, halves rounded up: the last digits of times decide nothing."""
    return int(np.floor(seconds * rate_hz + 0.5 + 1e-3))


def shares(time_s: NDArray, wanted_s: NDArray) -> tuple[NDArray, NDArray]:
    """Return the sample before each wanted time (N,) and the share of the way to the next (N,).

    `time_s` holds two or more increasing times; times outside take the nearest sample.
    """
    wanted_s = np.clip(wanted_s, time_s[0], time_s[-1])
    before = np.clip(np.searchsorted(time_s, wanted_s, side="right") - 1, 0, len(time_s) - 2)
    return before, (wanted_s - time_s[before]) / (time_s[before + 1] - time_s[before])


def linear(time_s: NDArray, values: NDArray, wanted_s: NDArray) -> NDArray:
    """Interpolate values (T, ...) at times (N,); times outside the samples take the nearest one."""
    before, share = shares(time_s, wanted_s)
    share = share.reshape((-1,) + (1,) * (values.ndim - 1))
    return values[before] * (1 - share) + values[before + 1] * share


def nearest(
    time_s: NDArray, wanted_s: NDArray, equal: Literal["left", "right"] = "right"
) -> NDArray:
    """Return the index of the sample nearest to each wanted time.

    Of two samples that are `equal`ly near, the "right" one, which is later, or the "left" one.
    """
    return np.searchsorted((time_s[:-1] + time_s[1:]) / 2, wanted_s, equal)


def cubic_bend(
    first: NDArray, before: NDArray, after: NDArray, last: NDArray, share: NDArray
) -> NDArray:
    """Return what the cubic of Catmull & Rom (1974) adds to the line from `before` to `after`.

    The four samples are taken as evenly spaced; `share` is that of the way from `before`.
    """
    bend = (share - 1) * (first - 2 * before + after) - share * (before - 2 * after + last)
    return share * (1 - share) / 2 * bend


def between(time_s: NDArray, values: NDArray, wanted_s: NDArray, longest_s: float) -> NDArray:
    """Interpolate values (T, J, 3) at other times (U,) between neighbouring samples, (U, J, 3).

    NaN outside the span, beside a missing value, and in gaps longer than `longest_s`. A cubic
    through two samples before and two after (Catmull & Rom 1974), assumed to be evenly spaced; a
    straight line if one of the outer samples is missing.
    """
    wanted_s = np.asarray(wanted_s, float)
    right = np.clip(np.searchsorted(time_s, wanted_s), 1, len(time_s) - 1)
    span = time_s[right] - time_s[right - 1]
    share = (wanted_s - time_s[right - 1]) / span
    # A time that is a sample's own needs no neighbour.
    own = np.abs(share - np.rint(share)) < 1e-9
    share = np.where(own, np.rint(share), share)
    known = (share >= 0) & (share <= 1) & (own | (span <= longest_s))
    share = np.where(known, share, np.nan)[:, None, None]
    before, after = values[right - 1], values[right]
    first, last = values[np.maximum(right - 2, 0)], values[np.minimum(right + 1, len(values) - 1)]
    bend = cubic_bend(first, before, after, last, share)
    whole = (right > 1) & (right < len(values) - 1)
    usable = whole[:, None, None] & np.isfinite(bend).all(axis=-1, keepdims=True)
    mixed = before * (1 - share) + after * share + np.where(usable, bend, 0.0)
    return np.where(share == 0, before, np.where(share == 1, after, mixed))
