"""Lens models of RealSense cameras, converted to OpenCV's five coefficients.

The camera's software (librealsense, `rsutil.h`) projects points of the z = 1 plane by
- Brown Conrady: OpenCV's model;
- Modified and Inverse Brown Conrady: the tangential part acts on the points after the radial one.
  By its name and the maker's documents the inverse model would map the picture to the plane; since
  2021 the software takes both as the same, and so do its files.
"""

from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import camera
from courtside.study.errors import InputError

SAME = ("brown conrady", "plumb_bob", "none", "")
OTHER = ("modified brown conrady", "inverse brown conrady")
GRID = 25  # points along each side of the picture
WORST_PX = 0.5  # ASSUME: below the noise of keypoints, so that a worse fit would matter


def five_coefficients(
    where: str, model: str, coefficients: ArrayLike, K: ArrayLike, size: Sequence[int]
) -> NDArray:
    """Return OpenCV's k1 k2 p1 p2 k3 for a lens as a recording describes it.

    `where`, file and stream, begins messages; `coefficients` are k1 k2 p1 p2 k3 of the model, as
    the recording names it. They stay if the model is OpenCV's or all are 0, else they are fitted to
    within half a pixel. An `InputError` if the model is another, or no such coefficients come
    within half a pixel of it.
    """
    given = np.zeros(5)
    values = np.asarray(coefficients, dtype=float).ravel()[:5]
    given[: len(values)] = values
    name = model.strip().lower()
    if not given.any() or name in SAME:
        return given
    if name not in OTHER or not np.isfinite(given).all():
        raise InputError(
            f"{where}: expected a lens model Brown Conrady (also modified or inverse), found "
            f"{model[:40]!r} with {given.tolist()}; record colour and depth of a D400 camera"
        )
    dist, worst_px = _fit(given, np.asarray(K, dtype=float), size)
    if not worst_px <= WORST_PX:
        raise InputError(
            f"{where}: expected a lens that OpenCV's five coefficients describe to {WORST_PX} px, "
            f"found {worst_px:.1f} px ({model[:40]}); calibrate the colour camera with a chessboard"
        )
    return dist


def _fit(given: NDArray, K: NDArray, size: Sequence[int]) -> tuple[NDArray, float]:
    """Return OpenCV's coefficients, and their worst error in the picture, px."""
    focal = np.diag(K)[:2]
    columns, rows = (np.linspace(0, length - 1, GRID) for length in size)
    pixels = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    plane = (pixels - K[:2, 2]) / focal
    shown = modified(given, plane)

    def miss(dist: NDArray) -> NDArray:
        return ((camera.distort(dist, plane) - shown) * focal).ravel()

    found = scipy.optimize.least_squares(miss, given).x
    return found, float(np.hypot(*miss(found).reshape(-1, 2).T).max())


def modified(coefficients: ArrayLike, normalised: NDArray) -> NDArray:
    """Distort points (..., 2) on the z = 1 plane as a Modified Brown Conrady lens does."""
    k1, k2, p1, p2, k3 = np.asarray(coefficients)
    square = (normalised**2).sum(axis=-1)
    radial = 1 + square * (k1 + square * (k2 + square * k3))
    x, y = normalised[..., 0] * radial, normalised[..., 1] * radial
    return np.stack(
        [
            x + 2 * p1 * x * y + p2 * (square + 2 * x * x),
            y + 2 * p2 * x * y + p1 * (square + 2 * y * y),
        ],
        axis=-1,
    )
