"""Interpolation of samples in time: linear, and the cubic's deviation from the line."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray


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
    """Return the index of the sample nearest to each wanted time, the later of two equally near.

    With `equal` "left" the earlier of two equally near.
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
