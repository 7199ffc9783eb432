"""Smoothness of a movement: the spectral arc length of its speed (SPARC)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry.interpolation import linear
from courtside.kinematics.wrist_arcs import SIDES, Arc
from courtside.records.keypoints.body_motion import BodyMotion

# Of the authors' own code (references in `sparc`).
CUTOFF_HZ = 10.0
THRESHOLD = 0.05  # share of the spectrum at 0 Hz
PADDING = 4  # powers of two by which the spectrum is made finer


def sparc(speed: ArrayLike, rate_hz: float) -> float:
    """Return the spectral arc length of a speed profile (T,), no unit; nearer to 0 is smoother.

    The speed, in any unit, is of one movement from rest to rest. A single minimum-jerk reach has
    -1.41. Neither amplitude nor duration changes the value, as long as the spectrum ends below the
    cut-off. Frequencies do not count beyond `CUTOFF_HZ`, nor beyond the last that reaches
    `THRESHOLD`. ValueError if a value is missing or nothing moves.

    Balasubramanian, Melendez-Calderon & Burdet 2012; with the adaptive limit of Balasubramanian,
    Melendez-Calderon, Roby-Brami & Burdet 2015. Noise counts as unsmooth: compare sources at one
    rate.
    """
    speed = np.asarray(speed, dtype=float)
    if speed.ndim != 1 or len(speed) < 4 or not np.isfinite(speed).all() or not speed.any():
        raise ValueError("expected four or more finite speeds that are not all zero")
    count = 2 ** (int(np.ceil(np.log2(len(speed)))) + PADDING)
    hz = np.fft.rfftfreq(count, 1 / rate_hz)
    spectrum = np.abs(np.fft.rfft(speed, count))
    spectrum = spectrum[hz <= CUTOFF_HZ] / spectrum[0]
    used = np.flatnonzero(spectrum >= THRESHOLD)
    part = spectrum[used[0] : used[-1] + 1]
    if len(part) < 2:
        raise ValueError("expected a spectrum wider than one line, found a steady speed")
    return float(-np.hypot(1 / (len(part) - 1), np.diff(part)).sum())


def of_path(
    time_s: NDArray, xyz: NDArray, rate_hz: float, *, start_s: float, stop_s: float
) -> float:
    """Return the SPARC of the speed of a point (T, 3), any unit, between two times.

    The path is resampled at `rate_hz`, at which sources are compared; straight lines bridge missing
    values. NaN where fewer than half of the values in between are known.
    """
    grid = np.arange(start_s, stop_s, 1 / rate_hz)
    known = np.isfinite(xyz).all(axis=1)
    inside = (time_s >= start_s) & (time_s <= stop_s)
    if len(grid) < 5 or known[inside].sum() < max(2, 0.5 * inside.sum()):
        return np.nan
    path = linear(time_s[known], xyz[known], grid)
    speed = np.linalg.norm(np.diff(path, axis=0), axis=1) * rate_hz
    return sparc(speed, rate_hz)


def of_arcs(body: BodyMotion, arcs: Sequence[Arc], rate_hz: float) -> list[float]:
    """Return the SPARC of each wrist of a body on its arc from T-pose to clap; NaN without arcs."""
    if not arcs:
        return [float("nan")] * len(SIDES)
    return [
        of_path(
            body.time_s,
            body.joint(f"{arc.side}_wrist"),
            rate_hz,
            start_s=arc.time_s[0],
            stop_s=arc.time_s[-1],
        )
        for arc in arcs
    ]
