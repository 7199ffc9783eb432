"""What vision and a skeleton share, and the faults that are refused in one line."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.inertial import fit
from courtside.records.keypoints.skeleton import JOINTS as LIMB_JOINTS
from courtside.study.errors import InputError
from fixtures.people import moved_bodies

BODY = moved_bodies.moving(0, seconds=3.0)
VISION = moved_bodies.seen(BODY, missing=0.1)


def test_joints_frames_and_gaps_are_kept():
    sigma = np.full(VISION.xyz.shape[:2], 0.02)
    sigma[3, 4], sigma[5, 6] = np.nan, 0.0
    found = fit.observe(BODY, VISION, sigma)
    assert found.joints == LIMB_JOINTS
    wanted = VISION.xyz.copy()
    wanted[3, 4] = wanted[5, 6] = np.nan
    assert np.array_equal(found.xyz, wanted, equal_nan=True)
    used = np.isfinite(wanted).all(axis=2)
    assert (found.sigma_m[used] == 0.02).all() and np.isfinite(found.sigma_m).all()


def test_joints_are_found_by_name_not_by_place():
    order = np.random.default_rng(0).permutation(12)
    mixed = replace(VISION, joints=VISION.joints[order], xyz=VISION.xyz[:, order])
    found = fit.observe(BODY, mixed, 0.02)
    assert np.array_equal(found.xyz, VISION.xyz, equal_nan=True)


def test_frames_outside_the_recording_are_left_out():
    late = replace(VISION, time_s=VISION.time_s + 1.0)
    found = fit.observe(BODY, late, 0.02)
    assert found.time_s.max() <= BODY.time_s[-1]
    assert len(found.time_s) < len(VISION.time_s)


def test_clocks_that_do_not_meet_are_named():
    far = replace(VISION, time_s=VISION.time_s + 100)
    with pytest.raises(
        InputError, match=r"d415-depth: expected 30 frames .* found 0; check the clocks"
    ):
        fit.observe(BODY, far, 0.02)


def test_a_skeleton_without_place_is_refused():
    with pytest.raises(InputError, match="about its own hips"):
        fit.observe(BODY, replace(VISION, kind="rgb"), 0.02)
