import sqlite3
import struct
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

from courtside.devices.realsense import recording, rosbag
from courtside.study.errors import InputError
from fixtures.recordings.depth_recordings_made import (
    frames,
    messages_of_db3,
    write_bag,
    write_db3,
)

TEXT = "std_msgs/msg/String"
ROS1 = get_typestore(Stores.ROS1_NOETIC)


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    return write_bag(tmp_path_factory.mktemp("bags") / "a.bag")


def test_messages_come_in_order_of_time(tmp_path):
    rows = [("/b", TEXT, 20, {"data": "late"}), ("/a", TEXT, 10, {"data": "early"})]
    path = write_db3(tmp_path / "a.db3", [*rows, ("/c", TEXT, 5, {"data": "other"})])
    with rosbag.opened(path) as found:
        assert found.counts == {"/a": 1, "/b": 1, "/c": 1}
        got = [(topic, time, message.data) for topic, time, message in found.messages(["/a", "/b"])]
        assert got == [("/a", 10, "early"), ("/b", 20, "late")]
        assert found.first("/c").data == "other"
        assert found.first("/d") is None


def test_all_returns_at_most_the_limit(tmp_path):
    rows = [("/a", TEXT, k, {"data": str(k)}) for k in range(9)]
    with rosbag.opened(write_db3(tmp_path / "a.db3", rows)) as found:
        assert [message.data for message in found.all("/a", 3)] == ["0", "1", "2"]


@pytest.mark.parametrize(("frame_id", "unit"), [("0", b""), ("1", b"unit")])
def test_the_depth_unit_that_the_sdk_appends_to_pictures_is_no_damage(tmp_path, frame_id, unit):
    """SDK 2.48 to 2.57 states by the frame_id `1` that four bytes follow the picture."""
    kind, path, types = "sensor_msgs/msg/Image", tmp_path / "a.bag", ROS1.types
    stamp = types["builtin_interfaces/msg/Time"](sec=12, nanosec=5)
    header = types["std_msgs/msg/Header"](seq=7, stamp=stamp, frame_id=frame_id)
    picture = types[kind](header=header, **vars(message(DEPTH, "mono16")))
    with Writer(path) as writer:
        topic = writer.add_connection("/depth", kind, typestore=ROS1)
        for time_ns in (1, 2):
            writer.write(topic, time_ns, bytes(ROS1.serialize_ros1(picture, kind)) + unit)
    with rosbag.opened(path) as found:
        read = [rosbag.depth(one) for _, _, one in found.messages(["/depth"])]
    assert np.array_equal(read, [DEPTH, DEPTH])


def packed_db3(path, pack):
    """Write a recording whose messages are packed one by one, as SDK 2.58 does."""

    def plain(image, encoding):
        return "", "sensor_msgs/msg/Image", vars(message(image, encoding))

    write_db3(path, messages_of_db3(frames(), plain))
    with sqlite3.connect(path) as base:
        base.create_function("pack", 1, pack)
        base.execute("UPDATE messages SET data = pack(data)")
    return path


def test_compressed_messages_are_unpacked(tmp_path):
    found = recording.read(packed_db3(tmp_path / "a.db3", rosbag.zstd.compress))
    pictures = [picture for _, picture in found.depth_frames()]
    assert np.array_equal(pictures, [steps for _, _, steps in frames()])


def test_compressed_messages_that_are_damaged_or_too_large_are_refused(tmp_path, monkeypatch):
    path = packed_db3(tmp_path / "a.db3", lambda raw: rosbag.zstd.compress(raw)[:6] + b"damage")
    with pytest.raises(InputError, match="whole recording"):
        recording.read(path)
    monkeypatch.setattr(rosbag, "LARGEST_MESSAGE_BYTES", 1 << 10)
    large = recording.read(packed_db3(tmp_path / "b.db3", rosbag.zstd.compress))
    with pytest.raises(InputError, match="whole recording"):
        list(large.depth_frames())


@pytest.mark.parametrize("name", ["none.bag", "none.db3", "."])
def test_a_missing_file_is_named(tmp_path, name):
    with pytest.raises(InputError, match="expected a recording"), rosbag.opened(tmp_path / name):
        pass


@pytest.mark.parametrize("name", ["a.bag", "a.db3", "a.mp4"])
def test_other_files_are_refused_in_one_line(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(b"not a recording at all\n" * 99)
    with (
        pytest.raises(InputError, match=r"expected .*recording.* found") as raised,
        rosbag.opened(path),
    ):
        pass
    assert "\n" not in str(raised.value)


def test_a_recording_that_was_not_finished_says_so(bag, tmp_path):
    content = bytearray(bag.read_bytes())
    at = content.index(b"index_pos=") + len(b"index_pos=")
    content[at : at + 8] = struct.pack("<Q", 0)
    path = tmp_path / "cut.bag"
    path.write_bytes(content)
    with pytest.raises(InputError, match="not finished"), rosbag.opened(path):
        pass


def test_topics_without_a_readable_name_are_damage(tmp_path):
    path = write_db3(tmp_path / "a.db3", [("/a\nb", TEXT, 1, {"data": "x"})])
    with pytest.raises(InputError, match="readable name"), rosbag.opened(path):
        pass


@pytest.mark.parametrize("share", [0.0, 0.01, 0.3, 0.7, 0.999])
def test_a_recording_cut_short_is_refused(bag, tmp_path, share):
    content = bag.read_bytes()
    path = tmp_path / "cut.bag"
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(InputError, match="whole recording"), rosbag.opened(path):
        pass


RNG = np.random.default_rng(3)
BGR = RNG.integers(0, 256, (6, 8, 3), dtype=np.uint8)
DEPTH = RNG.integers(0, 65536, (6, 8), dtype=np.uint16)


def message(stored, encoding, pad=0, **changed):
    rows = np.ascontiguousarray(stored).view(np.uint8).reshape(len(stored), -1)
    rows = np.pad(rows, ((0, 0), (0, pad)))
    values = {
        "height": stored.shape[0],
        "width": stored.shape[1],
        "step": rows.shape[1],
        "encoding": encoding,
        "is_bigendian": 0,
        "data": rows.ravel(),
    }
    return SimpleNamespace(**(values | changed))


@pytest.mark.parametrize("pad", [0, 5])
@pytest.mark.parametrize(
    ("encoding", "stored"),
    [
        ("bgr8", BGR),
        ("rgb8", BGR[..., ::-1]),
        ("RGB8", BGR[..., ::-1]),
        ("bgra8", np.dstack([BGR, np.full((6, 8), 9, np.uint8)])),
        ("rgba8", np.dstack([BGR[..., ::-1], np.full((6, 8), 9, np.uint8)])),
    ],
)
def test_every_colour_encoding_becomes_bgr(encoding, stored, pad):
    assert np.array_equal(rosbag.colour(message(stored, encoding, pad)), BGR)


def test_grey_becomes_equal_channels():
    grey = BGR[..., 0]
    assert np.array_equal(rosbag.colour(message(grey, "mono8")), np.dstack([grey] * 3))


@pytest.mark.parametrize(("encoding", "luma"), [("yuyv", 0), ("uyvy", 1)])
def test_yuv_without_colour_is_grey_of_its_luma(encoding, luma):
    """ITU-R BT.601: luma 16 is black, 235 is white; 128 in both differences is no colour."""
    stored = np.full((4, 8, 2), 128, dtype=np.uint8)
    stored[:2, :, luma], stored[2:, :, luma] = 16, 235
    found = rosbag.colour(message(stored, encoding))
    assert np.abs(found[:2].astype(int)).max() <= 1
    assert np.abs(found[2:].astype(int) - 255).max() <= 1


@pytest.mark.parametrize("encoding", ["mono16", "16UC1", "z16"])
@pytest.mark.parametrize("pad", [0, 6])
def test_every_depth_encoding_becomes_16_bit(encoding, pad):
    assert np.array_equal(rosbag.depth(message(DEPTH, encoding, pad)), DEPTH)


def test_big_endian_depth_is_swapped():
    swapped = DEPTH.astype(">u2")
    assert np.array_equal(rosbag.depth(message(swapped, "mono16", is_bigendian=1)), DEPTH)


def test_rows_in_zstandard_are_read_as_the_sdk_packs_them():
    """pyrealsense2 2.59.1 records YUYV so; 128 in both differences is grey, luma 235 is white."""
    stored = np.full((4, 10, 2), 128, dtype=np.uint8)
    stored[:, :8, 0] = 235
    data = np.frombuffer(rosbag.zstd.compress(stored.tobytes()), dtype=np.uint8)
    found = SimpleNamespace(format="YUYV; zstd; 8x4 step=20", data=data)
    picture = rosbag.colour(found)
    assert picture.shape == (4, 8, 3)
    assert np.abs(picture.astype(int) - 255).max() <= 1
    with pytest.raises(ValueError, match="found rows of 20 and 80 bytes"):
        rosbag.colour(SimpleNamespace(format="YUYV; zstd; 8x5 step=20", data=data))
    with pytest.raises(ValueError, match="a packed picture that does not open"):
        rosbag.colour(SimpleNamespace(format="YUYV; zstd; 8x4 step=20", data=data[::-1]))


def test_compressed_pictures_are_decoded():
    png = cv2.imencode(".png", BGR)[1].ravel()
    found = SimpleNamespace(format="rgb8; png compressed bgr8", data=png)
    assert np.array_equal(rosbag.colour(found), BGR)
    png = np.concatenate([np.zeros(12, np.uint8), cv2.imencode(".png", DEPTH)[1].ravel()])
    found = SimpleNamespace(format="16UC1; compressedDepth png", data=png)
    assert np.array_equal(rosbag.depth(found), DEPTH)


@pytest.mark.parametrize(
    ("decode", "wrong"),
    [
        (rosbag.colour, message(BGR, "bayer_rggb8")),
        (rosbag.colour, message(BGR, "bgr8", height=7)),
        (rosbag.colour, message(BGR, "bgr8", width=80)),
        (rosbag.colour, message(BGR, "bgr8", height=0, data=np.zeros(0, np.uint8))),
        (rosbag.colour, message(BGR, "bgr8", step=0)),
        (rosbag.colour, message(BGR, "bgr8", width=2**31, height=2**31)),
        (rosbag.depth, message(DEPTH, "32FC1")),
        (rosbag.depth, message(DEPTH, "mono16", step=8)),
        (rosbag.colour, SimpleNamespace(format="jpeg", data=np.zeros(9, np.uint8))),
        (rosbag.colour, SimpleNamespace(format="jpeg", data=np.zeros(0, np.uint8))),
        (rosbag.depth, SimpleNamespace(format="32FC1; compressedDepth", data=np.zeros(99))),
        (
            rosbag.depth,
            SimpleNamespace(format="16UC1; png", data=cv2.imencode(".png", BGR)[1].ravel()),
        ),
    ],
)
def test_what_is_no_picture_is_refused(decode, wrong):
    with pytest.raises(ValueError, match=r"expected|does not open"):
        decode(wrong)
