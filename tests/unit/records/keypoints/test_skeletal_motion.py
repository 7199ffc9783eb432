from dataclasses import replace

import numpy as np
import pytest

from courtside.records.devices import hierarchy
from courtside.records.keypoints import skeletal_motion
from courtside.records.keypoints.skeletal_motion import SkeletalMotion
from courtside.study.errors import InputError

QUARTER = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])  # about Z


def made():
    """Return three frames of two segments, the last frame not fitted."""
    turns = np.tile(np.eye(3), (1, 3, 2, 1, 1))
    turns[0, 1, 1] = QUARTER
    turns[0, 2] = np.nan
    root = np.array([[[0.0, 0, 1], [1, 0, 1], [np.nan] * 3]])
    return SkeletalMotion(
        model="net",
        person_id=np.array(["a"]),
        time_s=np.array([0.0, 0.1, 0.2]),
        segments=np.array(["pelvis", "femur"]),
        parents=np.array([-1, 0]),
        offsets=np.array([[[0.0, 0, 0], [0, -0.1, 0]]]),
        offset_sigma_m=np.zeros((1, 2)),
        joints=np.array(["left_hip", "left_knee"]),
        segment_of=np.array([1, 1]),
        places=np.array([[[0.0, 0, 0], [0, -0.4, 0]]]),
        root=root,
        parent_from_segment=turns,
        angles=np.array(["left_hip_flexion"]),
        angle_deg=np.array([[[0.0], [90.0], [np.nan]]]),
        angle_sigma_deg=np.ones((1, 3, 1)),
    )


def test_a_motion_is_read_as_it_was_written(tmp_path):
    skeletal_motion.write(tmp_path / "a.npz", made())
    found = skeletal_motion.read(tmp_path / "a.npz")
    for key, value in vars(made()).items():
        np.testing.assert_array_equal(getattr(found, key), value)
    np.savez(tmp_path / "b.npz", format="other")
    with pytest.raises(InputError, match="expected format"):
        skeletal_motion.read(tmp_path / "b.npz")


def test_the_posed_hierarchy_holds_the_fitted_frames_and_the_tips():
    posed, fitted = made().posed(0)
    assert fitted.tolist() == [True, True, False]
    xyz, turned = hierarchy.forward(posed)
    np.testing.assert_allclose(xyz[:, 1], [[0, -0.1, 1], [1, -0.1, 1]])
    tip = xyz[1, 1] + turned[1, 1] @ posed.hierarchy.ends["femur"]
    np.testing.assert_allclose(tip, [1.4, -0.1, 1])


def test_a_tip_is_the_farthest_point_and_between_both_sides_of_a_head():
    """A hand ends at its finger, not at the thumb, and a head does not end at one ear."""
    points = [[0.0, -0.1, 0.01], [0.02, -0.07, 0.03], [0.05, 0.2, 0.03], [0.05, 0.2, -0.03]]
    motion = replace(
        made(),
        segments=np.array(["thorax", "hand", "head"]),
        parents=np.array([-1, 0, 0]),
        offsets=np.zeros((1, 3, 3)),
        joints=np.array(["index", "thumb", "left_ear", "right_ear"]),
        segment_of=np.array([1, 1, 2, 2]),
        places=np.array([points]),
        parent_from_segment=np.tile(np.eye(3), (1, 3, 3, 1, 1)),
    )
    ends = motion.posed(0)[0].hierarchy.ends
    assert sorted(ends) == ["hand", "head"]
    np.testing.assert_allclose(ends["hand"], points[0])
    np.testing.assert_allclose(ends["head"], [0.05, 0.2, 0])
