"""The drawn figure is made of the skeleton's joints as the table of derived joints says."""

from pathlib import Path

import numpy as np

from courtside.figures.style import stick_figure
from courtside.records.keypoints import derived_joints
from fixtures.people import walker

TABLE = derived_joints.read(Path(__file__).parents[4] / "config" / "derived_joints.yaml")
STICK = stick_figure.stick(walker.SKELETON, TABLE)


def test_it_has_the_papers_fourteen_joints():
    assert len(STICK.joints) == 14
    assert STICK.joints[-2:] == ("neck", "head_centre")
    assert len(STICK.bones) == 13


def test_joints_are_means_of_their_parts():
    xyz = walker.body(3)
    found = STICK.of(xyz)
    assert found.shape == (3, 14, 3)
    at = walker.SKELETON.index
    neck = (xyz[:, at("left_shoulder")] + xyz[:, at("right_shoulder")]) / 2
    np.testing.assert_allclose(found[:, STICK.joints.index("neck")], neck)
    np.testing.assert_allclose(found[:, STICK.joints.index("left_knee")], xyz[:, at("left_knee")])


def test_a_missing_joint_removes_only_joints_made_of_it():
    xyz = walker.body(1)
    xyz[:, walker.SKELETON.index("left_shoulder")] = np.nan
    missing = np.isnan(STICK.of(xyz)[0, :, 0])
    assert {STICK.joints[k] for k in np.flatnonzero(missing)} == {"left_shoulder", "neck"}
