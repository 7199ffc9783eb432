"""Limbs keep their length: joints move to where they can be, as far as their uncertainty allows."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.reconstruction import joint_correction
from courtside.records.keypoints import keypoints

ARM = ("left_shoulder", "left_elbow", "left_wrist")
UPPER_M, FOREARM_M = 0.30, 0.26


def arms(n_frames, seed, sigma_m=(0.01, 0.05, 0.01)):
    """Return true places (T, 3, 3) of an arm that swings about, and the same with noise."""
    rng = np.random.default_rng(seed)
    way = rng.normal(size=(2, n_frames, 3))
    way /= np.linalg.norm(way, axis=-1, keepdims=True)
    shoulder = rng.normal(size=(n_frames, 3))
    elbow = shoulder + UPPER_M * way[0]
    true = np.stack([shoulder, elbow, elbow + FOREARM_M * way[1]], axis=1)
    noise = rng.normal(size=true.shape) * np.array(sigma_m)[:, None]
    return true, true + noise


def record(xyz, sigma_m=(0.01, 0.05, 0.01)):
    n_frames = len(xyz)
    covariance = np.array(sigma_m)[:, None, None] ** 2 * np.eye(3)
    shape = (1, n_frames, 3)
    return keypoints.Keypoints3D(
        cameras=np.array(["a", "b"]),
        model="net",
        joints=np.array(ARM),
        person_id=np.array(["p1"]),
        time_s=np.arange(n_frames) / 30,
        xyz=xyz[None],
        covariance_2d=np.broadcast_to(covariance, (*shape, 3, 3)).copy(),
        covariance_camera=np.full((*shape, 3, 3), np.nan),
        n_views=np.full(shape, 2),
        reproj_error_px=np.zeros((*shape, 2)),
        accepted=np.ones((*shape, 2), dtype=bool),
        reason=np.zeros(shape, dtype=np.uint8),
    )


def test_lengths_are_those_of_the_body_in_spite_of_noise_and_gaps():
    _, noisy = arms(2000, seed=1, sigma_m=(0.01, 0.01, 0.01))
    noisy[::3, 1] = np.nan
    found = joint_correction.lengths(noisy, ARM)
    assert found["shoulder", "elbow"] == pytest.approx(UPPER_M, rel=0.01)
    assert found["elbow", "wrist"] == pytest.approx(FOREARM_M, rel=0.01)
    assert set(found) == {("shoulder", "elbow"), ("elbow", "wrist")}
    assert joint_correction.lengths(noisy[:4], ARM) == {}


def test_an_uncertain_elbow_comes_nearer_to_the_truth_and_certain_joints_stay():
    true, noisy = arms(800, seed=2)
    kept = joint_correction.keep(record(noisy)).xyz[0]
    before, after = (np.linalg.norm(xyz - true, axis=2) for xyz in (noisy, kept))
    assert np.median(after[:, 1]) < 0.85 * np.median(before[:, 1])
    assert np.percentile(after[:, 1], 95) < 0.85 * np.percentile(before[:, 1], 95)
    assert np.median(after[:, [0, 2]]) < 1.05 * np.median(before[:, [0, 2]])


def test_only_the_joint_that_is_uncertain_moves_and_only_along_the_limb():
    true, _ = arms(200, seed=3)
    moved = true.copy()
    stretch = np.where(np.arange(200) % 10 == 0, 1.3, 1.0)  # every tenth forearm is too long
    moved[:, 2] = true[:, 1] + stretch[:, None] * (true[:, 2] - true[:, 1])
    sigma_m = (1e-4, 1e-4, 0.5)
    kept = joint_correction.keep(record(moved, sigma_m)).xyz[0]
    np.testing.assert_allclose(kept[:, :2], true[:, :2], atol=1e-5)
    np.testing.assert_allclose(kept[:, 2], true[:, 2], atol=1e-4)


def test_a_skeleton_that_is_right_stays_as_it_is():
    true, _ = arms(50, seed=4)
    np.testing.assert_allclose(joint_correction.keep(record(true)).xyz[0], true, atol=1e-9)


def test_what_is_missing_stays_missing_and_holds_nothing_else_up():
    _, noisy = arms(400, seed=5)
    noisy[::2, 2] = np.nan
    points = record(noisy)
    points.covariance_2d[:, 100:] = np.nan
    kept = joint_correction.keep(points)
    np.testing.assert_array_equal(np.isnan(kept.xyz), np.isnan(points.xyz))
    np.testing.assert_array_equal(kept.covariance_2d, points.covariance_2d)
    length = np.linalg.norm(kept.xyz[0, ::2, 1] - kept.xyz[0, ::2, 0], axis=1)
    assert np.std(length) < 0.5 * np.std(np.linalg.norm(noisy[::2, 1] - noisy[::2, 0], axis=1))


def test_limbs_that_nobody_knows_and_other_joints_stay():
    _, noisy = arms(5, seed=6)  # too few frames for a length
    np.testing.assert_array_equal(joint_correction.keep(record(noisy)).xyz[0], noisy)
    few = replace(record(arms(50, seed=7)[1]), joints=np.array(["nose", *ARM[1:]]))
    kept = joint_correction.keep(few)
    np.testing.assert_array_equal(kept.xyz, few.xyz)


def test_the_turn_of_the_world_does_not_matter():
    _, noisy = arms(60, seed=8)
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    straight = joint_correction.keep(record(noisy)).xyz @ turn.T
    np.testing.assert_allclose(
        joint_correction.keep(record(noisy @ turn.T)).xyz, straight, atol=1e-9
    )
