"""Smooth functions of time: from rest to rest, a step, a bump, an arc, piecewise linear speed."""

from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

T = TypeVar("T", float, NDArray)
# ASSUME: share of a move's duration in which it accelerates, and in which it slows down.
RAMP = 0.35
GRAVITY_M_S2 = 9.81


def ease(x: T, ramp: T | float = RAMP) -> T:
    """Return the progress 0..1 of a move at a share of its duration, clipped to 0..1.

    The speed rises and falls by smooth steps over the ramp (a share up to 0.5) and is constant
    between. Its highest value is 1 / (1 - ramp); the acceleration is continuous.
    """
    x = _between(x, 0.0, 1.0)
    rise, fall = _between(x / ramp, 0, 1), _between((1 - x) / ramp, 0, 1)
    ramps = ramp * (_ramp_integral(rise) - _ramp_integral(fall) + 0.5)
    return (ramps + _between(x - ramp, 0, 1 - 2 * ramp)) / (1 - ramp)


def step(x: T) -> T:
    """Return the smooth step from 0 (x <= 0) to 1 (x >= 1); its first derivative is continuous."""
    x = _between(x, 0.0, 1.0)
    return x * x * (3 - 2 * x)


def bump(x: T) -> T:
    """Return a bump over 0..1 of height 1, 0 outside; its first derivative is continuous."""
    x = _between(x, 0.0, 1.0)
    return 16 * (x * (1 - x)) ** 2


def arc(x: T) -> T:
    """Return a parabola over 0..1 of height 1, 0 outside: what is thrown up lands as fast."""
    x = _between(x, 0.0, 1.0)
    return 4 * x * (1 - x)


def flight_m(lasts_s: T) -> T:
    """Return how high a body rises that is in the air for a time, s."""
    return GRAVITY_M_S2 * lasts_s**2 / 8


def _between(x: T, low: float, high: T | float) -> T:
    """Clip a number or an array; `np.clip` takes ten times as long on a few values."""
    return np.minimum(np.maximum(x, low), high)


def _ramp_integral(x: T) -> T:
    """Return the integral of the smooth step from 0 to x."""
    return x**3 - x**4 / 2


class Glide:
    """A value whose speed is linear between knots and 0 outside.

    Parameters
    ----------
    times_s : (n,) float
        Increasing.
    speeds : (n,) float
        Per second; the first and the last are 0.
    start : float
        The value before the first knot.
    """

    def __init__(self, times_s: ArrayLike, speeds: ArrayLike, start: float = 0.0) -> None:
        self.times_s, self.speeds = np.asarray(times_s, float), np.asarray(speeds, float)
        lasts = np.diff(self.times_s)
        if np.any(lasts <= 0) or self.speeds[0] != 0 or self.speeds[-1] != 0:
            raise ValueError("expected increasing times and rest at both ends")
        gains = lasts * (self.speeds[1:] + self.speeds[:-1]) / 2
        self.values = start + np.append(0.0, np.cumsum(gains))

    def at(self, time_s: float) -> float:
        """Return the value at a time, s."""
        time_s = np.clip(time_s, self.times_s[0], self.times_s[-1])
        i = min(int(np.searchsorted(self.times_s, time_s, side="right")) - 1, len(self.times_s) - 2)
        since, lasts = time_s - self.times_s[i], self.times_s[i + 1] - self.times_s[i]
        gain = (self.speeds[i + 1] - self.speeds[i]) / lasts
        return float(self.values[i] + self.speeds[i] * since + gain * since**2 / 2)
