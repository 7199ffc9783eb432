from dataclasses import replace

import numpy as np
import pytest

from courtside.body_model import source, take
from courtside.records.keypoints import missing_reason, skeleton
from fixtures.people import moving_model

SIGMA_M = {"shoulder": 0.02, "elbow": 0.03, "wrist": 0.03, "hip": 0.02, "knee": 0.02, "ankle": 0.02}


def record(**options):
    return moving_model.points(moving_model.moving(), **options)


def test_limb_joints_have_the_stated_error_and_others_none():
    points = source.observed(record(), SIGMA_M)
    names = points.joints.tolist()
    elbow, heel = names.index("left_elbow"), names.index("left_heel")
    np.testing.assert_allclose(points.covariance[0, 3, elbow], 0.03**2 * np.eye(3))
    assert np.isnan(points.covariance_network[0, :, heel]).all()
    total, noise = take.errors(points, 0)
    np.testing.assert_allclose(total[:, heel], np.tile(take.UNKNOWN_M**2 * np.eye(3), (60, 1, 1)))
    np.testing.assert_allclose(noise[:, elbow], np.tile(0.03**2 * np.eye(3), (60, 1, 1)))


def test_joints_that_the_model_has_not_are_left_out():
    points = record()
    joints = points.joints.copy()
    joints[joints.tolist().index("left_heel")] = "torso_3"
    found = source.observed(replace(points, joints=joints), SIGMA_M)
    assert "torso_3" not in found.joints
    assert found.xyz.shape[2] == len(found.joints) == len(points.joints) - 1


def test_the_middle_of_the_hips_has_not_the_error_of_a_hip():
    points = record()
    joints = points.joints.copy()
    joints[joints.tolist().index("left_heel")] = "mid_hip"
    found = source.observed(replace(points, joints=joints), SIGMA_M)
    at = found.joints.tolist().index("mid_hip")
    assert np.isnan(found.covariance_network[0, :, at]).all()


def test_even_times_stay_as_they_are():
    points = record()
    assert source.even(points) is points


def test_a_lost_frame_is_interpolated_and_a_long_gap_is_not():
    points = record()
    kept = np.setdiff1d(np.arange(len(points.time_s)), [20, 40, 41, 42])
    found = source.even(points.frames(kept))
    np.testing.assert_allclose(found.time_s, points.time_s, atol=1e-9)
    np.testing.assert_allclose(found.xyz[0, 20], points.xyz[0, 20], atol=5e-3)
    assert np.isnan(found.xyz[0, 40:43]).all()
    assert (found.reason[0, 40:43] == missing_reason.UNSEEN).all()
    np.testing.assert_allclose(found.xyz[0, 43:], points.xyz[0, 43:], atol=1e-9)


@pytest.mark.parametrize("made", ["a frame lost", "jitter", "milliseconds"])
def test_neighbours_of_a_missing_joint_stay_where_times_are_not_uniform(made):
    points = record()
    xyz = points.xyz.copy()
    xyz[0, 10::7, 3] = np.nan
    time_s, kept = points.time_s, np.arange(len(points.time_s))
    if made == "a frame lost":
        time_s, kept = np.round(time_s, 6), np.delete(kept, 27)
    elif made == "jitter":
        time_s = time_s + np.random.default_rng(0).uniform(-3e-4, 3e-4, len(time_s))
    elif made == "milliseconds":
        time_s = np.round(time_s, 3)
    found = source.even(replace(points, xyz=xyz, time_s=time_s).frames(kept))
    np.testing.assert_array_equal(np.isnan(found.xyz), np.isnan(xyz))
    missing = np.isnan(xyz[..., 0])
    assert (found.reason[~missing] == missing_reason.OK).all()
    np.testing.assert_allclose(found.xyz[~missing], points.xyz[~missing], atol=5e-3)


def test_times_in_milliseconds_keep_their_frames():
    points = record()
    time_s = np.round(np.arange(len(points.time_s)) / 60, 3)
    found = source.even(replace(points, time_s=time_s))
    assert len(found.time_s) == len(time_s)


def test_frames_off_even_times_are_moved_to_them():
    points = record()
    late = points.time_s + 0.004 * np.sin(np.arange(len(points.time_s)))
    true = np.stack([np.sin(2 * late), np.cos(3 * late), late], axis=1)
    xyz = np.repeat(true[None, :, None], len(points.joints), axis=2)
    found = source.even(replace(points, time_s=late, xyz=xyz))
    assert np.ptp(np.diff(found.time_s)) < 1e-9
    inside = found.time_s[2:-2]
    np.testing.assert_allclose(found.xyz[0, 2:-2, 0, 0], np.sin(2 * inside), atol=6e-4)


def test_noisy_joints_of_a_device_get_constant_bones_and_better_angles():
    true, points = record(), source.observed(record(noise_m=0.02), SIGMA_M)
    fits = take.people(points, dict.fromkeys(moving_model.JOINTS, 8.0), {"a": 1.75})
    found = take.joints(points, fits)
    limbs = [points.joints.tolist().index(joint) for joint in skeleton.JOINTS]
    own = [true.joints.tolist().index(joint) for joint in skeleton.JOINTS]
    before, after = (
        np.linalg.norm(one.xyz[0][:, limbs] - true.xyz[0][:, own], axis=-1)
        for one in (points, found)
    )
    assert np.median(after) < 0.8 * np.median(before)
    motion = take.motion(points, fits)
    assert np.isfinite(motion.angle_sigma_deg).all()


@pytest.mark.parametrize("joint", ["left_hip", "right_wrist"])
def test_a_device_that_never_shows_a_limb_joint_is_not_fitted(joint):
    points = record()
    xyz = points.xyz.copy()
    xyz[:, :, points.joints.tolist().index(joint)] = np.nan
    points = source.observed(replace(points, xyz=xyz), SIGMA_M)
    assert take.people(points, dict.fromkeys(moving_model.JOINTS, 8.0), {}) == {}
    assert np.isnan(take.joints(points, {}).xyz).all()
