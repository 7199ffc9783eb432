"""The filtered skeleton of a take, which is exported and used for all kinematics."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.kinematics import filtering, noise_propagation
from courtside.records.keypoints.keypoints import Keypoints3D


def prepare(raw: Keypoints3D, max_gap_s: float) -> Keypoints3D:
    """Return the input of the filter: raw keypoints without uncertain frames, short gaps filled.

    See `filtering.leave_out_uncertain` and `filtering.fill_gaps`.
    """
    return filtering.fill_gaps(filtering.leave_out_uncertain(raw), max_gap_s)


def smooth(points: Keypoints3D, cutoff_hz: ArrayLike, order: int) -> Keypoints3D:
    """Remove noise with a zero-lag Butterworth low-pass filter, each joint with its own cut-off.

    `points` are of `prepare`, with uniform times. `cutoff_hz` (J,) is the -3 dB frequency of the
    whole, forwards and backwards, filter, below half the frame rate; `order` its effective order,
    of which each pass has half, even. Runs of finite values are filtered one by one, and the same
    values stay missing; runs of one or two frames stay as they are.
    `covariance_2d` is that of the filtered noise, by the noise model of each joint's own path
    (`noise_propagation.estimate`); it stays unknown where it was, as in filled gaps.
    `covariance_network` grows where the filter spreads larger errors of neighbouring frames
    (`_spread`). It never decreases, because these errors last longer than the filter's impulse
    response.
    """
    xyz, covariance = smooth_xyz(points, cutoff_hz, order), points.covariance_2d.copy()
    if len(points.time_s) < 2:
        return points
    network = points.covariance_network.copy()
    each_hz = np.broadcast_to(np.asarray(cutoff_hz, dtype=float), points.joints.shape)
    for person, joint in np.ndindex(xyz.shape[0], xyz.shape[2]):
        covariance[person, :, joint] = _covariance(
            points.xyz[person, :, joint],
            points.covariance_2d[person, :, joint],
            points.rate_hz,
            float(each_hz[joint]),
            order,
        )
        network[person, :, joint] = _spread(
            points.covariance_network[person, :, joint],
            points.rate_hz,
            float(each_hz[joint]),
            order,
        )
    return replace(points, xyz=xyz, covariance_2d=covariance, covariance_network=network)


def smooth_xyz(points: Keypoints3D, cutoff_hz: ArrayLike, order: int) -> NDArray:
    """Return the positions (P, T, J, 3) m of `smooth` alone, in a fraction of its time."""
    xyz = points.xyz.copy()
    if len(points.time_s) < 2:
        return xyz
    each_hz = np.broadcast_to(np.asarray(cutoff_hz, dtype=float), points.joints.shape)
    for one_hz in np.unique(each_hz):
        joints = np.flatnonzero(each_hz == one_hz)
        for person in range(len(xyz)):
            xyz[person][:, joints] = filtering.zero_lag_points(
                points.xyz[person][:, joints], points.rate_hz, float(one_hz), order
            )
    return xyz


def _spread(covariance: NDArray, rate_hz: float, cutoff_hz: float, order: int) -> NDArray:
    """Return covariances (T, 3, 3) of errors after a filter that spreads them; none decreases.

    They are isotropic. The standard deviation is the mean of the neighbouring ones with the
    filter's weights, as for fully correlated errors.
    """
    variance = np.trace(covariance, axis1=1, axis2=2) / 3
    weights = noise_propagation.weights(rate_hz, cutoff_hz, order)
    sigma = np.nan_to_num(np.sqrt(variance))
    around = np.convolve(np.pad(sigma, len(weights) // 2, mode="edge"), weights, mode="valid")
    return covariance + np.maximum(around**2 - variance, 0.0)[:, None, None] * np.eye(3)


def _covariance(
    xyz: NDArray, covariance: NDArray, rate_hz: float, cutoff_hz: float, order: int
) -> NDArray:
    """Return the covariance (T, 3, 3) of one joint's filtered path, from its raw path."""
    stated = np.isfinite(covariance).all(axis=(1, 2))
    if not stated.any():
        return covariance
    known = np.isfinite(xyz).all(axis=1)
    noise = noise_propagation.estimate(xyz, covariance, rate_hz)
    found = noise_propagation.filtered_covariance(
        covariance, known, noise, rate_hz, cutoff_hz, order
    )
    return np.where(stated[:, None, None], found, np.nan)
