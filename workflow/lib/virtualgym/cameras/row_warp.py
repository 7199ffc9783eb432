"""Rows that a stabiliser moves: it turns each row by what its gyroscope says, a little wrong."""

import numpy as np
from numpy.typing import NDArray

# ASSUME: standard deviation of each of four terms, px at 1280 px width; no source is recorded. A
# gyroscope read 1 ms late at 20 degrees a second is wrong by 0.02 degrees, 0.4 px.
WARP_PX = 0.4


def shifts(row_warp_px: NDArray, rows: NDArray, height: int) -> NDArray:
    """Return how far from each shown row the lens showed its content.

    Parameters
    ----------
    row_warp_px : (2, 2) float
        Across and down: the shift at the lowest row that grows evenly from the middle, and the one
        that grows with the square; px.
    rows : (...) float
        Of the shown picture, px.
    height : int
        Of the picture, px.

    Returns
    -------
    shift_px : (2, ...) float
        Across and down: a pixel (x, y) shows what the lens alone showed at (x, y) + shift.
    """
    place = (2 * np.asarray(rows, dtype=float) - (height - 1)) / height
    even, square = np.asarray(row_warp_px, dtype=float).T
    return np.multiply.outer(even, place) + np.multiply.outer(square, place**2 - 1 / 3)
