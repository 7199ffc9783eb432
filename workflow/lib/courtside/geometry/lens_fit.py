"""Lenses of other models as OpenCV's five coefficients, where these follow them over the picture.

OpenCV's longer models have k4 k5 k6 (rational), s1 s2 s3 s4 (thin prism) and a tilted sensor; its
fisheye model has four coefficients of its own (Kannala & Brandt 2006).
"""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.study.errors import InputError

COLUMNS, ROWS = 32, 24  # of the grid over the picture that the coefficients are fitted to
MOST_OFF_PX = 0.01  # ASSUME: far below the noise of clicks and keypoints
SOLVED_PX = 1e-4  # of the inverse of a model, so that it is one
UNTIL = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 1000, 1e-13)
ADVICE = (
    "calibrate with the model of five coefficients k1 k2 p1 p2 k3, or give undistorted videos with "
    "their calibration"
)


def grid(size: Sequence[float] | NDArray) -> NDArray:
    """Return px (N, 2) over a picture, its corners included."""
    axes = np.linspace(0, size[0] - 1, COLUMNS), np.linspace(0, size[1] - 1, ROWS)
    return np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)


def fit(xy: NDArray, ideal: NDArray, matrix: NDArray) -> tuple[NDArray, float] | None:
    """Return k1 k2 p1 p2 k3 (5,) that show directions where a lens shows them, and the error, px.

    `ideal` (N, 2) are the directions of px `xy` (N, 2) on the z = 1 plane; the error is the largest
    along an axis. None if some are not finite.
    """
    focal = np.diag(matrix)[:2]
    missed = (xy - matrix[:2, 2]) / focal - ideal
    x, y = ideal[:, 0], ideal[:, 1]
    square = x * x + y * y
    along_x = [x * square, x * square**2, 2 * x * y, square + 2 * x * x, x * square**3]
    along_y = [y * square, y * square**2, square + 2 * y * y, 2 * x * y, y * square**3]
    effects = np.vstack([np.stack(along_x, -1), np.stack(along_y, -1)])
    if not (np.isfinite(effects).all() and np.isfinite(missed).all()):
        return None
    # Columns of one size: the sixth power of a small radius vanishes beside the second.
    scale = np.maximum(np.abs(effects).max(axis=0), np.finfo(float).tiny)
    solved, *_ = np.linalg.lstsq(effects / scale, missed.T.ravel(), rcond=None)
    dist = solved / scale
    off = (effects @ dist).reshape(2, -1).T - missed
    return dist, float(np.abs(off * focal).max())


def five(
    where: str, size: Sequence[int], matrix: NDArray, dist: NDArray, *, fisheye: bool
) -> NDArray:
    """Return k1 k2 p1 p2 k3 (5,) of a lens of OpenCV's longer models, or of its fisheye model.

    `matrix` (3, 3) px; `dist` are 8, 12 or 14 coefficients, 4 of a fisheye lens. Raises
    `InputError`, which begins with `where`, if five coefficients miss the lens by more than 0.01 px
    anywhere in the picture.
    """
    xy = grid(size)
    with np.errstate(all="ignore"):
        ideal = _undistorted(xy, matrix, dist, fisheye)
        off = np.abs(_shown(ideal, matrix, dist, fisheye) - xy).max()
        found = fit(xy, ideal, matrix) if off <= SOLVED_PX else None
    if found is not None and found[1] <= MOST_OFF_PX:
        return found[0]
    by = "one that cannot be inverted there" if found is None else f"{found[1]:.2g} px"
    model = "fisheye = true" if fisheye else f"{len(dist)} coefficients"
    raise InputError(
        f"{where}: expected a lens that five coefficients follow to {MOST_OFF_PX:g} px over the "
        f"picture, found {by} ({model}); {ADVICE}"
    )


def _undistorted(xy: NDArray, matrix: NDArray, dist: NDArray, fisheye: bool) -> NDArray:
    """Return directions (N, 2) of px by OpenCV, which may not be solved."""
    points = xy[:, None]
    if fisheye:
        return cv2.fisheye.undistortPoints(points, matrix, dist, criteria=UNTIL)[:, 0]
    return cv2.undistortPoints(points, matrix, dist, criteria=UNTIL)[:, 0]


def _shown(ideal: NDArray, matrix: NDArray, dist: NDArray, fisheye: bool) -> NDArray:
    """Return px (N, 2) of directions by OpenCV."""
    if fisheye:
        return cv2.fisheye.distortPoints(ideal[:, None], matrix, dist)[:, 0]
    places = np.column_stack([ideal, np.ones(len(ideal))])
    return cv2.projectPoints(places, np.zeros(3), np.zeros(3), matrix, dist)[0][:, 0]
