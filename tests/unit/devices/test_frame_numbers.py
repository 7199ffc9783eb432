"""Numbers in file names against the frames of a video, and against those of other cameras."""

import pytest

from courtside.devices import frame_numbers
from courtside.study.errors import InputError


@pytest.mark.parametrize(
    ("numbers", "first", "message"),
    [
        (range(100), 0, ""),
        (range(1, 101), 1, ""),
        (range(300, 400), 300, ""),
        (range(101), 0, "101 files for 100 frames; taken in their order, the last one, number 100"),
        (range(1, 102), 1, "the last one, number 101, is left out"),
        (range(99), 0, "99 files for 100 frames; taken as frames 0 to 98, counted from 0"),
        (range(1, 100), 0, "99 files for 100 frames; taken as frames 1 to 99, counted from 0"),
        (range(40, 90), 0, "50 files for 100 frames; taken as frames 40 to 89"),
        ([0, 1, 2, 50, 51], 0, "5 files for 100 frames; taken as frames 0 to 51"),
        (range(5), 0, "5 files for 100 frames; taken as frames 0 to 4"),
    ],
)
def test_files_are_matched_with_frames(numbers, first, message):
    found, remark = frame_numbers.matched("j", numbers, 100)
    assert found == first
    assert message in remark
    assert bool(message) == bool(remark)
    assert "\n" not in remark


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        (range(102), "at most 100 frames, as many as the video has, found 102 files numbered 0"),
        (
            range(98),
            "a file for each of 100 frames of the video, found 98 numbered 0 to 97; number",
        ),
        (range(1, 51), "found 50 numbered 1 to 50, as of every second frame; number"),
        (range(60, 110), "from 0 to 99 or a file for each, found 50 files numbered 60 to 109"),
    ],
)
def test_numbers_that_do_not_say_the_frame_are_refused(numbers, message):
    with pytest.raises(InputError, match=message):
        frame_numbers.matched("j", numbers, 100)


def test_files_need_not_reach_beyond_what_is_used():
    remark = "60 files for 100 frames; taken as frames 0 to 59"
    assert remark in frame_numbers.matched("j", range(60), 100, 60)[1]
    with pytest.raises(InputError, match="found 60 numbered 0 to 59"):
        frame_numbers.matched("j", range(60), 100, 61)


def folders(root, **numbers):
    for name, own in numbers.items():
        (root / name).mkdir()
        for number in own:
            (root / name / f"f_{number:06d}.json").touch()
    return {name: root / name for name in numbers}


def test_files_that_macos_adds_are_none(tmp_path):
    (folder,) = folders(tmp_path, a=range(3)).values()
    (folder / "._f_000000.json").touch()
    assert frame_numbers.numbered(folder) == {at: f"f_{at:06d}.json" for at in range(3)}


def test_without_videos_all_cameras_count_together(tmp_path):
    assert frame_numbers.common(folders(tmp_path, a=range(5, 9), b=range(4, 8))) == range(4, 9)


def test_cameras_that_count_otherwise_are_refused(tmp_path):
    given = folders(tmp_path, a=range(4), b=[1_700_000_000, 1_700_000_001])
    message = r"found 0 to 3 \(a\), 1700000000 to 1700000001 \(b\); number them alike"
    with pytest.raises(InputError, match=message):
        frame_numbers.common(given)


def test_a_file_of_all_frames_is_told_with_what_to_do(tmp_path):
    (tmp_path / "alphapose-results.json").write_text('[{"image_id": "0.jpg"}]')
    with pytest.raises(InputError, match="found a file of all frames; `AlphaPose_to_OpenPose`"):
        frame_numbers.numbered(tmp_path)
    (tmp_path / "alphapose-results.json").write_text("{}")
    with pytest.raises(InputError, match="found none; rename it"):
        frame_numbers.numbered(tmp_path)
