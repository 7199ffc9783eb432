"""A lens whose file says how to undo its distortion, as coefficients that distort."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera as cameras
from courtside.geometry import camera_fields
from courtside.study.errors import InputError

COLUMNS, ROWS = 32, 24  # of the grid over the picture that the coefficients are fitted to
# ASSUME: below the noise of keypoints; lenses of Vicon are some 0.03 px off, of OptiTrack 0.1 px.
MOST_OFF_PX = 0.25


def coefficients(
    where: str,
    size: Sequence[float] | NDArray,
    matrix: NDArray,
    undistort: Callable[[NDArray], NDArray],
) -> NDArray:
    """Return OpenCV's k1 k2 p1 p2 k3 (5,) of a lens that is stated as its inverse.

    `undistort` maps px (N, 2) of the picture of `size` px to directions (N, 2) on the z = 1 plane;
    `matrix` (3, 3) px. The coefficients are fitted by least squares over the whole picture. Raises
    `InputError` that begins with `where` if they miss the lens by more than 0.25 px anywhere.
    """
    width, height = camera_fields.numbers(where, "size", size, (2,))
    axes = np.linspace(0, width - 1, COLUMNS), np.linspace(0, height - 1, ROWS)
    xy = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    focal = np.diag(matrix)[:2]
    ideal = undistort(xy)
    missed = (xy - matrix[:2, 2]) / focal - ideal
    x, y = ideal[:, 0], ideal[:, 1]
    square = x * x + y * y
    along_x = [x * square, x * square**2, 2 * x * y, square + 2 * x * x, x * square**3]
    along_y = [y * square, y * square**2, square + 2 * y * y, 2 * x * y, y * square**3]
    effects = np.vstack([np.stack(along_x, -1), np.stack(along_y, -1)])
    if not (np.isfinite(effects).all() and np.isfinite(missed).all()):
        raise InputError(f"{where}: expected a lens, found one without limits; export it again")
    # Columns of one size: the sixth power of a small radius vanishes beside the second.
    scale = np.maximum(np.abs(effects).max(axis=0), np.finfo(float).tiny)
    solved, *_ = np.linalg.lstsq(effects / scale, missed.T.ravel(), rcond=None)
    dist = solved / scale
    off_px = np.abs((cameras.distort(dist, ideal) - ideal - missed) * focal).max()
    if not off_px <= MOST_OFF_PX:
        raise InputError(
            f"{where}: expected a lens that five coefficients of OpenCV follow to {MOST_OFF_PX:g} "
            f"px, found {off_px:.3g} px; calibrate with another program, or give undistorted videos"
        )
    return dist
