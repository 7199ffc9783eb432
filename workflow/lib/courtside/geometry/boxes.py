"""Boxes around points in a picture."""

import numpy as np
from numpy.typing import NDArray


def usual_side(xy: NDArray) -> NDArray:
    """Return the usual longer side (...) of the box round points (..., T, J, 2), NaN where missing.

    The median over the T frames; 0 where none shows two points or more.
    """
    known = np.isfinite(xy).all(axis=-1, keepdims=True)
    low = np.where(known, xy, np.inf).min(axis=-2)
    high = np.where(known, xy, -np.inf).max(axis=-2)
    sides = np.where(np.isfinite(low), high, 0.0) - np.where(np.isfinite(low), low, 0.0)
    longer = np.ma.masked_equal(sides.max(axis=-1), 0.0)
    return np.asarray(np.ma.filled(np.ma.median(longer, axis=-1), 0.0))
