"""Noise of known spread and memory, with outliers, is found from its residuals."""

import numpy as np
import pytest

from courtside.inertial import fit

N, D, RATE_HZ = 4000, 3, 30.0
SPREAD = np.array([[0.5, 0, 0], [0.1, 1.0, 0], [0, 0.3, 2.0]])


def drawn(memory_s, seed=0):
    rng = np.random.default_rng(seed)
    keep = np.exp(-1 / (RATE_HZ * memory_s)) if memory_s else 0.0
    noise = rng.standard_normal((N, D, 3))
    for frame in range(1, N):
        noise[frame] = keep * noise[frame - 1] + np.sqrt(1 - keep**2) * noise[frame]
    return noise @ SPREAD.T


def test_spread_is_found_with_outliers():
    residual = drawn(0.0)
    wild = np.random.default_rng(1).uniform(size=(N, D)) < 0.03
    residual[wild] *= 30
    found = fit.estimate_vision_noise(residual, RATE_HZ, 0.01)
    # Student's t of 4 degrees of freedom: its scatter is somewhat below the covariance of normal noise.
    ratio = np.linalg.eigvals(found.covariance @ np.linalg.inv(SPREAD @ SPREAD.T)).real
    assert ratio.min() > 0.6 and ratio.max() < 1.1
    assert found.weight[wild].mean() < 0.25
    assert found.weight[~wild].mean() > 0.95


@pytest.mark.parametrize("memory_s", [0.2, 0.4])
def test_memory_is_found(memory_s):
    found = fit.estimate_vision_noise(drawn(memory_s), RATE_HZ, 0.05)
    keep = np.exp(-1 / (RATE_HZ * memory_s))
    assert found.inflation == pytest.approx((1 + keep) / (1 - keep), rel=0.3)


def test_stated_memory_is_the_least():
    found = fit.estimate_vision_noise(drawn(0.0), RATE_HZ, 0.1)
    keep = np.exp(-1 / 3)
    assert found.inflation == pytest.approx((1 + keep) / (1 - keep))


def test_a_joint_never_seen_has_no_weight():
    residual = drawn(0.0)
    residual[:, 1] = np.nan
    found = fit.estimate_vision_noise(residual, RATE_HZ, 0.1)
    assert found.weight[:, 1].max() == 0
    assert np.isfinite(found.whitening()).all()
    assert found.covariance[1] == pytest.approx(np.eye(3))


def test_whitened_residuals_are_of_unit_size():
    residual = drawn(0.0)
    found = fit.estimate_vision_noise(residual, RATE_HZ, 0.1)
    white = found.whitening() @ residual[..., None]
    squares = np.sum(white**2, axis=(0, 2, 3)) * found.inflation / N
    assert squares == pytest.approx(3.0, rel=0.1)  # what Student's t makes equal to the dimensions


def test_stated_noise_takes_every_frame_whole():
    residual = drawn(0.0)
    residual[5, 2] = np.nan
    found = fit.stated(residual, RATE_HZ, 0.1)
    assert found.weight.sum() == N * D - 1 and found.weight[5, 2] == 0
    assert found.covariance == pytest.approx(np.tile(np.eye(3), (D, 1, 1)))
