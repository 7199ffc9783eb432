"""A quick look tells what a whole reading tells, and finds what is cut short."""

import shutil
from fractions import Fraction

import cv2
import numpy as np
import pytest

from courtside.study.errors import InputError
from courtside.video import glance as quick
from courtside.video import reader
from fixtures.recordings import rooms_filmed, video_files


@pytest.mark.parametrize("suffix", [".mp4", ".mkv", ".avi", ".ts"])
def test_a_look_agrees_with_a_whole_reading(tmp_path, suffix):
    codec = "mpeg4" if suffix == ".avi" else "libx264"
    path = video_files.write(str(tmp_path / f"a{suffix}"), codec, n=50, rate=25)
    found, whole = quick.glance(path), reader.probe(path)
    times_s = reader.frame_times(path)
    assert (found.size, found.n_frames, found.even) == (whole.size, len(times_s), True)
    assert found.rate_hz == pytest.approx(whole.rate_hz, rel=1e-6)
    assert found.duration_s == pytest.approx(whole.duration_s, abs=2e-3)
    first = cv2.cvtColor(next(reader.frames(path))[1], cv2.COLOR_BGR2GRAY)
    small = cv2.resize(first, quick.SMALL_PX, interpolation=cv2.INTER_AREA).astype(float)
    slope, offset = np.polyfit(small.ravel(), found.small.ravel(), 1)  # limited range of luma
    assert np.abs(slope * small + offset - found.small).mean() < 3


@pytest.mark.parametrize("turn", [(90, False), (180, False), (270, False), (0, True)])
def test_the_picture_is_upright(tmp_path, turn):
    path = video_files.write(str(tmp_path / "a.mp4"), n=3, turn=turn)
    found, upright = quick.glance(path), next(reader.frames(path))[1]
    assert found.size == (upright.shape[1], upright.shape[0])
    grey = cv2.resize(cv2.cvtColor(upright, cv2.COLOR_BGR2GRAY), quick.SMALL_PX)
    assert np.corrcoef(grey.ravel(), found.small.ravel())[0, 1] > 0.97


def test_irregular_frames_are_seen(tmp_path):
    ticks = [0, 40, 80, 200, 240, 280]
    path = video_files.write(str(tmp_path / "a.mkv"), n=6, ticks=ticks)
    assert not quick.glance(path).even


def test_frames_that_a_phone_has_trimmed_away_do_not_count(tmp_path):
    whole = video_files.write(tmp_path / "whole.mp4", n=60, rate=30)
    found = quick.glance(video_files.trimmed(whole, tmp_path / "a.mp4", 7, 53))
    assert (found.n_frames, found.rate_hz) == (53, pytest.approx(30))


def test_a_phone_says_at_what_rate_it_filmed(tmp_path):
    said = {"com.android.capture.fps": "240.000000"}
    tags = {"movflags": "use_metadata_tags"}
    path = video_files.write(tmp_path / "a.mp4", n=24, rate=30, said=said, container=tags)
    found = quick.glance(path)
    assert (found.filmed_hz, found.rate_hz) == (240, pytest.approx(30))
    assert quick.glance(video_files.write(tmp_path / "b.mp4", n=3)).filmed_hz is None


def test_pixels_that_are_not_square_are_seen(tmp_path):
    path = video_files.write(tmp_path / "a.mp4", n=3, pixel=Fraction(4, 3))
    assert quick.glance(path).pixel == pytest.approx(4 / 3)
    assert quick.glance(video_files.write(tmp_path / "b.mp4", n=3)).pixel == 1


def test_an_interlaced_video_is_seen(tmp_path):
    fields = {"x264opts": "tff=1", "flags": "+ildct+ilme", "threads": "1"}
    path = video_files.write(tmp_path / "a.ts", n=6, rate=25, options=fields, size=(160, 128))
    assert quick.glance(path).interlaced
    assert not quick.glance(video_files.write(tmp_path / "b.ts", n=6, rate=25)).interlaced


def test_a_stretch_of_half_the_rate_is_measured(tmp_path):
    """As a phone that exposes longer in the dark: 10 steps of 66 ms among 30 of 33 ms."""
    steps = [33] * 15 + [66] * 10 + [33] * 15
    ticks = np.cumsum([0, *steps]).tolist()
    found = quick.glance(video_files.write(tmp_path / "a.mp4", n=len(ticks), ticks=ticks))
    assert (found.even, found.late_s) == (False, pytest.approx(0.66))


def test_a_photo_has_a_size_only(tmp_path):
    path = tmp_path / "empty.png"
    cv2.imwrite(str(path), rooms_filmed.background(1))
    found = quick.glance(path)
    assert (found.size, found.n_frames, found.duration_s) == (rooms_filmed.SIZE, None, None)


@pytest.mark.parametrize("faststart", [True, False])
def test_a_cut_file_is_told(tmp_path, faststart):
    container = {"movflags": "faststart"} if faststart else {}
    path = video_files.write(str(tmp_path / "a.mp4"), n=50, container=container)
    cut = tmp_path / "cut.mp4"
    shutil.copy(path, cut)
    with cut.open("r+b") as stream:
        stream.truncate(cut.stat().st_size * 6 // 10)
    what = r"last good frame is \d+ at|no frame" if faststart else "no video or was cut short"
    with pytest.raises(InputError, match=what) as caught:
        quick.glance(cut)
    assert str(caught.value).startswith(str(cut))
    if faststart:  # a take that is trimmed to end before the cut may use it
        assert quick.glance(cut, stop_s=0.2).size == (160, 120)


def test_long_files_are_not_read_to_the_end(tmp_path, monkeypatch):
    path = video_files.write(str(tmp_path / "a.mkv"), n=20)
    monkeypatch.setattr(quick, "LONGEST_S", -1.0)
    found = quick.glance(path)
    assert (found.size, found.n_frames, found.rate_hz) == ((160, 120), None, None)


@pytest.mark.parametrize("content", [b"", b"not a video"])
def test_what_is_no_video_is_told(tmp_path, content):
    path = tmp_path / "a.mp4"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"a\.mp4: expected a video"):
        quick.glance(path)
