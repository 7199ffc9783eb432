"""Whether cameras film a wand at the same time, by its markers' ways in their pictures."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.wand.points import Seen
from courtside.geometry.camera import Camera, project

FAST = 0.5  # share of the markers that tell: the faster ones
FEWEST = 20  # of them
MEDIAN_SIGMA = 1.4826 * 1.2533  # of a median, over the median deviation and the root of the number


def late(cameras: Sequence[Camera], seen: Seen, xyz: NDArray) -> tuple[NDArray, NDArray]:
    """Return by how many frames each camera (C,) films late, and the standard deviations.

    By how far markers are along their ways from the places (F, M, 3) m that all cameras together
    give them. It is less than the truth, because these places follow the late camera, too.
    """
    found, sigma = np.zeros(len(cameras)), np.full(len(cameras), np.inf)
    step = float(np.median(np.diff(seen.frames)))
    apart = (seen.frames[2:] - seen.frames[:-2]) / step
    for c, camera in enumerate(cameras):
        px = project(camera, xyz)
        way = np.full_like(px, np.nan)
        way[1:-1] = (px[2:] - px[:-2]) / apart[:, None, None]
        way[1:-1][apart > 2.5] = np.nan  # frames are missing in between
        ahead = ((seen.xy[c] - px) * way).sum(axis=-1) / (way**2).sum(axis=-1)
        speed = np.linalg.norm(way, axis=-1)
        known = np.isfinite(ahead)
        if known.sum() < FEWEST:
            continue
        each = ahead[known & (speed >= np.quantile(speed[known], 1 - FAST))]
        found[c] = np.median(each)
        spread = np.median(np.abs(each - found[c]))
        sigma[c] = MEDIAN_SIGMA * spread / np.sqrt(len(each))
    return found, sigma
