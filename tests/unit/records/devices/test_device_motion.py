"""Skeletons of devices between rules."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.records.devices import device_motion
from courtside.records.devices.hierarchy import NO_PARENT, Hierarchy, PosedHierarchy
from courtside.records.keypoints import keypoints, missing_reason
from courtside.study.errors import InputError


def motion():
    xyz = np.arange(24.0).reshape(4, 2, 3)
    xyz[1, 0] = np.nan
    reason = np.zeros((4, 2), dtype=np.uint8)
    reason[1, 0] = missing_reason.NO_DEPTH
    return device_motion.DeviceMotion(
        source="d415-depth",
        kind="rgbd",
        joints=np.array(["left_wrist", "right_wrist"]),
        time_s=np.array([0.0, 0.1, 0.2, 0.35]),
        xyz=xyz,
        reason=reason,
        performed=np.array([False, True, True, True]),
    )


def test_what_is_written_is_read(tmp_path):
    wanted = motion()
    device_motion.write(tmp_path / "motion.npz", wanted)
    found = device_motion.read(tmp_path / "motion.npz")
    assert (found.source, found.kind) == ("d415-depth", "rgbd")
    for key in ("joints", "time_s", "xyz", "reason", "performed"):
        np.testing.assert_array_equal(getattr(found, key), getattr(wanted, key))
    assert found.posed is None


def posed(time_s):
    rng = np.random.default_rng(0)
    shape = Hierarchy(
        ("root", "spine", "arm"),
        np.array([NO_PARENT, 0, 1]),
        rng.normal(size=(3, 3)),
        {"arm": np.array([0.1, 0.2, 0.3])},
    )
    turns = Rotation.random(3 * len(time_s), random_state=1).as_matrix()
    moved = rng.normal(size=(len(time_s), 3, 3))
    return PosedHierarchy(shape, time_s, moved, turns.reshape(-1, 3, 3, 3))


def test_rotations_keep_every_digit(tmp_path):
    wanted = replace(motion(), posed=posed(motion().time_s))
    device_motion.write(tmp_path / "motion.npz", wanted)
    found = device_motion.read(tmp_path / "motion.npz").posed
    assert found.hierarchy.joints == wanted.posed.hierarchy.joints
    assert list(found.hierarchy.ends) == ["arm"]
    np.testing.assert_array_equal(found.hierarchy.ends["arm"], [0.1, 0.2, 0.3])
    for key in ("parents", "offsets"):
        np.testing.assert_array_equal(
            getattr(found.hierarchy, key), getattr(wanted.posed.hierarchy, key)
        )
    for key in ("time_s", "translation", "parent_from_joint"):
        np.testing.assert_array_equal(getattr(found, key), getattr(wanted.posed, key))


def test_rotations_at_other_times_than_the_joints_are_refused(tmp_path):
    with pytest.raises(ValueError, match="at the times"):
        device_motion.write(
            tmp_path / "motion.npz", replace(motion(), posed=posed(motion().time_s + 1))
        )


def test_a_file_whose_tree_has_a_loop_is_refused(tmp_path):
    path = tmp_path / "motion.npz"
    device_motion.write(path, replace(motion(), posed=posed(motion().time_s)))
    arrays = dict(np.load(path))
    np.savez(path, **arrays | {"parents": np.array([2, 0, 1])})
    with pytest.raises(InputError, match=r"motion\.npz: expected joints whose parents"):
        device_motion.read(path)


def test_a_joint_is_found_by_its_name():
    np.testing.assert_array_equal(motion().joint("right_wrist")[2], [15.0, 16.0, 17.0])
    with pytest.raises(ValueError, match="not in list"):
        motion().joint("nose")


def test_another_file_is_refused(tmp_path):
    np.savez(tmp_path / "other.npz", time_s=np.zeros(3))
    with pytest.raises(InputError, match=r"other\.npz"):
        device_motion.read(tmp_path / "other.npz")


def test_one_person_of_the_cameras_is_a_source():
    shape = (2, 4, 3)
    points = keypoints.Keypoints3D(
        cameras=np.array(["a", "b"]),
        model="net",
        joints=np.array(["j0", "j1", "j2"]),
        person_id=np.array(["p1", "p2"]),
        time_s=np.arange(4) / 30,
        xyz=np.arange(72.0).reshape(*shape, 3),
        covariance_2d=np.full((*shape, 3, 3), np.nan),
        covariance_camera=np.full((*shape, 3, 3), np.nan),
        covariance_network=np.full((*shape, 3, 3), np.nan),
        offset=np.full((*shape, 3), np.nan),
        outlier=np.full(shape, np.nan),
        n_views=np.full(shape, 2),
        reproj_error_px=np.zeros((*shape, 2)),
        accepted=np.ones((*shape, 2), dtype=bool),
        swapped=np.zeros((*shape, 2), dtype=bool),
        reason=np.full(shape, missing_reason.OK, dtype=np.uint8),
    )
    found = device_motion.of_person(points, "p2")
    np.testing.assert_array_equal(found.xyz, points.xyz[1])
    assert (found.source, found.kind, found.performed.all()) == ("cameras", "cameras", True)
    with pytest.raises(InputError, match=r"person p3: expected one of \['p1', 'p2'\]"):
        device_motion.of_person(points, "p3")
