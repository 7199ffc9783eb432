"""Frame times as written; files cut short at known bytes; files that are no video."""

import re
import struct

import av
import cv2
import numpy as np
import pytest
from av.stream import Disposition

from courtside.study.errors import InputError
from courtside.video import reader
from courtside.video.packets import list_packets
from fixtures.recordings.video_files import (
    draw,
    good_frames,
    number_in,
    numbers,
    packets,
    trimmed,
    write,
)

FAST = {"movflags": "faststart"}
FRAGMENTED = {"movflags": "frag_keyframe+empty_moov"}
CONTAINERS = {
    "plain.mp4": {},
    "fast.mp4": {"container": FAST},
    "fragmented.mp4": {"container": FRAGMENTED},
    "fast.mov": {"container": FAST},
    "plain.mkv": {},
    "live.mkv": {"container": {"live": "1"}},
    "plain.avi": {},
    "mpeg4.avi": {"codec": "mpeg4", "options": {"bf": "2"}},
    "mjpeg.avi": {"codec": "mjpeg", "pix_fmt": "yuvj420p"},
    "plain.flv": {},
    "plain.ts": {},
    "plain.mpg": {"codec": "mpeg2video", "options": {"bf": "2"}},
    "name with %03d.mp4": {},
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("videos")
    return {name: write(folder / name, **how) for name, how in CONTAINERS.items()}


def cut_copy(tmp_path, source, n_bytes):
    path = tmp_path / f"cut{source.suffix}"
    path.write_bytes(source.read_bytes()[:n_bytes])
    return path


@pytest.mark.parametrize("name", CONTAINERS)
def test_times_are_those_written(files, name):
    tick_s = 0.0005 if files[name].suffix in (".mkv", ".flv") else 1e-12
    np.testing.assert_allclose(
        reader.frame_times(files[name]), np.arange(60) / 30, atol=tick_s + 1e-12
    )


def test_times_of_a_variable_rate_are_those_written(tmp_path):
    ticks = np.cumsum([0, 33, 34, 33, 100, 5, 33, 250, 33, 33, 17, 40])
    for name in ("a.mp4", "a.mkv"):
        path = write(tmp_path / name, ticks=ticks.tolist(), n=len(ticks))
        np.testing.assert_array_equal(reader.frame_times(path), ticks / 1000)
        assert numbers(reader.frames(path)) == list(range(len(ticks)))


def test_the_first_frame_is_at_zero_wherever_the_clock_starts(tmp_path):
    path = write(tmp_path / "late.mkv", ticks=[5000 + 40 * k for k in range(20)], n=20)
    assert packets(path)[0][0] == 5000
    np.testing.assert_array_equal(reader.frame_times(path), 0.04 * np.arange(20))


def test_a_colon_in_the_name_is_no_protocol(tmp_path, monkeypatch):
    write(tmp_path / "take.mp4", n=3).rename(tmp_path / "take:1.mp4")
    monkeypatch.chdir(tmp_path)
    assert len(reader.frame_times("take:1.mp4")) == 3


def test_opencv_finds_the_same_times(files):
    capture = cv2.VideoCapture(str(files["plain.mp4"]))
    expected = []
    while capture.read()[0]:
        expected.append(capture.get(cv2.CAP_PROP_POS_MSEC) / 1000)
    np.testing.assert_allclose(reader.frame_times(files["plain.mp4"]), expected, atol=1e-9)


def test_an_edit_list_trims_without_being_taken_for_a_loss(files, tmp_path):
    path = trimmed(files["plain.mp4"], tmp_path / "trimmed.mp4", 20, 30)
    np.testing.assert_allclose(reader.frame_times(path), np.arange(30) / 30)
    assert numbers(reader.frames(path)) == list(range(20, 50))
    assert numbers(reader.frames(path, start_s=0.5)) == list(range(35, 50))


def test_frames_an_avi_recorder_dropped_are_gaps_not_losses(files, tmp_path):
    data = bytearray(files["mjpeg.avi"].read_bytes())
    listed = packets(files["mjpeg.avi"])
    for k in (10, 11, 30):
        _, at, size = listed[k]
        at = data.rindex(b"00dc", 0, at + 9)
        assert struct.unpack_from("<I", data, at + 4)[0] == size
        struct.pack_into("<I4sI", data, at + 4, 0, b"JUNK", size + size % 2 - 8)
        entry = data.index(b"idx1") + 8 + 16 * k
        struct.pack_into("<I", data, entry + 12, 0)
    path = tmp_path / "dropped.avi"
    path.write_bytes(data)
    kept = [k for k in range(60) if k not in (10, 11, 30)]
    np.testing.assert_allclose(reader.frame_times(path), np.array(kept) / 30)
    assert numbers(reader.frames(path)) == kept


@pytest.mark.parametrize("sound_s", [2.0, 2.4])
def test_sound_may_outlast_the_pictures(tmp_path, sound_s):
    path = write(tmp_path / "sound.mkv", sound_s=sound_s)
    # Without a duration of the pictures alone, as some recorders write it.
    path.write_bytes(path.read_bytes().replace(b"DURATION", b"ANYTHING"))
    assert len(reader.frame_times(path)) == 60


def test_one_frame_has_a_time_and_no_rate(tmp_path):
    path = write(tmp_path / "one.mp4", n=1)
    assert reader.frame_times(path).tolist() == [0.0]
    assert np.isnan(reader.probe(path).rate_hz)


@pytest.mark.parametrize("fraction", [0.3, 0.6, 0.95, 0.9999])
@pytest.mark.parametrize(
    "name",
    ["fast.mp4", "fragmented.mp4", "fast.mov", "plain.avi", "mpeg4.avi", "mjpeg.avi", "plain.flv"],
)
def test_a_cut_file_is_refused_with_its_last_good_frame(files, tmp_path, name, fraction):
    listed = packets(files[name])
    end = max(position + size for _, position, size in listed)
    n_bytes = int(listed[0][1] + fraction * (end - listed[0][1]))
    path = cut_copy(tmp_path, files[name], n_bytes)
    with pytest.raises(InputError) as caught:
        list(reader.frames(path))
    message = str(caught.value)
    assert str(path) in message and "\n" not in message
    index, time_s = re.search(r"last good frame is (\d+) at ([\d.]+) s", message).groups()
    index, time_s = int(index), float(time_s)
    true_last = good_frames(files[name], n_bytes) - 1
    # With B-frames, what follows the last packet cannot be known: the word may come a little early.
    assert true_last - (0 if name == "mjpeg.avi" else 3) <= index <= true_last
    assert time_s == pytest.approx(index / 30, abs=0.002)
    assert numbers(reader.frames(path, stop_s=time_s)) == list(
        range(np.count_nonzero(reader.frame_times(files[name]) < time_s))
    )
    with pytest.raises(InputError, match="last good frame"):
        next(reader.frames(path, stop_s=(true_last + 2) / 30))
    for read in (reader.probe, reader.frame_times):
        with pytest.raises(InputError, match="last good frame"):
            read(path)


@pytest.mark.parametrize("fraction", [0.1, 0.4, 0.7, 0.99, 0.9999])
@pytest.mark.parametrize("name", ["plain.mkv", "live.mkv"])
def test_a_matroska_cut_within_a_packet_is_refused(files, tmp_path, name, fraction):
    _, at, size = packets(files[name])[int(60 * fraction)]
    path = cut_copy(tmp_path, files[name], at + size // 2)
    for read in (reader.frame_times, lambda p: list(reader.frames(p))):
        with pytest.raises(InputError, match=r"breaks off|ends early") as caught:
            read(path)
    index = int(re.search(r"last good frame is (\d+)", str(caught.value))[1])
    true_last = good_frames(files[name], at) - 1
    assert true_last - 3 <= index <= true_last


@pytest.mark.parametrize("name", ["fast.mp4", "fragmented.mp4", "mjpeg.avi", "mpeg4.avi"])
def test_a_file_cut_between_packets_is_refused(files, tmp_path, name):
    header = 8 if name.endswith("avi") else 0  # the position is behind it
    path = cut_copy(tmp_path, files[name], packets(files[name])[40][1] - header)
    with pytest.raises(InputError, match="the file ends early"):
        reader.frame_times(path)


def test_an_mp4_is_judged_by_its_index_not_its_duration(files, tmp_path):
    data = bytearray(files["plain.mp4"].read_bytes())
    for box, at in ((b"mdhd", 20), (b"mvhd", 20), (b"elst", 12)):
        (duration,) = struct.unpack_from(">I", data, data.index(box) + at)
        struct.pack_into(">I", data, data.index(box) + at, 3 * duration)
    path = tmp_path / "long.mp4"
    path.write_bytes(data)
    assert len(reader.frame_times(path)) == 60


def test_a_matroska_cut_between_clusters_is_caught_by_its_duration(tmp_path):
    # Of unknown size, so that only the duration tells.
    source = write(
        tmp_path / "whole.mkv", "mjpeg", pix_fmt="yuvj420p", container={"cluster_time_limit": "500"}
    )
    data = bytearray(source.read_bytes())
    segment = data.index(bytes.fromhex("18538067")) + 4
    data[segment : segment + 8] = bytes.fromhex("01ffffffffffffff")
    clusters = [m.start() for m in re.finditer(re.escape(bytes.fromhex("1f43b675")), data)]
    path = tmp_path / "cut.mkv"
    path.write_bytes(data[: clusters[2]])
    # How many frames a cluster holds depends on how fast they come.
    left = sum(position < clusters[2] for _, position, _ in packets(source))
    expected = rf"declares a duration of 2\.000 s.* end at {left / 30:.3f} s"
    with pytest.raises(InputError, match=expected) as caught:
        reader.frame_times(path)
    assert int(re.search(r"last good frame is (\d+)", str(caught.value))[1]) == left - 1


def test_a_fragmented_file_cut_between_fragments_is_caught_where_it_declares_a_duration(
    files, tmp_path
):
    data = bytearray(files["fragmented.mp4"].read_bytes())
    timescale = struct.unpack_from(">I", data, data.index(b"mdhd") + 16)[0]
    struct.pack_into(">I", data, data.index(b"mdhd") + 20, 2 * timescale)
    fragments = [m.start() - 4 for m in re.finditer(b"moof", data)]
    path = tmp_path / "cut.mp4"
    path.write_bytes(data[: fragments[2]])
    with pytest.raises(InputError, match=r"declares a duration of 2\.0"):
        reader.frame_times(path)


def test_a_cut_index_at_the_end_is_a_missing_header(files, tmp_path):
    path = cut_copy(tmp_path, files["plain.mp4"], files["plain.mp4"].stat().st_size - 200)
    with pytest.raises(InputError, match="cut short"):
        reader.probe(path)


def test_two_frames_at_one_time_are_refused(tmp_path):
    path = write(tmp_path / "twice.mkv", "mjpeg", pix_fmt="yuvj420p", n=10)
    data = bytearray(path.read_bytes())
    # A block: identifier, length, track 1, time in two bytes, flags; then the data of the packet.
    with av.open(path) as container:
        at = [data.index(bytes(p)) - 3 for p in container.demux(video=0) if p.size][4:6]
    assert np.diff([struct.unpack_from(">h", data, k)[0] for k in at]) == [167 - 133]
    data[at[1] : at[1] + 2] = data[at[0] : at[0] + 2]
    path.write_bytes(data)
    with pytest.raises(InputError, match=r"one frame at a time, found two at 0\.133 s"):
        reader.frame_times(path)


def write_sound(path, *, cover):
    with av.open(path, "w") as out:
        sound = out.add_stream("pcm_s16le", rate=8000, layout="mono")
        if cover:
            picture = out.add_stream("mjpeg", rate=1)
            picture.width, picture.height, picture.pix_fmt = 160, 120, "yuvj420p"
            picture.disposition = Disposition.attached_pic
            out.mux(picture.encode(av.VideoFrame.from_ndarray(draw(1), format="bgr24")))
            out.mux(picture.encode())
        frame = av.AudioFrame.from_ndarray(np.zeros((1, 800), np.int16), "s16", "mono")
        frame.sample_rate = 8000
        out.mux(sound.encode(frame))


def write_header(path):
    whole = write(path.with_name("whole.mp4"), n=5, container=FRAGMENTED).read_bytes()
    path.write_bytes(whole[: whole.index(b"moof") - 4])


NO_VIDEO = {
    "missing": ("take.mp4", lambda path: None),
    "folder": ("take.mp4", lambda path: path.mkdir()),
    "empty": ("take.mp4", lambda path: path.write_bytes(b"")),
    "text": ("take.mp4", lambda path: path.write_text("hello\n" * 100)),
    "picture": ("take.png", lambda path: cv2.imwrite(str(path), draw(1))),
    "sound": ("take.wav", lambda path: write_sound(path, cover=False)),
    "cover": ("take.mp4", lambda path: write_sound(path, cover=True)),
    "no times": ("take.h264", lambda path: write(path, n=5)),
    "header only": ("take.mp4", write_header),
}


@pytest.mark.parametrize(
    ("kind", "found"),
    [
        ("missing", "found none: correct the path"),
        ("folder", "found none: correct the path"),
        ("empty", "found an empty file"),
        ("text", "without a readable header"),
        ("picture", "single picture"),
        ("sound", "sound only"),
        ("cover", "sound only"),
        ("no times", "time stamp on every frame, found 5 of 5 without one"),
        ("header only", "expected frames, found none"),
    ],
)
def test_what_is_no_video_is_one_clear_line(tmp_path, kind, found):
    name, make = NO_VIDEO[kind]
    path = tmp_path / name
    make(path)
    for read in (
        reader.probe,
        reader.frame_times,
        lambda p: next(reader.frames(p)),
        lambda p: reader.read_frame(p, 0),
    ):
        with pytest.raises(InputError, match=found) as caught:
            read(path)
        assert str(caught.value).startswith(f"{path}: expected ") and "\n" not in str(caught.value)


def test_a_listing_knows_where_decoding_can_begin(files):
    listing = list_packets(files["plain.mp4"])
    assert listing.times_s[np.isin(listing.pts, listing.key_pts)].tolist() == pytest.approx(
        [0.0, 0.4, 0.8, 1.2, 1.6]
    )
    assert listing.n_declared == 60 and listing.duration_s == pytest.approx(2.0)
    assert number_in(next(reader.frames(files["plain.mp4"], start_s=0.4))[1]) == 12
