"""Every joint of every skeleton has a place in the schematic T-pose, sides mirrored."""

from pathlib import Path

import numpy as np
import pytest

from courtside.figures.style import schematic_pose
from courtside.records.keypoints import skeleton

FILES = sorted((Path(__file__).parents[4] / "config" / "skeletons").glob("*.yaml"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_skeletons_are_mirrored_and_their_limbs_whole(path):
    found = skeleton.read(path)
    xyz = schematic_pose.tpose(found.joints)
    assert np.isfinite(xyz[[found.index(joint) for joint in found.groups["limbs"]]]).all()
    np.testing.assert_array_equal(xyz[found.mirror()], xyz * [-1, 1, 1])
    wrists = xyz[[found.index("left_wrist"), found.index("right_wrist")], 0]
    np.testing.assert_array_equal(wrists, [1, -1])  # the unit


@pytest.mark.parametrize("name", ["mocopi27", "blazepose33", "nuitrack19", "cpm14"])
def test_the_plates_skeletons_are_whole(name):
    joints = skeleton.read(FILES[0].parent / f"{name}.yaml").joints
    assert np.isfinite(schematic_pose.tpose(joints)).all()


def test_an_unknown_joint_is_missing():
    assert np.isnan(schematic_pose.tpose(["left_antenna", "tail"])).all()
