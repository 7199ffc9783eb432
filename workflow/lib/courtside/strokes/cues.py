"""The time of a stroke from each published hypothesis.

Sagawa et al. 2023 estimate hits from extrema of the first two principal component scores of the
skeleton, in a short window. Others are the farthest wrist and extrema of the wrist's speed. Here
each is the extremum nearest to a stroke, so that its error can be compared with the truth.
"""

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.geometry.interpolation import window
from courtside.strokes.signals import Signals

WINDOW_S = 0.5  # ASSUME: half of the short window of the components
NEAR_S = 0.4  # extrema farther away say nothing of the stroke
CUES = ("wrist_far", "wrist_fast", "wrist_slow", "trunk_pc1", "trunk_pc2")


def times(found: Signals, hand: str, time_s: float) -> dict[str, float]:
    """Return the time that each of `CUES` gives for the stroke near a time; NaN if none."""
    arm = found.arms[hand]
    frame = int(np.argmin(np.abs(found.time_s - time_s)))
    half = max(3, window(WINDOW_S, found.rate_hz))
    near = slice(max(frame - half, 0), frame + half + 1)
    first, second = _components(found.trunk_path[near])
    speed = arm.wrist.speed[near]
    lines = (arm.reach[near], speed, -speed, np.stack([first, -first]), np.stack([second, -second]))
    clock = found.time_s[near]
    return {
        name: _nearest(np.atleast_2d(line), clock, time_s)
        for name, line in zip(CUES, lines, strict=True)
    }


def _components(path: NDArray) -> tuple[NDArray, NDArray]:
    """Return the scores (T,) of the first two principal components of a path (T, n)."""
    known = np.isfinite(path).all(axis=1)
    scores = np.full((len(path), 2), np.nan)
    if known.sum() > 2:
        centred = path[known] - path[known].mean(axis=0)
        left, sizes, _ = np.linalg.svd(centred, full_matrices=False)
        scores[known] = left[:, :2] * sizes[:2]
    return scores[:, 0], scores[:, 1]


def _nearest(lines: NDArray, clock: NDArray, time_s: float) -> float:
    """Return the time of the local maximum, over all lines, that is nearest to a time."""
    peaks = np.concatenate([scipy.signal.find_peaks(line)[0] for line in lines])
    found = clock[peaks.astype(int)]
    found = found[np.abs(found - time_s) <= NEAR_S]
    return float(found[np.argmin(np.abs(found - time_s))]) if len(found) else np.nan
