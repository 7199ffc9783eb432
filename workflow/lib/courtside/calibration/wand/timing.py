"""Delays of cameras relative to the others, from the movement of the markers in their pictures."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.wand.points import Seen
from courtside.geometry.camera import Camera, project
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA

FAST = 0.5  # share of the markers that is used, the fastest
FEWEST = 20  # markers with a speed
# Sigma of a median, over the median deviation / root of the number.
MEDIAN_SIGMA = MEDIAN_TO_SIGMA * 1.2533


def delays(cameras: Sequence[Camera], seen: Seen, xyz: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Return the delay of each camera (C,) in frames, its standard deviation, and the delay in px.

    It is the distance of markers along their path from their positions (F, M, 3) m by all cameras,
    over their speed. It is smaller than the true delay, because the delayed camera takes part in
    these positions. Frames are those of `seen`: if they are every n-th of the video, it is small.
    """
    found, sigma = np.zeros(len(cameras)), np.full(len(cameras), np.inf)
    along_px = np.zeros(len(cameras))
    step = float(np.median(np.diff(seen.frames)))
    apart = (seen.frames[2:] - seen.frames[:-2]) / step
    for c, camera in enumerate(cameras):
        px = project(camera, xyz)
        velocity = np.full_like(px, np.nan)  # px per frame
        velocity[1:-1] = (px[2:] - px[:-2]) / apart[:, None, None]
        velocity[1:-1][apart > 2.5] = np.nan  # frames are missing in between
        speed = np.linalg.norm(velocity, axis=-1)
        speed[speed == 0] = np.nan
        ahead = ((seen.xy[c] - px) * velocity).sum(axis=-1) / speed**2
        known = np.isfinite(ahead)
        if known.sum() < FEWEST:
            continue
        fast = known & (speed >= np.quantile(speed[known], 1 - FAST))
        found[c] = np.median(ahead[fast])
        spread = np.median(np.abs(ahead[fast] - found[c]))
        sigma[c] = MEDIAN_SIGMA * spread / np.sqrt(fast.sum())
        along_px[c] = found[c] * np.median(speed[fast])
    return found, sigma, along_px
