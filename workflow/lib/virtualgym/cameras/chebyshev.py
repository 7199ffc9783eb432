"""Polynomials through Chebyshev nodes: smooth functions of a place in a picture."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BarycentricInterpolator


def nodes(length: int, count: int) -> NDArray:
    """Return the nodes (count,) of a picture's side, px."""
    on_circle = -np.cos(np.pi * (np.arange(count) + 0.5) / count)
    return (on_circle + 1) / 2 * length - 0.5


def to_pixels(length: int, count: int) -> NDArray:
    """Return the matrix (length, count) from values at the nodes of a side to those at its pixels.

    scipy draws the order in which it takes the nodes; the seed makes all runs round alike.
    """
    through = BarycentricInterpolator(nodes(length, count), np.eye(count), rng=0)
    return through(np.arange(length))
