import struct

import pytest

from courtside.devices.realsense import rosbag
from courtside.study.errors import InputError
from fixtures.recordings.depth_recordings_made import write_bag, write_db3

TEXT = "std_msgs/msg/String"


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


def test_as_many_as_the_limit(tmp_path):
    rows = [("/a", TEXT, k, {"data": str(k)}) for k in range(9)]
    with rosbag.opened(write_db3(tmp_path / "a.db3", rows)) as found:
        assert [message.data for message in found.all("/a", 3)] == ["0", "1", "2"]


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
