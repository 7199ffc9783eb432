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


def one_more(n: int, share: float) -> float:
    """Return how many sample standard deviations about the mean of `n` values hold one more.

    With probability `share`, 0..1, if all are normal: mean and deviation are estimated from the
    same values, two or more.
    """
    return float(scipy.special.stdtrit(n - 1, 0.5 + share / 2) * math.sqrt(1 + 1 / n))


def decimals(error: float) -> int:
    """Return after how many decimals a number ends that has such an error: with two digits of it.

    At most 3; `error` is more than 0.
    """
    return min(max(0, 1 - math.floor(math.log10(error))), 3)
