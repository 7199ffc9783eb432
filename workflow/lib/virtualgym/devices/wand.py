"""A wand that a person swings through a volume, and where cameras see its markers."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import rotations
from courtside.geometry.camera import Camera, project

# ASSUME: how a person swings a wand: from a place to the next in some seconds, turning it faster.
WAY_S, TURN_S = 12.0, 3.0  # periods of the slowest part of ways and turns
PARTS = 4  # of each, every one a period shorter
HIDDEN_S = 0.7  # a body or hand hides a marker for so long
FAR_PX = (8.0, 60.0)  # how far a tracker jumps that holds another spot for the marker


def swing(
    along_m: ArrayLike,
    low: ArrayLike,
    high: ArrayLike,
    *,
    seconds: float,
    rate_hz: float,
    rng: np.random.Generator,
) -> NDArray:
    """Swing a wand whose middle stays in a box.

    Parameters
    ----------
    along_m : (M,) float
        Places of the markers on the wand.
    low, high : (3,) float
        Corners of the box, m.
    seconds, rate_hz : float
        How long, and how many frames a second.
    rng : numpy.random.Generator

    Returns
    -------
    xyz : (T, M, 3) float
        Places of the markers, m.
    """
    time_s = np.arange(round(seconds * rate_hz)) / rate_hz
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    way = _wander(time_s, WAY_S, rng)
    way = (way - way.min(axis=0)) / np.ptp(way, axis=0)
    direction = rotations.unit(_wander(time_s, TURN_S, rng))
    places = np.asarray(along_m, dtype=float)
    from_middle = places - places.mean()
    middle = low + (high - low) * way
    return middle[:, None] + from_middle[:, None] * direction[:, None]


def _wander(time_s: NDArray, period_s: float, rng: np.random.Generator) -> NDArray:
    """Return a smooth random function (T, 3) with parts of this period and shorter ones."""
    part = np.arange(1, PARTS + 1)
    phase = rng.uniform(0, 2 * np.pi, (PARTS, 3))
    size = rng.standard_normal((PARTS, 3)) / np.sqrt(part)[:, None]
    turn = 2 * np.pi * part * time_s[:, None] / period_s
    return (size * np.sin(turn[:, :, None] + phase)).sum(axis=1)


def film(
    cameras: Sequence[Camera],
    xyz: NDArray,
    *,
    sigma_px: float,
    rate_hz: float,
    hidden: float = 0.0,
    misread: float = 0.0,
    rng: np.random.Generator,
) -> NDArray:
    """Track the markers of a wand in the pictures of cameras.

    Parameters
    ----------
    cameras : sequence of Camera
    xyz : (T, M, 3) float
        Places of the markers, m.
    sigma_px : float
        Standard deviation per axis of a tracked marker.
    rate_hz : float
        Frames a second.
    hidden : float
        Share of the time that a marker is hidden from a camera, for `HIDDEN_S` at a time.
    misread : float
        Share of the markers seen that are another spot nearby.
    rng : numpy.random.Generator

    Returns
    -------
    xy : (C, T, M, 2) float
        px; NaN where a marker is hidden or outside the picture.
    """
    shape = len(cameras), *xyz.shape[:2]
    xy = np.stack([project(camera, xyz) for camera in cameras])
    xy += rng.normal(0, sigma_px, xy.shape)
    jump = rotations.unit(rng.standard_normal((*shape, 3)) * [1, 1, 0])[..., :2]
    jump *= rng.uniform(*FAR_PX, (*shape, 1))
    xy += np.where(rng.random((*shape, 1)) < misread, jump, 0.0)
    sizes = np.array([camera.size for camera in cameras])[:, None, None]
    inside = ((xy >= 0) & (xy <= sizes - 1)).all(axis=-1)
    run = max(1, round(HIDDEN_S * rate_hz))
    pieces = rng.random((shape[0], -(-shape[1] // run), shape[2])) < hidden
    away = np.repeat(pieces, run, axis=1)[:, : shape[1]]
    return np.where((inside & ~away)[..., None], xy, np.nan)
