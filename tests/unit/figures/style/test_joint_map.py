"""The map of joints says what the skeletons' files and the table of derived joints say."""

from pathlib import Path

import pytest

from courtside.figures.style import joint_map
from courtside.records.keypoints import derived_joints, skeleton

CONFIG = Path(__file__).parents[4] / "config"
TABLE = derived_joints.read(CONFIG / "derived_joints.yaml")
NAMES = ("mocopi27", "blazepose33", "nuitrack19", "cpm14")
SKELETONS = [skeleton.read(CONFIG / "skeletons" / f"{name}.yaml") for name in NAMES]
ROWS = joint_map.rows(SKELETONS, TABLE)


def row(common, name):
    return ROWS[(ROWS["common"] == common) & (ROWS["skeleton"] == name)].iloc[0]


def test_limbs_are_the_joints_of_that_name():
    assert joint_map.limbs(SKELETONS) == ["shoulder", "elbow", "wrist", "hip", "knee", "ankle"]
    wrist = row("wrist", "mocopi27")
    assert wrist["device_names"] == ("l_hand", "r_hand") and not wrist["definition"]
    assert joint_map.cell(wrist) == "14 l_hand, 18 r_hand"
    assert joint_map.cell(row("wrist", "blazepose33")) == "15, 16"  # MediaPipe's own numbers


@pytest.mark.parametrize(
    ("common", "name", "words"),
    [
        ("pelvis_thorax", "blazepose33", "0.35(23+24) + 0.15(11+12) *"),
        ("mid_hip", "cpm14", "0.5(11+8) *"),
        ("head_centre", "mocopi27", "10"),
        ("neck", "cpm14", "1"),
    ],
)
def test_derived_joints_are_sums_of_numbers(common, name, words):
    assert joint_map.cell(row(common, name)) == words


def test_a_definition_that_differs_is_marked():
    alike = ROWS.groupby("common")["same"].all()
    assert alike["pelvis_thorax"] and alike["mid_hip"]
    assert not alike["head_centre"] and not alike["neck"]
    pair = joint_map.rows(SKELETONS[:2], TABLE).groupby("common")["same"].all()
    assert pair["neck"]  # mocopi's and BlazePose's is one


def test_a_derived_joint_that_a_skeleton_lacks_is_left_out():
    lacking = derived_joints.DerivedJoints(TABLE.definitions, {"neck": {"cpm14": "trained-neck"}})
    assert "neck" not in set(joint_map.rows(SKELETONS, lacking)["common"])


def test_a_single_part_with_a_weight_shows_it():
    about = {"definition": "d", "numbers": (3, 1), "weights": (0.6, 0.4)}
    assert joint_map.cell(about) == "0.6 × 3 + 0.4 × 1 *"
