"""Lens models of RealSense cameras, brought to OpenCV's five coefficients.

As the camera's software (librealsense, `rsutil.h`) projects points of the z = 1 plane:
- Brown Conrady: what OpenCV has;
- Modified and Inverse Brown Conrady: the tangential part acts on the points after the radial one. By
  its name and the maker's documents the inverse model would lead from the picture to the plane; since 2021
  the software takes both for the same, and so do its files.
"""

import numpy as np
from scipy.optimize import least_squares

from courtside.geometry import camera
from courtside.study.errors import InputError

SAME = ("brown conrady", "plumb_bob", "none", "")
OTHER = ("modified brown conrady", "inverse brown conrady")
GRID = 25  # points along each side of the picture
WORST_PX = 0.5


def five_coefficients(where, model, coefficients, K, size):
    """Return OpenCV's k1 k2 p1 p2 k3 for a lens as a recording describes it.

    Parameters
    ----------
    where : str
        File and stream: begins messages.
    model : str
        As the recording names it.
    coefficients : (5,) array_like
        k1 k2 p1 p2 k3 of that model.
    K : (3, 3) array_like
    size : (int, int)

    Returns
    -------
    dist : (5,) float
        The same where the model is OpenCV's or all are 0; else fitted to within half a pixel.

    Raises
    ------
    InputError
        If the model is another, or no such coefficients come within half a pixel of it.
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
            f"{where}: expected a lens that OpenCV's five coefficients describe to {WORST_PX} px, found "
            f"{worst_px:.1f} px ({model[:40]}); calibrate the colour camera with a chessboard"
        )
    return dist


def _fit(given, K, size):
    """Return OpenCV's coefficients, and their worst error in the picture, px."""
    focal = np.diag(K)[:2]
    columns, rows = (np.linspace(0, length - 1, GRID) for length in size)
    pixels = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    plane = (pixels - K[:2, 2]) / focal
    shown = modified(given, plane)

    def miss(dist):
        return ((camera.distort(dist, plane) - shown) * focal).ravel()

    found = least_squares(miss, given).x
    return found, float(np.hypot(*miss(found).reshape(-1, 2).T).max())


def modified(coefficients, normalised):
    """Move points (..., 2) on the z = 1 plane to where a Modified Brown Conrady lens shows them."""
    k1, k2, p1, p2, k3 = coefficients
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
