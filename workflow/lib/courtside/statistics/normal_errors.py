"""Normal errors: factors of their sigma, ellipsoids of a stated share, decimals to state."""

import math

import numpy as np
import scipy
from numpy.typing import NDArray

WITHIN_90 = 1.645  # standard deviations to either side hold 90 % of normal errors
MEDIAN_TO_SIGMA = 1.4826  # of the absolute values of normal errors
MEDIAN_2D = 1.177  # median length of a normal vector in two dimensions, sigma 1 per axis


def mahalanobis(error: NDArray, covariance: NDArray) -> NDArray:
    """Return error.T @ inverse(covariance) @ error, (N,), of errors (N, 3) and covariances."""
    return np.einsum("ni,ni->n", error, np.linalg.solve(covariance, error[..., None])[..., 0])


def ellipsoid(share: float) -> float:
    """Return what `mahalanobis` stays within for a share, 0..1, of normal errors."""
    return 2 * scipy.special.gammaincinv(3 / 2, share)


def decimals(error: float) -> int:
    """Return after how many decimals a number ends that has such an error: with two digits of it.

    At most 3; `error` is more than 0.
    """
    return min(max(0, 1 - math.floor(math.log10(error))), 3)
