import numpy as np
import pytest

from courtside.records.cameras import frame_times
from courtside.records.cameras.frame_times import FrameTimes
from courtside.records.keypoints import keypoints
from courtside.study.errors import InputError

TIMES = FrameTimes(np.array([12.0, 12.033333, 12.1, 12.133333]), np.array([5, 6, 8, 9]))


def view(n):
    return keypoints.Keypoints2D(
        camera="c",
        model="m",
        joints=np.array(["nose"]),
        size=np.array([64, 48]),
        time_s=np.arange(n) / 30,
        xy=np.zeros((1, n, 1, 2)),
        score=np.ones((1, n, 1)),
        reason=np.zeros((1, n, 1), np.uint8),
        xyz_in_body=np.zeros((1, n, 1, 3)),
        clothing=np.zeros((1, n, 2, 3)),
    )


def test_what_is_written_is_read(tmp_path):
    path = tmp_path / "a.csv"
    frame_times.write(path, TIMES)
    found = frame_times.read(path)
    assert found.time_s.tolist() == TIMES.time_s.tolist()
    assert found.number.tolist() == TIMES.number.tolist()


def test_rate_is_that_between_two_frames():
    assert TIMES.rate_hz == pytest.approx(30, abs=0.01)
    assert FrameTimes(np.array([1.0]), np.array([1])).rate_hz == 30.0


def test_keypoints_take_the_device_s_times(tmp_path):
    path = tmp_path / "a.csv"
    frame_times.write(path, TIMES)
    assert frame_times.on_device_clock(view(4), path).time_s.tolist() == TIMES.time_s.tolist()
    with pytest.raises(InputError, match="expected 3 frames"):
        frame_times.on_device_clock(view(3), path)


@pytest.mark.parametrize(
    "content",
    [
        "",
        "a,b\n1,2\n",
        "frame_idx,number,time_s\n0,1,x\n",
        "frame_idx,number,time_s\n0,1,2.0\n1,2,2.0\n",
        "frame_idx,number,time_s\n0,1,nan\n",
    ],
)
def test_other_tables_are_refused(tmp_path, content):
    path = tmp_path / "a.csv"
    path.write_text(content)
    with pytest.raises(InputError, match="expected a table of frame times"):
        frame_times.read(path)
