"""Another program's keypoint files against frames, skeletons and each other."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from courtside.study.configuration.sessions import Take
from courtside.validation import keypoint_folders
from courtside.video.glance import Glance

SKELETONS = Path("config") / "skeletons"


def skeleton_file(name):
    return SKELETONS / f"{name}.yaml"


def write(path, *people):
    """Write a file of one frame, as OpenPose does."""
    content = {"people": [{"pose_keypoints_2d": list(person)} for person in people]}
    path.write_text(json.dumps(content))


@pytest.fixture
def said(tmp_path):
    """Return a function: faults and remarks of cameras with files of these numbers."""

    def check(videos=None, trim_s=None, **numbers):
        for name, own in numbers.items():
            (tmp_path / name).mkdir()
            for number in own:
                write(tmp_path / name / f"{number}.json")
        folders = {name: str(tmp_path / name) for name in numbers}
        films = dict.fromkeys(videos or {}, "v.mp4")
        take = Take("t", films, ("p1",), trim_s=trim_s, pose2d={"coco17": folders})
        small = np.zeros((54, 96), np.uint8)
        looks = {name: Glance((64, 48), small, n, 10.0) for name, n in (videos or {}).items()}
        return keypoint_folders.check(take, looks, skeleton_file)

    return check


def test_as_many_files_as_frames_say_nothing(said):
    assert said({"a": 100, "b": 90}, a=range(100), b=range(1, 91)) == ([], [])


def test_one_file_too_many_is_a_remark_and_two_are_a_fault(said):
    faults, (remark,) = said({"a": 100, "b": 100}, a=range(101), b=range(100))
    assert faults == []
    assert "/a: 101 files for 100 frames; taken in their order, the last one" in remark
    faults, remarks = said({"c": 100, "d": 100}, c=range(102), d=range(50))
    assert remarks == []
    assert len(faults) == 2
    assert "/c: expected at most 100 frames" in faults[0]
    assert "/d: expected a file for each of 100 frames" in faults[1]


def test_files_beyond_the_trimmed_part_are_not_missed(said):
    faults, (remark,) = said({"a": 100}, trim_s=(0.0, 5.0), a=range(50))
    assert faults == []
    assert "50 files for 100 frames" in remark
    (fault,), remarks = said({"b": 100}, trim_s=(0.0, 5.0), b=range(49))
    assert remarks == []
    assert "or let `trim_s` end with them" in fault


def test_a_video_whose_frames_were_not_counted_says_nothing(said):
    assert said({"a": None}, a=range(7)) == ([], [])


def test_without_videos_cameras_are_compared(said):
    assert said(a=range(100), b=range(100)) == ([], [])
    faults, (remark,) = said(c=range(100), d=range(99), e=range(100))
    assert faults == []
    assert "100 files of frames 0 to 99 (c, e), 99 files of frames 0 to 98 (d)" in remark
    assert "taken as frames 0 to 99 of every camera" in remark
    (fault,), remarks = said(f=range(4), g=[1_700_000_000])
    assert (remarks, "number them alike" in fault) == ([], True)


def test_folders_that_are_not_there_are_told_elsewhere(tmp_path):
    take = Take("t", {}, ("p1",), pose2d={"coco17": {"a": str(tmp_path / "gone")}})
    assert keypoint_folders.check(take, {}, skeleton_file) == ([], [])


@pytest.fixture
def filmed(tmp_path):
    """Return a function: the faults of three cameras whose folders hold people of so many points.

    `folders` are other ones of some cameras.
    """
    rng = np.random.default_rng(0)
    for name in "abc":
        (tmp_path / name).mkdir()
        for number in range(100):
            person = np.column_stack([rng.uniform(0, 500, (26, 2)), np.full(26, 0.9)])
            write(tmp_path / name / f"{name}_{number:03}.json", person.ravel())

    def faults(skeleton="halpe26", **folders):
        named = {name: str(tmp_path / folders.get(name, name)) for name in "abc"}
        take = Take("t", {}, ("p1",), pose2d={skeleton: named}, rate_hz=60)
        return keypoint_folders.check(take, {}, skeleton_file)[0]

    return faults


def test_one_folder_for_two_cameras_is_told_also_as_a_copy(tmp_path, filmed):
    assert filmed() == []
    (line,) = filmed(c="b")
    assert line == (
        f"cameras b and c: expected two views, found the same points in {tmp_path}/b and "
        f"{tmp_path}/b; name each camera's own folder"
    )
    (line,) = filmed(c="../" + f"{tmp_path.name}/b")
    assert line.startswith("cameras b and c: expected two views")
    shutil.copytree(tmp_path / "a", tmp_path / "copy")
    (line,) = filmed(b="copy")
    assert line.startswith("cameras a and b: expected two views")


def test_folders_in_which_nobody_is_seen_are_no_copies(tmp_path, filmed):
    for name in ("none", "nobody"):
        (tmp_path / name).mkdir()
        for number in range(100):
            write(tmp_path / name / f"{number}.json")
    assert filmed(a="none", b="nobody") == []
    (line,) = filmed(a="none", b="none")
    assert line.startswith("cameras a and b: expected two views")


def test_points_of_another_skeleton_are_told_with_their_file(tmp_path, filmed):
    lines = filmed("body25b")
    assert [line.partition(": ")[0] for line in lines] == [
        str(tmp_path / name / f"{name}_000.json") for name in "abc"
    ]
    assert all("expected 25 points of skeleton body25b, found 26; name" in line for line in lines)
    assert "cameras b and c: expected two views" in filmed("body25b", c="b")[-1]


def test_a_damaged_file_of_keypoints_is_told(tmp_path, filmed):
    (tmp_path / "b" / "b_000.json").write_text("{")
    (line,) = filmed()
    assert line.startswith(f"{tmp_path}/b/b_000.json: expected OpenPose's JSON")
