"""Linear interpolation of samples in time."""

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
