"""Simulation of a wand that a person moves through a volume, and of its markers in pictures."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import rotations
from courtside.geometry.camera import Camera, project

# ASSUME: how a person moves a wand: slowly from place to place, with faster rotations.
PATH_S, TURN_S = 12.0, 3.0  # longest periods of path and rotation
PARTS = 4  # number of sines of each, with periods over 1, 2, ...
HIDDEN_S = 0.7  # duration for which a body or hand hides a marker
FAR_PX = (8.0, 60.0)  # distance of another spot that a tracker mistakes for the marker


def swing(
    along_m: ArrayLike,
    low: ArrayLike,
    high: ArrayLike,
    *,
    seconds: float,
    rate_hz: float,
    rng: np.random.Generator,
) -> NDArray:
    """Move a wand whose middle stays in a box.

    Parameters
    ----------
    along_m : (M,) float
        Positions of the markers on the wand.
    low, high : (3,) float
        Corners of the box, m.
    seconds, rate_hz : float
        Duration and frame rate.
    rng : numpy.random.Generator

    Returns
    -------
    xyz : (T, M, 3) float
        Positions of the markers, m.
    """
    time_s = np.arange(round(seconds * rate_hz)) / rate_hz
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    path = _random_path(time_s, PATH_S, rng)
    path = (path - path.min(axis=0)) / np.ptp(path, axis=0)
    direction = rotations.unit(_random_path(time_s, TURN_S, rng))
    places = np.asarray(along_m, dtype=float)
    from_middle = places - places.mean()
    middle = low + (high - low) * path
    return middle[:, None] + from_middle[:, None] * direction[:, None]


def _random_path(time_s: NDArray, period_s: float, rng: np.random.Generator) -> NDArray:
    """Return a smooth random path (T, 3), a sum of sines of this period and shorter ones."""
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
    """Simulate tracked markers of a wand in the pictures of cameras.

    Parameters
    ----------
    cameras : sequence of Camera
    xyz : (T, M, 3) float
        Positions of the markers, m.
    sigma_px : float
        Standard deviation per axis of a tracked marker.
    rate_hz : float
        Frame rate.
    hidden : float
        Share of the time in which a marker is hidden from a camera, for `HIDDEN_S` at a time.
    misread : float
        Share of the visible markers that are another spot nearby.
    rng : numpy.random.Generator

    Returns
    -------
    xy : (C, T, M, 2) float
        px; NaN if a marker is hidden or outside the picture.
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
