"""Covariances of the columns of a network: inverses of its information."""

import numpy as np
from numpy.typing import NDArray


def of_columns(information: NDArray, free: NDArray) -> NDArray:
    """Return the covariance (K, K) of all columns; 0 but for the `free` ones, (K,) bool.

    `information` (A, A) is that of these alone.
    """
    covariance = np.zeros((len(free), len(free)))
    scale = 1 / np.sqrt(np.diag(information))
    inverse = np.linalg.inv(information * np.outer(scale, scale))
    covariance[np.ix_(free, free)] = inverse * np.outer(scale, scale)
    return covariance


def pseudo_inverse(information: NDArray, n_free: int = 7) -> NDArray:
    """Return the covariance (K, K) of a network whose frame and scale are free.

    Of all such covariances, it has the least trace in parameters of unit information. The
    information (K, K) is zero for fixed columns. Nothing is known of `n_free` directions: those
    of least information are left out (7: rotation, translation and scale of the frame).
    """
    scale = np.where(np.diag(information) > 0, np.diag(information), np.inf) ** -0.5
    extent, axes = np.linalg.eigh(information * np.outer(scale, scale))
    n_known = np.count_nonzero(scale) - n_free
    known = extent.argsort()[::-1][: max(n_known, 0)]
    root = scale[:, None] * axes[:, known] / np.sqrt(np.maximum(extent[known], 1e-300))
    return root @ root.T
