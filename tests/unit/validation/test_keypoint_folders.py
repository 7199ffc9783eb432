"""Another program's keypoint files against the frames of videos, and without videos."""

import numpy as np
import pytest

from courtside.study.configuration.sessions import Take
from courtside.validation import keypoint_folders
from courtside.video.glance import Glance


@pytest.fixture
def said(tmp_path):
    """Return a function: faults and remarks of cameras with files of these numbers."""

    def check(videos=None, trim_s=None, **numbers):
        for name, own in numbers.items():
            (tmp_path / name).mkdir()
            for number in own:
                (tmp_path / name / f"{number}.json").touch()
        folders = {name: str(tmp_path / name) for name in numbers}
        films = dict.fromkeys(videos or {}, "v.mp4")
        take = Take("t", films, ("p1",), trim_s=trim_s, pose2d={"coco17": folders})
        small = np.zeros((54, 96), np.uint8)
        looks = {name: Glance((64, 48), small, n, 10.0) for name, n in (videos or {}).items()}
        return keypoint_folders.check(take, looks)

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
    assert keypoint_folders.check(take, {}) == ([], [])
