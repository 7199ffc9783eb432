"""Chapters joined: every frame is at its time, no sound is lost; other files are refused."""

import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest

from courtside.study.errors import InputError
from courtside.video import reader
from courtside.video.chapters import join
from fixtures.recordings.video_files import draw, numbers, packets, trimmed, write

PROGRAM = Path(__file__).parents[3] / "workflow" / "join_chapters.py"
OPEN_GOP = {
    "g": "12",
    "bf": "2",
    "x264opts": "open-gop=1:threads=1:b-adapt=0:scenecut=0:min-keyint=12",
}


def chapter(path, first, n=30, **how):
    return write(path, images=[draw(k) for k in range(first, first + n)], **how)


@pytest.mark.parametrize("rate", [30, Fraction(30000, 1001), 240])
def test_a_chapter_begins_one_frame_after_the_last_of_the_one_before(tmp_path, rate):
    """Sound lasts longer than the pictures, as that of a GoPro; ffmpeg's joining would wait."""
    sound_s = 30 / float(rate) + 0.0517
    parts = [chapter(tmp_path / f"{k}.mp4", 30 * k, rate=rate, sound_s=sound_s) for k in range(3)]
    begun_s = join(parts, tmp_path / "joined.mp4")
    assert begun_s == pytest.approx([0, 30 / rate, 60 / rate], abs=1e-9)
    joined = list(reader.frames(tmp_path / "joined.mp4"))
    assert numbers(joined) == list(range(90))
    np.testing.assert_allclose([t for t, _ in joined], np.arange(90) / float(rate), atol=1e-5)
    separate = [image for path in parts for _, image in reader.frames(path)]
    np.testing.assert_array_equal([image for _, image in joined], separate)
    assert numbers([reader.read_frame(tmp_path / "joined.mp4", 45 / rate)]) == [45]
    with av.open(tmp_path / "joined.mp4") as container:
        samples = sum(frame.samples for frame in container.decode(audio=0))
    assert samples == 3 * int(8000 * sound_s)


def test_chapters_stay_turned_as_the_phone_says(tmp_path):
    parts = [chapter(tmp_path / f"{k}.mov", 3 * k, 3, turn=(90, False)) for k in range(2)]
    join(parts, tmp_path / "joined.mp4")
    whole = [image for path in parts for _, image in reader.frames(path)]
    found = [image for _, image in reader.frames(tmp_path / "joined.mp4")]
    np.testing.assert_array_equal(found, whole)
    assert found[0].shape == (160, 120, 3)


@pytest.mark.parametrize("clock", ["goes on", "begins anew"])
def test_chapters_of_a_camcorder_lose_no_frame_at_the_border(tmp_path, clock):
    """The second file is cut within a group: its first frames decode with the chapter before."""
    whole = write(tmp_path / "whole.ts", options=OPEN_GOP)
    listed = packets(whole)
    key = sorted(listed)[12]
    k = listed.index(key)
    assert listed[k + 1][0] < listed[k][0]  # shown before the key frame that it follows
    data, at = whole.read_bytes(), listed[k][1]
    parts = [tmp_path / "00001.ts", tmp_path / "00002.ts"]
    parts[0].write_bytes(data[:at])
    parts[1].write_bytes(data[at:])
    if clock == "begins anew":
        parts = [chapter(parts[k], 12 * k, 12 + 36 * k, options=OPEN_GOP) for k in range(2)]
    join(parts, tmp_path / "joined.mp4")
    joined = list(reader.frames(tmp_path / "joined.mp4"))
    assert numbers(joined) == list(range(60))
    np.testing.assert_allclose([t for t, _ in joined], np.arange(60) / 30, atol=1e-4)


def test_a_gap_that_the_clock_of_the_files_states_stays(tmp_path):
    parts = [
        chapter(tmp_path / f"{k}.ts", 30 * k, ticks=list(range(start, start + 1200, 40)))
        for k, start in enumerate((1000, 2300))
    ]
    assert join(parts, tmp_path / "joined.mp4") == pytest.approx([0, 1.3], abs=1e-4)
    times_s = reader.frame_times(tmp_path / "joined.mp4")
    np.testing.assert_allclose(times_s[28:32], [1.12, 1.16, 1.3, 1.34], atol=1e-4)


REFUSED = {
    r"the size of .*a\.mp4, 160x120, found 128x96": {"size": (128, 96)},
    r"the codec of .*a\.mp4, h264, found mpeg4": {"codec": "mpeg4"},
    r"the rotation of .*a\.mp4": {"turn": (90, False)},
    r"expected 30 Hz, the rate of .*a\.mp4, found 60 Hz": {"rate": 60},
    r"the sound of .*a\.mp4, none, found pcm_s16le 8000 Hz": {"sound_s": 1.0},
    r"the settings of the codec of .*a\.mp4, found others": {"options": {"g": "12", "bf": "0"}},
}


@pytest.mark.parametrize(("line", "other"), REFUSED.items())
def test_what_is_no_chapter_of_the_recording_is_refused(tmp_path, line, other):
    parts = [chapter(tmp_path / "a.mp4", 0), write(tmp_path / "b.mp4", n=30, **other)]
    with pytest.raises(InputError, match=line) as caught:
        join(parts, tmp_path / "joined.mp4")
    assert str(caught.value).startswith(str(parts[1])) and "\n" not in str(caught.value)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mp4", "b.mp4"]


def test_another_recording_by_its_clock_is_refused(tmp_path):
    parts = [
        chapter(tmp_path / f"{k}.ts", 0, ticks=list(range(start, start + 1200, 40)))
        for k, start in enumerate((1000, 4200))
    ]
    with pytest.raises(InputError, match=r"1\.ts: .* found it 2\.040 s later") as caught:
        join(parts, tmp_path / "joined.mp4")
    assert "give it as another recording" in str(caught.value)


def test_chapters_that_lost_frames_are_refused(tmp_path):
    whole = chapter(tmp_path / "a.mp4", 0, 60)
    hidden = trimmed(chapter(tmp_path / "whole.mp4", 0, 60), tmp_path / "hidden.mp4", 20, 40)
    with pytest.raises(InputError, match="found some that are hidden"):
        join([whole, hidden], tmp_path / "joined.mp4")
    cut = chapter(tmp_path / "cut.mp4", 0, 60, container={"movflags": "faststart"})
    cut.write_bytes(cut.read_bytes()[:-2000])
    with pytest.raises(InputError, match=r"cut\.mp4: .*last good frame"):
        join([whole, cut], tmp_path / "joined.mp4")
    assert not (tmp_path / "joined.mp4").exists()


def write_with_aac(path, first):
    """Write 15 frames and sound of AAC: MP4 hides the samples that its encoder needs to begin."""
    with av.open(path, "w") as out:
        pictures = out.add_stream("libx264", rate=30, options={"g": "12", "bf": "2"})
        pictures.width, pictures.height, pictures.pix_fmt = 160, 120, "yuv420p"
        sound = out.add_stream("aac", rate=48000, layout="mono")
        for k in range(15):
            frame = av.VideoFrame.from_ndarray(draw(first + k), format="bgr24")
            frame.pts, frame.time_base = k, Fraction(1, 30)
            out.mux(pictures.encode(frame))
        out.mux(pictures.encode())
        tone = np.sin(2 * np.pi * 440 * np.arange(26400) / 48000)  # 50 ms longer than the pictures
        samples = av.AudioFrame.from_ndarray(tone[None].astype(np.float32), "fltp", "mono")
        samples.sample_rate, samples.pts = 48000, 0
        out.mux(sound.encode(samples))
        out.mux(sound.encode())
    return path


def test_sound_goes_on_where_that_of_the_chapter_before_ends(tmp_path):
    parts = [write_with_aac(tmp_path / f"{k}.mp4", 15 * k) for k in range(2)]
    with av.open(parts[0]) as container:
        assert any(p.is_discard for p in container.demux(audio=0))
    join(parts, tmp_path / "joined.mp4")
    np.testing.assert_allclose(
        reader.frame_times(tmp_path / "joined.mp4"), np.arange(30) / 30, atol=1e-5
    )
    with av.open(tmp_path / "joined.mp4") as container:
        heard = list(container.decode(audio=0))
    begin_s = np.array([frame.time for frame in heard])
    lasts_s = np.array([frame.samples / 48000 for frame in heard])
    # The last packet of a chapter is filled up: it lasts 17 ms, and 21 when it is decoded.
    np.testing.assert_allclose(begin_s[1:], (begin_s + lasts_s)[:-1], atol=5e-3)
    assert begin_s[-1] + lasts_s[-1] == pytest.approx(2 * 0.55, abs=0.05)  # whole packets of 21 ms


def test_matroska_without_times_of_decoding_is_refused(tmp_path):
    parts = [chapter(tmp_path / f"{k}.mkv", 0, 12) for k in range(2)]
    with pytest.raises(InputError, match=r"0\.mkv: .*write each chapter as \.mp4 first"):
        join(parts, tmp_path / "joined.mp4")


def test_no_file_is_written_over(tmp_path):
    parts = [chapter(tmp_path / f"{k}.mp4", 0, 3) for k in range(2)]
    before = parts[1].read_bytes()
    with pytest.raises(InputError, match="found one; delete it or name another"):
        join(parts, parts[1])
    assert parts[1].read_bytes() == before


def test_a_container_that_does_not_hold_the_streams_is_named(tmp_path):
    parts = [chapter(tmp_path / f"{k}.mp4", 0, 3) for k in range(2)]
    for name in ("joined.wav", "joined.xyz"):
        with pytest.raises(InputError, match=r"to write a video, found.*name it \.mp4") as caught:
            join(parts, tmp_path / name)
        assert "\n" not in str(caught.value)


def program(folder, *words):
    command = [sys.executable, str(PROGRAM), *words, "--output", "joined.mp4"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_the_program_joins_the_chapters_of_a_gopro_in_their_order_only(tmp_path):
    names = ["GX010034.MP4", "GX020034.MP4", "GX030034.MP4"]
    for k, name in enumerate(names):
        chapter(tmp_path / name, 15 * k, 15)
    chapter(tmp_path / "GX020035.MP4", 15, 15)
    for given, found in (
        (names[:1], "expected two chapters or more"),
        ([names[1], names[0]], "expected chapter 3 of recording 0034 .* chapter 1 of"),
        ([names[0], names[2]], "expected chapter 2 of recording 0034 .* found chapter 3 of"),
        ([names[0], "GX020035.MP4"], "found chapter 2 of recording 0035; correct the order"),
    ):
        done = program(tmp_path, *given)
        assert done.returncode == 1 and not (tmp_path / "joined.mp4").exists()
        assert re.fullmatch(rf"Error: .*{found}.*\n", done.stderr), done.stderr
    done = program(tmp_path, *names)
    assert done.returncode == 0, done.stderr
    assert re.findall(r"([.\d]+) s (\w+)", done.stdout) == [
        ("0.000", "GX010034"), ("0.500", "GX020034"), ("1.000", "GX030034")
    ]  # fmt: skip
    assert numbers(reader.frames(tmp_path / "joined.mp4")) == list(range(45))
