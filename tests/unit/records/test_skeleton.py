"""The committed skeletons, and what a bad one is told."""

from pathlib import Path

import pytest

from courtside.records import skeleton
from courtside.study.errors import InputError

FILES = sorted((Path(__file__).parents[3] / "config" / "skeletons").glob("*.yaml"))


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
