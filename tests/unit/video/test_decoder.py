"""Decoded pictures against the pictures drawn, against OpenCV, and under damage at known bytes."""

import contextlib
import re

import av
import cv2
import numpy as np
import pytest

from courtside.study.errors import InputError
from courtside.video import decoder, reader
from courtside.video.glance import glance
from courtside.video.packets import list_packets
from fixtures.recordings.video_files import (
    H264,
    draw,
    good_frames,
    number_in,
    numbers,
    packets,
    write,
)

OPEN_GOP = {
    "g": "12",
    "bf": "2",
    "x264opts": "open-gop=1:threads=1:b-adapt=0:scenecut=0:min-keyint=12",
}
KINDS = {
    "b_frames.mp4": {},
    "open_gop.mp4": {"options": OPEN_GOP},
    "open_gop.ts": {"options": OPEN_GOP},
    "b_frames.mkv": {},
    "b_frames.avi": {},
    "mpeg4.avi": {"codec": "mpeg4", "options": {"bf": "2"}},
    "mjpeg.avi": {"codec": "mjpeg", "pix_fmt": "yuvj420p"},
    "ffv1.mkv": {"codec": "ffv1", "options": {"level": "3", "slicecrc": "1"}},
    "hevc.mp4": {
        "codec": "libx265",
        "options": {"x265-params": "log-level=none:keyint=12:pools=1"},
    },
    "ten_bit.mp4": {
        "codec": "libx265",
        "options": {"x265-params": "log-level=none:pools=1"},
        "pix_fmt": "yuv420p10le",
    },
    "vp9.webm": {"codec": "libvpx-vp9", "options": {"g": "12"}},
    "mpeg2.mpg": {"codec": "mpeg2video", "options": {"bf": "2"}},
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("videos")
    return {name: write(folder / name, **how) for name, how in KINDS.items()}


def by_opencv(path):
    capture, images = cv2.VideoCapture(str(path)), []
    while True:
        found, image = capture.read()
        if not found:
            return np.array(images)
        images.append(image)


def altered(tmp_path, path, at, values):
    data = bytearray(path.read_bytes())
    data[at : at + len(values)] = values
    target = tmp_path / f"altered{path.suffix}"
    target.write_bytes(data)
    return target


@pytest.mark.parametrize("name", KINDS)
def test_every_frame_comes_once_and_in_the_order_shown(files, name):
    read = list(reader.frames(files[name]))
    assert numbers(read) == list(range(60))
    np.testing.assert_allclose([t for t, _ in read], np.arange(60) / 30, atol=0.0006)
    drawn = np.array([draw(k) for k in range(60)], dtype=float)
    assert np.abs(np.array([image for _, image in read]) - drawn).mean() < 8


@pytest.mark.parametrize("name", KINDS)
def test_opencv_decodes_the_same_pixels(files, name):
    ours = np.array([image for _, image in reader.frames(files[name])])
    theirs = by_opencv(files[name])
    assert ours.shape == theirs.shape
    np.testing.assert_array_equal(ours, theirs)


@pytest.mark.parametrize("name", KINDS)
def test_a_range_holds_the_pictures_of_the_whole(files, name):
    whole = list(reader.frames(files[name]))
    for first in (0, 1, 11, 12, 13, 25, 38, 59):
        start_s = whole[first][0]
        stop_s = start_s + 0.1001
        part = list(reader.frames(files[name], start_s=start_s, stop_s=stop_s))
        expected = [(t, image) for t, image in whole if start_s <= t < stop_s]
        assert [t for t, _ in part] == [t for t, _ in expected]
        np.testing.assert_array_equal([i for _, i in part], [i for _, i in expected])


class Counted:
    """A container that notes the packets taken from it."""

    def __init__(self, container, taken):
        self.container, self.taken = container, taken

    def seek(self, *args, **kwargs):
        self.container.seek(*args, **kwargs)

    def demux(self, stream):
        for packet in self.container.demux(stream):
            self.taken.append(packet.pts)
            yield packet


def test_a_late_range_reads_only_from_the_key_frame_before(files, monkeypatch):
    taken = []
    opened = decoder.opened

    @contextlib.contextmanager
    def counted(path):
        with opened(path) as (container, stream):
            yield Counted(container, taken), stream

    monkeypatch.setattr(decoder, "opened", counted)
    assert numbers(reader.frames(files["b_frames.mp4"], start_s=51 / 30)) == list(range(51, 60))
    # The key frames are every twelve, so from 48 on; then the sign for the end.
    assert len(taken) == 12 + 1


def test_frames_far_apart_are_read_from_the_key_frames_before_them(files, tmp_path):
    whole = [image for _, image in reader.frames(files["b_frames.mp4"])]
    _, at, size = packets(files["b_frames.mp4"])[14]
    path = altered(tmp_path, files["b_frames.mp4"], at, bytes(size))
    read = list(decoder.pictures(list_packets(path), [2, 49, 55]))
    assert [index for index, _ in read] == [2, 49, 55]
    assert all(np.array_equal(image, whole[index]) for index, image in read)
    # Going on from the key frame 12 would save nine frames only: the damaged one is decoded.
    with pytest.raises(InputError, match=r"frame 1[2-9]"):
        list(decoder.pictures(list_packets(path), [2, 20]))


def test_damage_before_the_range_does_not_matter(files, tmp_path):
    _, at, size = packets(files["b_frames.mp4"])[1]
    path = altered(tmp_path, files["b_frames.mp4"], at, bytes(size))
    assert numbers(reader.frames(path, start_s=0.8)) == list(range(24, 60))
    with pytest.raises(InputError, match="no frame is known to be good"):
        list(reader.frames(path))


@pytest.mark.parametrize(
    "name", ["b_frames.mp4", "b_frames.mkv", "mpeg4.avi", "ffv1.mkv", "open_gop.ts"]
)
@pytest.mark.parametrize("k", [9, 30, 55])
def test_altered_bytes_stop_at_the_last_good_frame(files, tmp_path, name, k):
    pts, at, size = packets(files[name])[k]
    start = at + (188 - 20 if name.endswith(".ts") else size // 2)
    path = altered(tmp_path, files[name], start, bytes([255, 3, 77, 0] * 4))
    damaged = sorted(p[0] for p in packets(files[name])).index(pts)
    with pytest.raises(InputError) as caught:
        list(reader.frames(path))
    message = str(caught.value)
    assert str(path) in message and "\n" not in message
    index, time_s = re.search(r"last good frame is (\d+) at ([\d.]+) s", message).groups()
    # Good for sure are the frames before all that may lean on the damaged one; a decoder that fails
    # takes the frames with it that wait for their turn.
    assert good_frames(files[name], at) - 1 - 3 <= int(index) < damaged
    good = list(reader.frames(path, stop_s=float(time_s)))
    truth = list(reader.frames(files[name], stop_s=float(time_s)))
    assert len(good) in (int(index), int(index) + 1)
    np.testing.assert_array_equal([image for _, image in good], [image for _, image in truth])


def test_what_is_good_comes_before_the_error(files, tmp_path):
    _, at, size = packets(files["ffv1.mkv"])[30]
    path = altered(tmp_path, files["ffv1.mkv"], at + size // 2, b"abcdefgh")
    read = []
    with pytest.raises(InputError, match=r"last good frame is 29 at 0\.967 s"):
        for item in reader.frames(path):
            read.append(item)
    assert numbers(read) == list(range(30))


@pytest.mark.parametrize(
    ("name", "k", "part", "values"),
    [
        ("mpeg4.avi", 20, 0.6, bytes(8)),  # decodes, and only the frame's flag tells
        ("mjpeg.avi", 20, 0.8, bytes([255] * 8)),  # decodes unless the decoder is told to be strict
    ],
)
def test_damage_the_decoder_would_paper_over_is_found(files, tmp_path, name, k, part, values):
    pts, at, size = packets(files[name])[k]
    path = altered(tmp_path, files[name], at + int(part * size), values)
    assert len(by_opencv(path)) == 60
    damaged = sorted(p[0] for p in packets(files[name])).index(pts)
    with pytest.raises(InputError, match=f"last good frame is {damaged - 1} at"):
        list(reader.frames(path))


def test_damaged_frames_shown_before_the_key_frame_do_not_matter(files, tmp_path):
    # With open groups, frames stored after a key frame may be shown before it.
    listing = list_packets(files["open_gop.mp4"])
    key = int(listing.key_pts[3])
    stored = packets(files["open_gop.mp4"])
    place = [p[0] for p in stored].index(key)
    leading = [p for p in stored[place + 1 : place + 4] if p[0] < key]
    assert leading
    path = files["open_gop.mp4"]
    for _, at, size in leading:
        path = altered(tmp_path, path, at, bytes(size))
    start_s = float(listing.seconds(key))
    whole = [(t, i) for t, i in reader.frames(files["open_gop.mp4"]) if t >= start_s]
    part = list(reader.frames(path, start_s=start_s))
    assert [t for t, _ in part] == [t for t, _ in whole]
    np.testing.assert_array_equal([i for _, i in part], [i for _, i in whole])


def test_a_piece_that_begins_between_key_frames_begins_with_the_first_that_decodes(files, tmp_path):
    """As later files of a camcorder; the key frames are every twelve, groups are open.

    Frames that do not decode leave the others at their times since the first of the file, by
    which frames of cameras that share a clock are paired.
    """
    source = files["open_gop.ts"]
    shown = sorted(pts for pts, _, _ in packets(source))
    for k in (3, 14, 30):
        path = tmp_path / f"piece{k}.ts"
        _, at, _ = packets(source)[k]
        path.write_bytes(source.read_bytes()[at:])
        read = list(reader.frames(path))
        first = -(-k // 12) * 12
        assert numbers(read) == list(range(first, 60))
        lost = first - shown.index(min(pts for pts, _, _ in packets(source)[k:]))
        assert lost > 0
        at_s = (lost + np.arange(60 - first)) / 30
        np.testing.assert_allclose([t for t, _ in read], at_s, atol=1e-4)
        assert glance(path).n_frames == 60 - first
        every = list(reader.extract_frames(path, 0.5))
        wanted_s = np.arange(-(-lost // 15), (lost + 59 - first) // 15 + 1) / 2
        np.testing.assert_allclose([t for _, t, _ in every], wanted_s, atol=1 / 60)


def test_a_packet_missing_from_the_middle_is_found(tmp_path):
    # All key frames, so that no decoder misses it: the index of the file must.
    source = write(
        tmp_path / "whole.mp4", "mjpeg", pix_fmt="yuvj420p", container={"movflags": "faststart"}
    )
    _, at, size = packets(source)[20]
    path = altered(tmp_path, source, at, bytes(size))
    with pytest.raises(InputError, match="last good frame is 19"):
        list(reader.frames(path))


def corners(image):
    """Name the colour in each corner, clockwise from the top left."""
    height, width = image.shape[:2]
    found = [
        image[y, x] for y, x in ((5, 5), (5, width - 6), (height - 6, width - 6), (height - 6, 5))
    ]
    return "".join("kbgr"[0 if max(pixel) < 100 else 1 + int(np.argmax(pixel))] for pixel in found)


@pytest.mark.parametrize("suffix", [".mp4", ".mkv"])
@pytest.mark.parametrize(
    ("degrees_ccw", "mirrored", "shown", "rotation_deg"),
    [
        (0, False, "rgbk", 0),
        (90, False, "gbkr", 270),
        (180, False, "bkrg", 180),
        (-90, False, "krgb", 90),
        (0, True, "grkb", None),
        (90, True, "bgrk", None),
        (180, True, "kbgr", None),
        (-90, True, "rkbg", None),
    ],
)
def test_pictures_stand_upright(tmp_path, suffix, degrees_ccw, mirrored, shown, rotation_deg):
    stored = np.zeros((80, 120, 3), np.uint8)
    stored[:40, :60, 2] = stored[:40, 60:, 1] = stored[40:, 60:, 0] = 255
    assert corners(stored) == "rgbk"
    path = write(
        tmp_path / f"turned{suffix}",
        n=3,
        images=[stored] * 3,
        size=(120, 80),
        turn=(degrees_ccw, mirrored),
    )
    info = reader.probe(path)
    images = [image for _, image in reader.frames(path)]
    assert [corners(image) for image in images] == [shown] * 3
    assert (
        info.size == images[0].shape[1::-1] == ((120, 80) if degrees_ccw in (0, 180) else (80, 120))
    )
    if not mirrored:
        assert info.rotation_deg == rotation_deg
        np.testing.assert_array_equal(images, by_opencv(path))


def test_a_slanted_picture_is_refused(tmp_path):
    path = write(tmp_path / "slanted.mp4", n=3, turn=(45, False))
    for read in (reader.probe, lambda p: next(reader.frames(p))):
        with pytest.raises(InputError, match=r"turned by quarters.*0\.707"):
            read(path)


@pytest.mark.parametrize(
    ("name", "how"),
    [
        ("odd.avi", {"codec": "mjpeg", "pix_fmt": "yuvj444p"}),
        ("odd420.avi", {"codec": "mjpeg", "pix_fmt": "yuvj420p"}),
        ("odd.mkv", {"codec": "ffv1", "pix_fmt": "bgr0"}),
        ("odd.mp4", {"codec": "libx264", "pix_fmt": "yuv444p"}),
    ],
)
def test_pictures_of_odd_sizes_decode_as_with_opencv(tmp_path, name, how):
    path = write(tmp_path / name, size=(101, 77), n=8, **how)
    assert reader.probe(path).size == (101, 77)
    read = list(reader.frames(path))
    assert numbers(read) == list(range(8))
    images = np.array([image for _, image in read])
    assert images.shape == (8, 77, 101, 3)
    np.testing.assert_array_equal(images, by_opencv(path))
    if name == "odd.mkv":  # without loss
        np.testing.assert_array_equal(images, [draw(k, (101, 77)) for k in range(8)])


def test_pictures_kept_are_not_overwritten(files):
    kept = list(reader.frames(files["b_frames.mp4"]))
    copies = [image.copy() for _, image in reader.frames(files["b_frames.mp4"])]
    np.testing.assert_array_equal([image for _, image in kept], copies)
    kept[0][1][:] = 0
    assert number_in(kept[1][1]) == 1


def test_a_change_of_size_is_refused(tmp_path):
    small = write(tmp_path / "small.avi", "mjpeg", pix_fmt="yuvj420p", size=(80, 60), n=5)
    path = tmp_path / "both.avi"
    with av.open(path, "w") as out:
        stream = out.add_stream("mjpeg", rate=30)
        stream.width, stream.height, stream.pix_fmt = 160, 120, "yuvj420p"
        for k in range(5):
            out.mux(stream.encode(av.VideoFrame.from_ndarray(draw(k), format="bgr24")))
        with av.open(small) as source:
            for packet in source.demux(video=0):
                if packet.size:
                    packet.pts += 5
                    packet.dts += 5
                    packet.stream = stream
                    out.mux(packet)
    with pytest.raises(InputError, match=r"one size, 160x120, found 80x60 at frame 5"):
        list(reader.frames(path))


def test_only_the_wanted_frames_come(files):
    listing = list_packets(files["b_frames.mp4"])
    read = list(decoder.pictures(listing, [3, 14, 15, 40]))
    assert (
        [index for index, _ in read] == [number_in(image) for _, image in read] == [3, 14, 15, 40]
    )


@pytest.mark.fuzz
@pytest.mark.parametrize(
    "name", ["b_frames.mp4", "b_frames.mkv", "mpeg4.avi", "open_gop.ts", "ffv1.mkv", "mjpeg.avi"]
)
def test_mutated_files_end_well_or_in_one_line(files, tmp_path, name):
    rng = np.random.default_rng(20)
    data = files[name].read_bytes()
    n_refused = 0
    for _ in range(150):
        at = int(rng.integers(len(data) - 20))
        path = altered(tmp_path, files[name], at, rng.bytes(int(rng.integers(1, 20))))
        if rng.random() < 0.3:
            path.write_bytes(path.read_bytes()[: int(rng.integers(len(data)))])
        try:
            times_s = [t for t, _ in reader.frames(path)]
        except InputError as error:
            n_refused += 1
            assert "\n" not in str(error) and str(path) in str(error)
        else:
            assert times_s == reader.frame_times(path).tolist()
    assert n_refused > 40


def test_h264_options_make_b_frames(files):
    # The tests above lean on it.
    pts = [p[0] for p in packets(files["b_frames.mp4"])]
    assert H264["bf"] == "2" and pts != sorted(pts)
