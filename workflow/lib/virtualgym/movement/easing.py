"""Smooth courses of one number: from rest to rest, up and down, by straight speeds."""

import numpy as np

RAMP = 0.35  # the usual share of a move's duration in which it speeds up, and slows down


def ease(x, ramp=RAMP):
    """Return how far a move has come, 0..1, at a share of its duration, clipped to 0..1.

    The speed rises and falls by smooth steps over the ramp, a share up to 0.5, and is constant between: its
    highest value is 1 / (1 - ramp), and the acceleration is continuous.
    """
    x = _between(x, 0.0, 1.0)
    rise, fall = _between(x / ramp, 0, 1), _between((1 - x) / ramp, 0, 1)
    ramps = ramp * (_ramp_integral(rise) - _ramp_integral(fall) + 0.5)
    return (ramps + _between(x - ramp, 0, 1 - 2 * ramp)) / (1 - ramp)


def step(x):
    """Return the smooth step from 0 (x <= 0) to 1 (x >= 1); its first derivative is continuous."""
    x = _between(x, 0.0, 1.0)
    return x * x * (3 - 2 * x)


def bump(x):
    """Return a hump over 0..1 of height 1, zero outside; its first derivative is continuous."""
    x = _between(x, 0.0, 1.0)
    return 16 * (x * (1 - x)) ** 2


def _between(x, low, high):
    """Limit a number or an array; NumPy's own function takes ten times as long on a few."""
    return np.minimum(np.maximum(x, low), high)


def _ramp_integral(x):
    """Return the integral of the smooth step from 0 to x."""
    return x**3 - x**4 / 2


class Glide:
    """A number whose speed goes in straight lines from knot to knot, and is 0 outside.

    Parameters
    ----------
    times_s : (n,) float
        Increasing.
    speeds : (n,) float
        Per second; the first and the last are 0.
    start : float
        The number before the first knot.
    """

    def __init__(self, times_s, speeds, start=0.0):
        self.times_s, self.speeds = np.asarray(times_s, float), np.asarray(speeds, float)
        lasts = np.diff(self.times_s)
        if np.any(lasts <= 0) or self.speeds[0] != 0 or self.speeds[-1] != 0:
            raise ValueError("expected increasing times and rest at both ends")
        gains = lasts * (self.speeds[1:] + self.speeds[:-1]) / 2
        self.values = start + np.append(0.0, np.cumsum(gains))

    def at(self, time_s):
        """Return the number at a time, s."""
        time_s = np.clip(time_s, self.times_s[0], self.times_s[-1])
        i = min(int(np.searchsorted(self.times_s, time_s, side="right")) - 1, len(self.times_s) - 2)
        since, lasts = time_s - self.times_s[i], self.times_s[i + 1] - self.times_s[i]
        gain = (self.speeds[i + 1] - self.speeds[i]) / lasts
        return self.values[i] + self.speeds[i] * since + gain * since**2 / 2
