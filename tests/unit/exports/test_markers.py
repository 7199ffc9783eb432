"""Names that Pose2Sim and OpenSim use, for every joint of every skeleton of the study."""

from pathlib import Path

import pytest

from courtside.exports import markers
from courtside.records.keypoints import skeleton

FILES = sorted((Path(__file__).parents[3] / "config" / "skeletons").glob("*.yaml"))
# Of Pose2Sim 0.10.49: the points of HALPE_26 that it triangulates, as skeletons.py lists them.
HALPE = (
    "Hip RHip RKnee RAnkle RBigToe RSmallToe RHeel LHip LKnee LAnkle LBigToe LSmallToe LHeel Neck "
    "Head Nose RShoulder RElbow RWrist LShoulder LElbow LWrist"
)
BLAZE = (
    "RHip RKnee RAnkle RHeel RBigToe LHip LKnee LAnkle LHeel LBigToe Nose REye LEye RShoulder "
    "RElbow RWrist RPinky RIndex RThumb LShoulder LElbow LWrist LPinky LIndex LThumb"
)


@pytest.mark.parametrize(("name", "theirs"), [("halpe26", HALPE), ("blazepose33", BLAZE)])
def test_every_point_that_pose2sim_asks_for_is_there(name, theirs):
    joints = skeleton.read(next(path for path in FILES if path.stem == name)).joints
    assert set(theirs.split()) <= set(markers.names(joints))


@pytest.mark.parametrize(
    ("joint", "expected"),
    [
        ("left_knee", "LKnee"),
        ("right_foot_index", "RBigToe"),
        ("right_big_toe", "RBigToe"),
        ("neck", "Neck"),
        ("head_top", "Head"),
        ("mid_hip", "Hip"),
        ("left_eye_inner", "LEyeInner"),
        ("left_l", "LL"),
        ("left", "Left"),
    ],
)
def test_joints_get_the_names_of_pose2sim(joint, expected):
    assert markers.name(joint) == expected


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_each_joint_finds_its_own_marker(path):
    joints = skeleton.read(path).joints
    named = markers.names(joints)
    assert markers.joints_of(named, joints) == list(range(len(joints)))
    assert (
        markers.joints_of([name.lower() for name in named][::-1], joints)
        == list(range(len(joints)))[::-1]
    )
    assert markers.joints_of(joints, joints) == list(range(len(joints)))


def test_what_is_not_there_is_not_found():
    found = markers.joints_of(["CHip", "Rknee"], ["mid_hip", "left_knee", "right_knee"])
    assert found == [0, None, 1]


def test_one_name_for_two_joints_is_refused():
    with pytest.raises(ValueError, match="RBigToe"):
        markers.names(["right_big_toe", "right_foot_index"])
