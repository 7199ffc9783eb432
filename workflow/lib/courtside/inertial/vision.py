"""What vision tells of the joints that it shares with a skeleton, and the noise of these."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry.interpolation import window
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.hierarchy import PosedHierarchy, held_s
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError

LEAST_FRAMES = 30  # ASSUME: with `LEAST_JOINTS` joints, to be fitted at all
LEAST_JOINTS = 6  # ASSUME: half of the limb joints
TAIL = 4.0  # degrees of freedom of Student's t: a robust estimate (Lange et al. 1989)
ROUNDS = 5  # ASSUME: the noise settles in a few
PRIOR_FRAMES = 5.0  # ASSUME: independent frames that the stated sigma counts for
LONGEST_S = 0.5  # memory of the noise: beyond, it cannot be told from a slow error of the device
SHORT_S = 0.1  # ASSUME: lag at which the memory is read


@dataclass(frozen=True, eq=False)
class Seen:
    """What vision tells of the joints that it shares with a skeleton."""

    source: str
    joints: tuple[str, ...]  # length D
    time_s: NDArray  # (N,)
    xyz: NDArray  # (N, D, 3): metres, in vision's frame; NaN where missing
    sigma_m: NDArray  # (N, D): standard deviation per axis


def observe(posed: PosedHierarchy, vision: DeviceMotion, sigma_m: ArrayLike) -> Seen:
    """Select what vision tells of a skeleton's limbs while it moves, on the same clock.

    Times in which the skeleton repeats one pose, as after a lost link, are left out.
    `sigma_m`, a number or (T, J), is the standard deviation per axis; joints where it is not a
    positive number are not used. An `InputError` if vision has no place in space, or too little in
    common with the skeleton.
    """
    if vision.kind == "rgb":
        raise InputError(
            f"{vision.source}: expected joints with a place in space, found a skeleton about its "
            "own hips (kind rgb); correct by a depth camera or by several cameras"
        )
    names = list(posed.hierarchy.joints)
    joints = [name for name in skeleton.JOINTS if name in names and name in vision.joints]
    columns = [list(vision.joints).index(name) for name in joints]
    inside = (vision.time_s >= posed.time_s[0]) & (vision.time_s <= posed.time_s[-1])
    inside &= vision.performed
    for first, last in held_s(posed):
        inside &= (vision.time_s <= first) | (vision.time_s > last)
    sigma = np.broadcast_to(np.asarray(sigma_m, float), vision.xyz.shape[:2])[inside][:, columns]
    xyz = vision.xyz[inside][:, columns]
    usable = np.isfinite(xyz).all(axis=2) & np.isfinite(sigma) & (sigma > 0)
    frames = (usable.sum(axis=1) >= LEAST_JOINTS).sum()
    if frames < LEAST_FRAMES:
        raise InputError(
            f"{vision.source}: expected {LEAST_FRAMES} frames with {LEAST_JOINTS} limb joints "
            f"during the inertial recording, found {frames}; check the clocks, what the camera "
            "saw, and whether the suit repeats one pose"
        )
    xyz, sigma = np.where(usable[..., None], xyz, np.nan), np.where(usable, sigma, 1.0)
    return Seen(vision.source, tuple(joints), vision.time_s[inside], xyz, sigma)


@dataclass(frozen=True, eq=False)
class Noise:
    """Noise of each joint of vision."""

    covariance: NDArray  # (D, 3, 3): of residuals divided by their stated sigma
    inflation: NDArray  # (D,): frames that tell as much as one independent frame would
    # (N, D): 1 for a frame as expected, towards 0 for an outlier; 0 where there is no residual.
    weight: NDArray

    def whitening(self) -> NDArray:
        """Return (N, D, 3, 3): multiply residuals over sigma by it and sum the squares."""
        root = np.linalg.cholesky(np.linalg.inv(self.covariance)).swapaxes(1, 2)
        return np.sqrt(self.weight / self.inflation)[..., None, None] * root


def estimate_noise(residual: NDArray, rate_hz: float, correlation_s: float) -> Noise:
    """Estimate the noise of vision from residuals (N, D, 3) of a fit, over the stated sigma.

    NaN where vision has no joint. `correlation_s` is the least correlation time of a network's
    errors; the residuals may show a longer one.
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


def stated_noise(residual: NDArray, rate_hz: float, correlation_s: float) -> Noise:
    """Return the noise as stated, every frame with its full weight, for the first rounds.

    Residuals of a skeleton that is not yet corrected would count as noise, and then no correction
    would pay. The parameters are those of `estimate_noise`.
    """
    n_joints = residual.shape[1]
    inflation = np.full(n_joints, _floor(rate_hz, correlation_s))
    weight = np.isfinite(residual).all(axis=2).astype(float)
    return Noise(np.tile(np.eye(3), (n_joints, 1, 1)), inflation, weight)


def _start(filled: NDArray, seen: NDArray) -> NDArray:
    length = np.sum(filled**2, axis=2) / 3
    typical = [np.median(length[at, d]) if at.any() else 1.0 for d, at in enumerate(seen.T)]
    return np.maximum(typical, 1e-3)[:, None, None]


def _floor(rate_hz: float, correlation_s: float) -> float:
    alike = np.exp(-1 / max(rate_hz * correlation_s, 1e-6))
    return (1 + alike) / (1 - alike)


def _weights(filled: NDArray, covariance: NDArray, seen: NDArray) -> tuple[NDArray, NDArray]:
    root = np.linalg.cholesky(np.linalg.inv(covariance)).swapaxes(1, 2)
    white = np.einsum("dij,ndj->ndi", root, filled)
    squared = np.sum(white**2, axis=2)
    return seen * (TAIL + 3) / (TAIL + squared), white


def _inflation(white: NDArray, weight: NDArray, seen: NDArray, rate_hz: float) -> NDArray:
    """Return the frames per independent one (D,) of noise that is white and Ornstein-Uhlenbeck.

    From short lags alone: over long ones the fit has absorbed part of the noise.
    """
    tamed = white * np.sqrt(weight)[..., None]
    near, far = 1, max(2, window(SHORT_S, rate_hz))
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
