"""The committed skeletons, and what a bad one is told."""

from pathlib import Path

import pytest

from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError

FILES = sorted((Path(__file__).parents[4] / "config" / "skeletons").glob("*.yaml"))


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_committed_skeletons_are_consistent(path):
    found = skeleton.read(path)
    mirror = found.mirror()
    assert [mirror[at] for at in mirror] == list(range(len(found.joints)))
    assert found.joints[mirror[found.index("left_knee")]] == "right_knee"
    assert len(found.segments) == 8
    assert len(found.groups["limbs"]) == 12
    arms, legs = found.side_groups()
    assert sorted([*arms, *legs]) == sorted(found.joints)
    assert "left_hip" in legs
    assert "left_wrist" in arms


def test_values_of_groups_reach_every_joint():
    found = skeleton.read(next(path for path in FILES if path.stem == "blazepose33"))
    values = found.by_group({"head": 1, "trunk": 2, "arms": 3, "legs": 4})
    expected = {"nose": 1, "left_hip": 2, "right_thumb": 3, "left_heel": 4}
    assert {joint: values[found.index(joint)] for joint in expected} == expected
    with pytest.raises(InputError, match="left_heel"):
        found.by_group({"head": 1, "trunk": 2, "arms": 3})
    with pytest.raises(InputError, match="wings"):
        found.by_group({"head": 1, "trunk": 2, "arms": 3, "legs": 4, "wings": 5})


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("- [head_top, neck]", "- [head_top, tail]", "'tail'"),
        ("- left_wrist\n", "- left_claw\n", "'right_claw'|'left_wrist'"),
    ],
)
def test_an_unknown_joint_is_named(tmp_path, old, new, named):
    text = next(path for path in FILES if path.stem == "cpm14").read_text()
    assert old in text
    (tmp_path / "bad.yaml").write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=named):
        skeleton.read(tmp_path / "bad.yaml")


GOOD = """
joints: [neck, left_hip, right_hip]
bones: [[neck, left_hip]]
segments: {left_trunk: [neck, left_hip]}
groups: {legs: [left_hip, right_hip], trunk: [neck]}
"""


def test_a_small_skeleton_reads(tmp_path):
    (tmp_path / "small.yaml").write_text(GOOD)
    found = skeleton.read(tmp_path / "small.yaml")
    assert found.name == "small"
    assert found.mirror() == [0, 2, 1]
    assert found.side_groups() == [["neck"], ["left_hip", "right_hip"]]
    assert found.by_group({"trunk": 1.5, "legs": 2.5}) == [1.5, 2.5, 2.5]
    with pytest.raises(ValueError, match="not in tuple"):
        found.index("nose")


def test_a_device_may_call_joints_otherwise(tmp_path):
    (tmp_path / "small.yaml").write_text(
        GOOD + "names: {left_hip: l_up_leg, right_hip: r_up_leg}\n"
    )
    found = skeleton.read(tmp_path / "small.yaml")
    assert found.names == {"left_hip": "l_up_leg", "right_hip": "r_up_leg"}
    assert found.device_names() == ["neck", "l_up_leg", "r_up_leg"]
    (tmp_path / "small.yaml").write_text(GOOD)
    assert skeleton.read(tmp_path / "small.yaml").names == {}


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("bones:", "names: {tail: t}\nbones:", "'tail'"),
        ("bones:", "names: {left_hip: neck}\nbones:", "names.*'neck'"),
        ("bones:", "names: {left_hip: hip, right_hip: hip}\nbones:", "names.*'hip'"),
        ("bones:", "names: {left_hip: 7}\nbones:", "names.*found 7"),
        ("bones:", "names: [left_hip]\nbones:", "names: expected keys and values"),
        (
            "[neck, left_hip, right_hip]\n",
            "[neck, left_hip, right_hip, neck]\n",
            "'neck' again",
        ),
        ("[neck, left_hip, right_hip]\n", "[neck, left_hip, right_hip, 7]\n", "found 7"),
        ("[neck, left_hip, right_hip]\n", "[neck, left_hip]\n", "'right_hip'"),
        ("[[neck, left_hip]]", "[[neck, left_hip, right_hip]]", "two joints"),
        ("[[neck, left_hip]]", "[neck]", "two joints"),
        ("left_trunk: [neck, left_hip]", "left_trunk: [neck]", "two joints"),
        ("trunk: [neck]}", "trunk: 3}", "groups"),
        ("trunk: [neck]}", "trunk: [chest]}", "'chest'"),
        ("bones:", "bone:", "'bones'"),
        ("bones:", "joints: [neck]\nbones:", "each key once"),
        ("joints: [", "joints: ", "bad.yaml"),
    ],
)
def test_a_bad_skeleton_is_one_line(tmp_path, old, new, named):
    assert old in GOOD
    (tmp_path / "bad.yaml").write_text(GOOD.replace(old, new, 1))
    with pytest.raises(InputError, match=named) as caught:
        skeleton.read(tmp_path / "bad.yaml")
    assert "bad.yaml" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_skeleton_is_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.yaml: expected a readable YAML file"):
        skeleton.read(tmp_path / "none.yaml")


def test_bones_are_given_by_position_too():
    found = skeleton.read(next(path for path in FILES if path.stem == "cpm14"))
    assert [(found.joints[a], found.joints[b]) for a, b in found.bone_indices()] == list(
        found.bones
    )


def test_heel_and_toe_are_found_by_any_name_of_the_toe_or_not_at_all():
    assert skeleton.heel_and_toe(["left_big_toe", "left_ankle", "left_heel"], "left") == [2, 0]
    assert skeleton.heel_and_toe(("right_heel", "right_foot_index"), "right") == [0, 1]
    assert skeleton.heel_and_toe(["left_heel", "right_big_toe"], "left") == []
    assert skeleton.heel_and_toe(["left_foot_index"], "left") == []
