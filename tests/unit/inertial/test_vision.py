"""What vision tells: shared joints, and noise of known spread and memory."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.inertial import vision
from courtside.records.keypoints.skeleton import JOINTS as LIMB_JOINTS
from courtside.study.errors import InputError
from fixtures.people import moved_bodies

RECORDED = moved_bodies.moving(0, seconds=3.0)
VISION = moved_bodies.seen(RECORDED, missing=0.1)


def test_joints_frames_and_gaps_are_kept():
    sigma = np.full(VISION.xyz.shape[:2], 0.02)
    sigma[3, 4], sigma[5, 6] = np.nan, 0.0
    found = vision.observe(RECORDED, VISION, sigma)
    assert found.joints == LIMB_JOINTS
    wanted = VISION.xyz.copy()
    wanted[3, 4] = wanted[5, 6] = np.nan
    assert np.array_equal(found.xyz, wanted, equal_nan=True)
    used = np.isfinite(wanted).all(axis=2)
    assert (found.sigma_m[used] == 0.02).all() and np.isfinite(found.sigma_m).all()


def test_joints_are_found_by_name_not_by_place():
    order = np.random.default_rng(0).permutation(12)
    mixed = replace(VISION, joints=VISION.joints[order], xyz=VISION.xyz[:, order])
    found = vision.observe(RECORDED, mixed, 0.02)
    assert np.array_equal(found.xyz, VISION.xyz, equal_nan=True)


def test_frames_outside_the_recording_are_left_out():
    late = replace(VISION, time_s=VISION.time_s + 1.0)
    found = vision.observe(RECORDED, late, 0.02)
    assert found.time_s.max() <= RECORDED.time_s[-1]
    assert len(found.time_s) < len(VISION.time_s)


def test_times_in_which_the_skeleton_repeats_one_pose_are_left_out():
    local = RECORDED.parent_from_joint.copy()
    local[61:121] = local[60]  # 1 to 2 s
    local[140:143] = local[140]  # three frames alike are no lost link
    found = vision.observe(replace(RECORDED, parent_from_joint=local), VISION, 0.02)
    wanted = (VISION.time_s <= 1.0) | (VISION.time_s > 2.0)
    assert np.array_equal(found.time_s, VISION.time_s[wanted])


def test_clocks_that_do_not_meet_are_named():
    far = replace(VISION, time_s=VISION.time_s + 100)
    with pytest.raises(
        InputError, match=r"d415-depth: expected 30 frames .* found 0; check the clocks"
    ):
        vision.observe(RECORDED, far, 0.02)


def test_a_skeleton_without_place_is_refused():
    with pytest.raises(InputError, match="about its own hips"):
        vision.observe(RECORDED, replace(VISION, kind="rgb"), 0.02)


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
    found = vision.estimate_noise(residual, RATE_HZ, 0.01)
    # Student's t of 4 degrees of freedom: its scatter is somewhat below the covariance of normal
    # noise.
    ratio = np.linalg.eigvals(found.covariance @ np.linalg.inv(SPREAD @ SPREAD.T)).real
    assert ratio.min() > 0.6 and ratio.max() < 1.1
    assert found.weight[wild].mean() < 0.25
    assert found.weight[~wild].mean() > 0.95


@pytest.mark.parametrize("memory_s", [0.2, 0.4])
def test_memory_is_found(memory_s):
    found = vision.estimate_noise(drawn(memory_s), RATE_HZ, 0.05)
    keep = np.exp(-1 / (RATE_HZ * memory_s))
    assert found.inflation == pytest.approx((1 + keep) / (1 - keep), rel=0.3)


def test_stated_memory_is_the_least():
    found = vision.estimate_noise(drawn(0.0), RATE_HZ, 0.1)
    keep = np.exp(-1 / 3)
    assert found.inflation == pytest.approx((1 + keep) / (1 - keep))


def test_a_joint_never_seen_has_no_weight():
    residual = drawn(0.0)
    residual[:, 1] = np.nan
    found = vision.estimate_noise(residual, RATE_HZ, 0.1)
    assert found.weight[:, 1].max() == 0
    assert np.isfinite(found.whitening()).all()
    assert found.covariance[1] == pytest.approx(np.eye(3))


def test_whitened_residuals_are_of_unit_size():
    residual = drawn(0.0)
    found = vision.estimate_noise(residual, RATE_HZ, 0.1)
    white = found.whitening() @ residual[..., None]
    squares = np.sum(white**2, axis=(0, 2, 3)) * found.inflation / N
    assert squares == pytest.approx(3.0, rel=0.1)  # what Student's t makes equal to the dimensions


def test_stated_noise_takes_every_frame_whole():
    residual = drawn(0.0)
    residual[5, 2] = np.nan
    found = vision.stated_noise(residual, RATE_HZ, 0.1)
    assert found.weight.sum() == N * D - 1 and found.weight[5, 2] == 0
    assert found.covariance == pytest.approx(np.tile(np.eye(3), (D, 1, 1)))
