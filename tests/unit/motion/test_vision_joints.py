"""What vision and a skeleton share, and the faults that are refused in one line."""

from dataclasses import replace

import numpy as np
import pytest

import moved_bodies
from courtside.motion import vision_joints
from courtside.motion.body_segments import LIMB_JOINTS
from courtside.records import reasons
from courtside.records.keypoints import Keypoints3D
from courtside.study.errors import InputError

BODY = moved_bodies.moving(0, seconds=3.0)
VISION = moved_bodies.seen(BODY, missing=0.1)


def test_joints_frames_and_gaps_are_kept():
    sigma = np.full(VISION.xyz.shape[:2], 0.02)
    sigma[3, 4], sigma[5, 6] = np.nan, 0.0
    found = vision_joints.observe(BODY, VISION, sigma)
    assert found.joints == LIMB_JOINTS
    wanted = VISION.xyz.copy()
    wanted[3, 4] = wanted[5, 6] = np.nan
    assert np.array_equal(found.xyz, wanted, equal_nan=True)
    used = np.isfinite(wanted).all(axis=2)
    assert (found.sigma_m[used] == 0.02).all() and np.isfinite(found.sigma_m).all()


def test_joints_are_found_by_name_not_by_place():
    order = np.random.default_rng(0).permutation(12)
    mixed = replace(VISION, joints=VISION.joints[order], xyz=VISION.xyz[:, order])
    found = vision_joints.observe(BODY, mixed, 0.02)
    assert np.array_equal(found.xyz, VISION.xyz, equal_nan=True)


def test_frames_outside_the_recording_are_left_out():
    late = replace(VISION, time_s=VISION.time_s + 1.0)
    found = vision_joints.observe(BODY, late, 0.02)
    assert found.time_s.max() <= BODY.time_s[-1]
    assert len(found.time_s) < len(VISION.time_s)


def test_clocks_that_do_not_meet_are_named():
    far = replace(VISION, time_s=VISION.time_s + 100)
    with pytest.raises(
        InputError, match=r"d415-depth: expected 30 frames .* found 0; check the clocks"
    ):
        vision_joints.observe(BODY, far, 0.02)


def test_a_skeleton_without_place_is_refused():
    with pytest.raises(InputError, match="about its own hips"):
        vision_joints.observe(BODY, replace(VISION, kind="rgb"), 0.02)


def test_cameras_become_vision():
    n, d = 4, len(LIMB_JOINTS)
    rng = np.random.default_rng(1)
    xyz = rng.normal(size=(2, n, d, 3))
    variances = np.array([1e-4, 4e-4, 9e-4])
    covariance = np.tile(np.diag(variances), (2, n, d, 1, 1))
    reason = np.zeros((2, n, d), int)
    reason[1, 2, 3] = reasons.REJECTED
    points = Keypoints3D(
        cameras=np.array(["a", "b"]),
        model="m",
        joints=np.array(LIMB_JOINTS),
        person_id=np.array(["p1", "p2"]),
        time_s=np.arange(n) / 30,
        xyz=xyz,
        covariance_2d=covariance,
        covariance_camera=covariance,
        n_views=np.full((2, n, d), 2),
        reproj_error_px=np.zeros((2, n, d, 2)),
        accepted=np.ones((2, n, d, 2), bool),
        reason=reason,
    )
    vision, sigma = vision_joints.of_cameras(points, "p2")
    assert np.isnan(vision.xyz[2, 3]).all() and np.isnan(sigma[2, 3])
    assert vision.xyz[0] == pytest.approx(xyz[1, 0])
    assert sigma[0, 0] == pytest.approx(np.sqrt(variances.mean()))
    assert vision.kind == "cameras"
