import tracemalloc
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from courtside.body_model import fit, take
from courtside.records.devices import hierarchy
from courtside.records.keypoints import missing_reason, skeleton
from fixtures.people import moving_model

HZ = dict.fromkeys(moving_model.JOINTS, 8.0)


def fitted(points):
    found = take.person(points, 0, HZ, height_m=1.75)
    return {} if found is None else {0: found}


def test_joints_get_constant_bones_near_where_they_were():
    points = moving_model.points(moving_model.moving(), noise_m=0.01)
    found = take.joints(points, fitted(points))
    names = found.joints.tolist()
    for side in ("left", "right"):
        for start, stop in (("hip", "knee"), ("elbow", "wrist"), ("ankle", "heel")):
            ends = [names.index(f"{side}_{part}") for part in (start, stop)]
            length = np.linalg.norm(np.subtract(*(found.xyz[0][:, at] for at in ends)), axis=1)
            assert np.ptp(length) < 1e-9
    true = moving_model.points(moving_model.moving()).xyz
    before, after = (np.linalg.norm(one.xyz - true, axis=-1) for one in (points, found))
    assert np.median(after) < 0.9 * np.median(before)
    assert np.linalg.eigvalsh(found.covariance[0]).min() > 0


def test_an_arm_whose_plane_turns_once_by_errors_of_a_few_frames_does_not_turn_with_it():
    points = moving_model.points(moving_model.moving(), noise_m=0.02)
    names, xyz = points.joints.tolist(), points.xyz.copy()
    for at in range(31, 35):
        start, elbow, wrist = (
            xyz[0, at, names.index(f"left_{part}")] for part in ("shoulder", "elbow", "wrist")
        )
        axis = (elbow - start) / np.linalg.norm(elbow - start)
        turn = Rotation.from_rotvec(2 * np.pi * (at - 30) / 5 * axis)
        xyz[0, at, names.index("left_wrist")] = elbow + turn.apply(wrist - elbow)
    found = fitted(replace(points, xyz=xyz))[0].pose.local[moving_model.NAMES.index("left_humerus")]
    steps = Rotation.from_matrix(np.swapaxes(found[:-1], 1, 2) @ found[1:]).as_rotvec()
    assert abs(np.degrees(steps[20:45, 1].sum())) < 60  # but 360 if it turns around itself


def test_joints_in_parts_of_a_take_are_the_same_and_need_less_memory(monkeypatch):
    points, found, most = moving_model.points(moving_model.moving(50), noise_m=0.01), [], []
    for frames in (1000, 8):
        monkeypatch.setattr(fit, "CHUNK", frames)
        fits = fitted(points)
        tracemalloc.start()
        record = take.joints(points, fits)
        most.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        found.append([record.xyz, record.covariance])
    for whole, parts in zip(*found, strict=True):
        np.testing.assert_array_equal(parts, whole)
    assert most[1] < most[0] / 3


def test_a_network_s_lasting_shift_is_stated_and_a_record_without_network_has_none():
    points = moving_model.points(moving_model.moving(), noise_m=0.01)
    fits = fitted(points)
    bare = replace(points, covariance_network=np.zeros_like(points.covariance_network))
    found = [take.joints(one, fits).covariance_network[0] for one in (points, bare)]
    more = np.sqrt(np.trace(found[0] - found[1], axis1=2, axis2=3) / 3)
    for name, each in zip(points.joints.tolist(), more.T, strict=True):
        np.testing.assert_allclose(each, take.SHIFT_M.get(name.partition("_")[2], 0.0), atol=1e-9)


def test_angles_of_recorded_people_hold_a_constant_error_of_each_joint_and_the_joints_do_not_move():
    body, rng = moving_model.points(moving_model.moving(12)), np.random.default_rng(0)
    sigma_m = np.array([0.036 if "hip" in name else 0.025 for name in body.joints]) / np.sqrt(3)
    network = np.broadcast_to(np.square(sigma_m)[:, None, None] * np.eye(3), (*body.xyz.shape, 3))
    body = replace(body, covariance_network=network.copy())
    names = [f"{side}_{part}" for side in ("left", "right") for part in ("knee", "elbow")]
    clean, inside = angles_of(body, names)[0], {False: [], True: []}
    for _ in range(10):
        error = sigma_m[:, None] * rng.standard_normal(body.xyz.shape[2:])
        moved, poses = replace(body, xyz=body.xyz + error), []
        for recorded, held in inside.items():
            degrees, sigma = angles_of(moved, names, recorded=recorded)
            held.append(np.abs(degrees - clean) < 1.645 * sigma)
            poses.append(degrees)
        np.testing.assert_array_equal(*poses)
    assert np.mean(inside[False]) < 0.6
    assert 0.8 < np.mean(inside[True]) < 0.97


def angles_of(points, names, **options):
    """Return the flexions (T, A) degrees of a fit, and their standard deviations."""
    found = take.people(points, HZ, {"a": 1.75}, **options)
    motion = take.motion(points, found)
    at = [motion.angles.tolist().index(f"{name}_flexion") for name in names]
    return motion.angle_deg[0][:, at], motion.angle_sigma_deg[0][:, at]


def test_joints_on_no_segment_are_left_out_of_the_model_s_joints():
    body = moving_model.points(moving_model.moving(20))
    first = [0] * 2  # two places of the face, seen in all frames
    jaw = replace(body.some_joints(first), joints=np.array(["right_jaw_1", "left_jaw_1"]))
    keys = [key for key in vars(body) if getattr(body, key).__class__ is np.ndarray]
    both = {
        key: np.concatenate([getattr(jaw, key), getattr(body, key)], axis=2)
        for key in keys
        if getattr(body, key).shape[:3] == body.xyz.shape[:3]
    }
    points = replace(body, joints=np.concatenate([jaw.joints, body.joints]), **both)
    found, alone = (take.joints(one, fitted(one)) for one in (points, body))
    assert found.joints.tolist() == body.joints.tolist()
    np.testing.assert_allclose(found.xyz, alone.xyz)
    assert (found.reason == missing_reason.OK).all()


def test_missing_joints_stay_missing_and_frames_without_a_person_are_not_made():
    points = moving_model.points(moving_model.moving(), noise_m=0.005)
    wrist = points.joints.tolist().index("left_wrist")
    xyz, reason = points.xyz.copy(), points.reason.copy()
    xyz[0, 10:20, wrist] = np.nan
    reason[0, 10:20, wrist] = missing_reason.REJECTED
    xyz[0, :5] = np.nan
    xyz[0, 4, 0] = 1.0
    points = replace(points, xyz=xyz, reason=reason)
    fits = fitted(points)
    found = take.joints(points, fits)
    assert np.isnan(found.xyz[0, 10:20, wrist]).all()
    assert (found.reason[0, 10:20, wrist] == missing_reason.REJECTED).all()
    assert np.isnan(found.xyz[0, :5]).all()
    assert found.reason[0, 4, 0] == missing_reason.UNCERTAIN
    assert found.n_views[0, 4, 0] == 0 and not found.accepted[0, 4, 0].any()
    np.testing.assert_array_equal(found.n_views[0, 5:], points.n_views[0, 5:])
    motion = take.motion(points, fits)
    at = motion.angles.tolist().index("left_elbow_flexion")
    assert np.isnan(motion.angle_deg[0, :5]).all()
    assert motion.angle_sigma_deg[0, 15, at] > 3 * motion.angle_sigma_deg[0, 40, at]


def test_a_joint_that_is_seen_only_outside_of_the_fitted_frames_leaves_its_person_out(caplog):
    both = moving_model.points(moving_model.moving(20))
    names, xyz = both.joints.tolist(), np.concatenate([both.xyz] * 2)
    limbs = [names.index(name) for name in skeleton.JOINTS]
    wrist = names.index("left_wrist")
    xyz[0, 5:, wrist] = np.nan
    xyz[0, :5, [at for at in limbs if at != wrist]] = np.nan
    others = {
        key: np.concatenate([getattr(both, key)] * 2)
        for key in ("covariance_2d", "covariance_network", "reason")
    }
    both = replace(both, person_id=np.array(["m1", "f1"]), xyz=xyz, **others)
    assert list(take.people(both, HZ, {})) == [1]
    assert (
        "m1: the skeletal model cannot be fitted: never seen while 6 limb joints are: left_wrist"
        in caplog.text
    )
    xyz[0, 5:, limbs[5:]] = np.nan
    assert list(take.people(both, HZ, {})) == [1]
    assert "6 limb joints are seen together in fewer than two frames" in caplog.text


def test_the_motion_has_the_joints_by_forward_kinematics():
    points = moving_model.points(moving_model.moving(), noise_m=0.005)
    fits = fitted(points)
    found, motion = take.joints(points, fits), take.motion(points, fits)
    posed, frames = motion.posed(0)
    xyz, _ = hierarchy.forward(posed)
    knee = xyz[:, motion.segments.tolist().index("right_tibia")]
    names = found.joints.tolist()
    np.testing.assert_allclose(knee, found.xyz[0, frames][:, names.index("right_knee")], atol=1e-9)


def test_a_person_who_leaves_and_comes_back_has_no_motion_while_away(caplog):
    caplog.set_level("INFO", logger="courtside")
    points = moving_model.points(moving_model.moving(), noise_m=0.002)
    xyz = points.xyz.copy()
    xyz[0, 20:32] = np.nan  # 0.4 s
    xyz[0, 31, points.joints.tolist().index("left_heel")] = 1.0
    xyz[0, 40:44] = np.nan  # 0.13 s
    points = replace(points, xyz=xyz)
    motion = take.motion(points, fitted(points), max_gap_s=0.2)
    away = np.zeros(60, dtype=bool)
    away[20:32] = True
    for values in (motion.root, motion.angle_deg, motion.angle_sigma_deg):
        np.testing.assert_array_equal(np.isnan(values[0]).any(axis=1), away)
    np.testing.assert_array_equal(motion.posed(0)[1], ~away)  # what exports write
    (line,) = (line for line in caplog.messages if "no motion" in line)
    assert line == "a: no limb joint is seen from 0.67 to 1.03 s: no motion there"


def test_a_person_who_is_never_seen_has_no_motion():
    points = moving_model.points(moving_model.moving(4))
    points = replace(points, xyz=np.full_like(points.xyz, np.nan))
    assert fitted(points) == {}
    motion = take.motion(points, {})
    assert np.isnan(motion.root).all()
    assert np.isnan(take.joints(points, {}).xyz).all()
    assert set(skeleton.JOINTS) <= set(motion.joints.tolist())


def test_a_body_whose_heels_are_never_seen_is_fitted():
    points = moving_model.points(moving_model.moving(), noise_m=0.005)
    heels = [at for at, name in enumerate(points.joints.tolist()) if "heel" in name]
    xyz, reason = points.xyz.copy(), points.reason.copy()
    xyz[:, :, heels] = np.nan
    reason[:, :, heels] = missing_reason.UNSEEN
    points = replace(points, xyz=xyz, reason=reason)
    found = take.joints(points, fitted(points))
    assert np.isnan(found.xyz[0, :, heels]).all()
    others = [at for at in range(len(points.joints)) if at not in heels]
    apart_m = np.linalg.norm(found.xyz - points.xyz, axis=-1)[:, :, others]
    assert np.median(apart_m) < 0.02
