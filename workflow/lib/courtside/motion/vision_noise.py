"""How far vision can be trusted, told from residuals: spread, correlation in time, bad frames."""

from dataclasses import dataclass

import numpy as np

TAIL = 4.0  # degrees of freedom of Student's t: a robust estimate (Lange et al. 1989)
ROUNDS = 5
PRIOR_FRAMES = 5.0  # independent frames that the stated sigma counts for
LONGEST_S = 0.5  # memory of the noise: beyond, it cannot be told from a slow error of the device
SHORT_S = 0.1  # lag at which the memory is read


@dataclass(frozen=True, eq=False)
class Noise:
    """Noise of each joint of vision.

    Attributes
    ----------
    covariance : (D, 3, 3) float
        Of residuals divided by their stated sigma.
    inflation : (D,) float
        Frames that tell as much as one independent frame would.
    weight : (N, D) float
        1 for a frame as expected, towards 0 for an outlier; 0 where there is no residual.
    """

    covariance: np.ndarray
    inflation: np.ndarray
    weight: np.ndarray

    def whitening(self):
        """Return (N, D, 3, 3): multiply residuals over sigma by it and sum the squares."""
        root = np.linalg.cholesky(np.linalg.inv(self.covariance)).swapaxes(1, 2)
        return np.sqrt(self.weight / self.inflation)[..., None, None] * root


def estimate(residual, rate_hz, correlation_s):
    """Estimate the noise of vision from residuals of a fit.

    Parameters
    ----------
    residual : (N, D, 3) float
        Over the stated sigma; NaN where vision has no joint.
    rate_hz : float
        Frames per second.
    correlation_s : float
        Time over which errors of a network are alike at least; more is found from the residuals.

    Returns
    -------
    noise : Noise
    """
    seen = np.isfinite(residual).all(axis=2)
    filled = np.where(seen[..., None], residual, 0.0)
    covariance = np.tile(np.eye(3), (residual.shape[1], 1, 1)) * _start(filled, seen)
    lowest = _floor(rate_hz, correlation_s)
    inflation = np.full(residual.shape[1], lowest)
    for _ in range(ROUNDS):
        weight, white = _weights(filled, covariance, seen)
        inflation = np.maximum(lowest, _inflation(white, weight, seen, rate_hz))
        n = seen.sum(axis=0) / inflation
        spread = np.einsum("tj,tja,tjb->jab", weight, filled, filled) / inflation[:, None, None]
        total = spread + PRIOR_FRAMES * np.eye(3)
        covariance = total / (n + PRIOR_FRAMES)[:, None, None]
    weight, _ = _weights(filled, covariance, seen)
    return Noise(covariance, inflation, weight)


def stated(residual, rate_hz, correlation_s):
    """Return the noise as stated, every frame with its full weight: to begin with.

    Residuals of a skeleton that is not yet corrected would pass for noise, and then no correction would
    ever be worth it.

    Parameters
    ----------
    residual : (N, D, 3) float
        NaN where vision has no joint.
    rate_hz, correlation_s : float
        As for `estimate`.

    Returns
    -------
    noise : Noise
    """
    n_joints = residual.shape[1]
    inflation = np.full(n_joints, _floor(rate_hz, correlation_s))
    weight = np.isfinite(residual).all(axis=2).astype(float)
    return Noise(np.tile(np.eye(3), (n_joints, 1, 1)), inflation, weight)


def _start(filled, seen):
    length = np.sum(filled**2, axis=2) / 3
    typical = [np.median(length[at, d]) if at.any() else 1.0 for d, at in enumerate(seen.T)]
    return np.maximum(typical, 1e-3)[:, None, None]


def _floor(rate_hz, correlation_s):
    alike = np.exp(-1 / max(rate_hz * correlation_s, 1e-6))
    return (1 + alike) / (1 - alike)


def _weights(filled, covariance, seen):
    root = np.linalg.cholesky(np.linalg.inv(covariance)).swapaxes(1, 2)
    white = np.einsum("dij,ndj->ndi", root, filled)
    squared = np.sum(white**2, axis=2)
    return seen * (TAIL + 3) / (TAIL + squared), white


def _inflation(white, weight, seen, rate_hz):
    """Return the frames per independent one, (D,), of noise that is white and Ornstein-Uhlenbeck.

    From short lags alone: over long ones the fit has taken up part of the noise.
    """
    tamed = white * np.sqrt(weight)[..., None]
    near, far = 1, max(2, round(SHORT_S * rate_hz))
    if len(white) <= far:
        return np.ones(white.shape[1])
    power = np.sum(tamed**2, axis=(0, 2)) / np.maximum(seen.sum(axis=0), 1)
    alike = {}
    for lag in (near, far):
        both = np.maximum((seen[lag:] & seen[:-lag]).sum(axis=0), 1)
        product = np.sum(tamed[lag:] * tamed[:-lag], axis=(0, 2)) / both
        alike[lag] = np.clip(product / np.maximum(power, 1e-12), 1e-3, 1.0)
    decay = (alike[far] / alike[near]) ** (1 / (far - near))
    decay = np.minimum(decay, np.exp(-1 / (LONGEST_S * rate_hz)))
    coloured = np.minimum(alike[near] / np.maximum(decay, 1e-3), 1.0)
    return 1 - coloured + coloured * (1 + decay) / (1 - decay)
