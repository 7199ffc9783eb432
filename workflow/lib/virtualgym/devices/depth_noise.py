"""Errors of a stereo depth camera: noise that grows with depth squared, steps, and holes."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

FIELD_PX = 256  # size of the noise field beyond the picture's
JUMP_PX = 1.0  # ASSUME: a larger difference of disparity between neighbours is a depth edge
MOST = np.iinfo(np.uint16).max
BLOTCH_PX = 1.5  # ASSUME: size of connected holes, standard deviation of a smoothing window


@dataclass(frozen=True)
class DepthErrors:
    """The error model of a depth camera; see `depth_camera.DepthCamera`.

    Attributes
    ----------
    focal_baseline : float
        f b: focal length in px of the depth frames times the baseline in metres.
    subpixel_px, correlation_px, unit_m, edge_px, edge_holes, holes : float
    range_m : (float, float)
    """

    focal_baseline: float
    subpixel_px: float
    correlation_px: float
    unit_m: float
    range_m: tuple[float, float]
    edge_px: float
    edge_holes: float
    holes: float


class Sensor:
    """Turns true depth into measured frames.

    Parameters
    ----------
    errors : DepthErrors
    size : (int, int)
        Width and height of the frames.
    rng : numpy.random.Generator
        Of two fields, noise and holes, of which each frame gets random windows.
    """

    def __init__(
        self, errors: DepthErrors, size: tuple[int, int], rng: np.random.Generator
    ) -> None:
        self.errors = errors
        shape = size[1] + FIELD_PX, size[0] + FIELD_PX
        self._noise = _field(rng, shape, errors.correlation_px)
        rank = np.argsort(np.argsort(_field(rng, shape, BLOTCH_PX), axis=None))
        self._chance = (rank.reshape(shape) / rank.size).astype(np.float32)

    def measured(self, depth_m: NDArray, rng: np.random.Generator) -> NDArray:
        """Measure a frame.

        Parameters
        ----------
        depth_m : (h, w) float32
            True depth; inf where nothing is.
        rng : numpy.random.Generator
            Of this frame.

        Returns
        -------
        depth : (h, w) uint16
            In the camera's units; 0: a hole.
        """
        errors = self.errors
        disparity = np.float32(errors.focal_baseline) / depth_m
        none = hidden(disparity)
        chance = _window(self._chance, depth_m.shape, rng)
        none |= chance < np.where(edges(disparity, errors.edge_px), errors.edge_holes, errors.holes)
        noisy = disparity + np.float32(errors.subpixel_px) * _window(
            self._noise, depth_m.shape, rng
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            found = np.float32(errors.focal_baseline) / noisy
        none |= ~((found >= errors.range_m[0]) & (found <= errors.range_m[1]))
        steps = np.rint(np.where(none, 0, found) / errors.unit_m)
        return np.where(steps > MOST, 0, steps).astype(np.uint16)


def hidden(disparity_px: NDArray) -> NDArray:
    """Return where nearer surfaces hide points from the right imager.

    Parameters
    ----------
    disparity_px : (h, w) float
        Column in the left picture minus column in the right one.

    Returns
    -------
    hidden : (h, w) bool
        Beside the left edges of near surfaces, and along the left edge of the picture.
    """
    column = np.arange(disparity_px.shape[1], dtype=np.float32) - disparity_px
    # The leftmost column in the right picture of this point and all points to its right.
    later = np.minimum.accumulate(column[:, ::-1], axis=1)[:, ::-1]
    covered = np.zeros(disparity_px.shape, bool)
    covered[:, :-1] = column[:, :-1] >= later[:, 1:]
    return covered | (column < -0.5)


def edges(disparity_px: NDArray, reach_px: float) -> NDArray:
    """Return the pixels (h, w) within `reach_px` of a depth edge, bool."""
    jumps = np.zeros(disparity_px.shape, np.uint8)
    across = np.abs(np.diff(disparity_px, axis=1)) > JUMP_PX
    down = np.abs(np.diff(disparity_px, axis=0)) > JUMP_PX
    jumps[:, 1:] |= across
    jumps[:, :-1] |= across
    jumps[1:] |= down
    jumps[:-1] |= down
    reach = int(np.ceil(reach_px))
    x, y = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    disc = (np.hypot(x, y) <= reach_px).astype(np.uint8)
    return cv2.dilate(jumps, disc).astype(bool)


def _field(rng: np.random.Generator, shape: tuple[int, int], sigma_px: float) -> NDArray:
    """Return noise (H, W) float32, mean 0, standard deviation 1, smoothed by a Gaussian window."""
    field = rng.standard_normal(shape, dtype=np.float32)
    if sigma_px > 0:
        field = gaussian_filter(field, sigma_px, mode="wrap")
    return (field - field.mean()) / field.std()


def _window(field: NDArray, shape: tuple[int, ...], rng: np.random.Generator) -> NDArray:
    top, left = rng.integers(0, FIELD_PX + 1, 2)
    return field[top : top + shape[0], left : left + shape[1]]
