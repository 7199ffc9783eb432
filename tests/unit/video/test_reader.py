"""What the study's scripts call: on drawn videos, on real ones, with OpenCV and SciPy beside it."""

import gc
import signal

import av
import cv2
import numpy as np
import pytest
import scipy.ndimage

from courtside.study.errors import InputError
from courtside.video import reader
from fixtures.recordings.real_data import REAL, needs_real
from fixtures.recordings.video_files import draw, number_in, numbers, write


@pytest.fixture(scope="module")
def constant(tmp_path_factory):
    return write(tmp_path_factory.mktemp("videos") / "constant.mp4")


@pytest.fixture(scope="module")
def variable(tmp_path_factory):
    """Frames at 0, 10, 20 ... ms, then one gap of 500 ms, then every 100 ms."""
    ticks = [*range(0, 500, 10), *range(1000, 2000, 100)]
    return write(tmp_path_factory.mktemp("videos") / "variable.mp4", ticks=ticks, n=len(ticks))


def test_probe_tells_what_was_written(constant):
    info = reader.probe(constant)
    assert info == reader.VideoInfo(constant, (160, 120), 60, 30.0, 0, 2.0, False)


@pytest.mark.parametrize("rate", [24, 25, 50, 60, 120, 240])
@pytest.mark.parametrize("suffix", [".mp4", ".mkv"])
def test_a_clock_of_milliseconds_does_not_make_a_rate_variable(tmp_path, rate, suffix):
    info = reader.probe(write(tmp_path / f"a{suffix}", rate=rate, n=100))
    assert info.rate_hz == pytest.approx(rate, rel=0.002) and not info.variable_rate


def test_a_rate_is_variable_when_one_frame_is_missing(tmp_path):
    ticks = [40 * k for k in range(50) if k != 20]
    info = reader.probe(write(tmp_path / "a.mp4", rate=25, ticks=ticks, n=49))
    assert info.variable_rate
    assert info.rate_hz == pytest.approx(48 / (49 * 0.04))
    assert info.duration_s == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("start_s", "stop_s", "expected"),
    [
        (None, None, range(60)),
        (0.1, None, range(3, 60)),  # the start belongs to the range
        (0.1001, 0.5, range(4, 15)),  # the end does not
        (None, 0.5001, range(16)),
        (1.9, 99.0, range(57, 60)),
        (-1.0, 0.01, range(1)),
    ],
)
def test_a_range_is_half_open(constant, start_s, stop_s, expected):
    read = list(reader.frames(constant, start_s=start_s, stop_s=stop_s))
    assert numbers(read) == list(expected)
    assert [t for t, _ in read] == [k / 30 for k in expected]


@pytest.mark.parametrize(
    ("start_s", "stop_s"),
    [(2.0, None), (None, 0.0), (1.0, 1.0), (1.0, 0.5), (0.101, 0.102), (None, np.nan)],
)
def test_an_empty_range_is_refused(constant, start_s, stop_s):
    with pytest.raises(InputError, match=r"found none.*from 0 to 2\.000 s"):
        next(reader.frames(constant, start_s=start_s, stop_s=stop_s))


def test_frame_times_are_those_of_the_frames(variable):
    times_s = reader.frame_times(variable)
    assert times_s.tolist() == [t for t, _ in reader.frames(variable)]
    assert reader.frame_times(variable, stop_s=1.1).tolist() == times_s[:51].tolist()


@pytest.mark.parametrize(
    ("time_s", "k"),
    [(0, 0), (0.0149, 1), (0.0151, 2), (0.49, 49), (0.74, 49), (0.76, 50), (1.26, 53), (1.92, 59)],
)
def test_read_frame_takes_the_nearest(variable, time_s, k):
    found_s, image = reader.read_frame(variable, time_s)
    assert number_in(image) == k
    assert found_s == reader.frame_times(variable)[k]


@pytest.mark.parametrize("time_s", [-0.001, 2.001, np.nan, np.inf])
def test_read_frame_refuses_a_time_outside(constant, time_s):
    with pytest.raises(InputError, match=r"expected a time from 0 to 2\.000 s"):
        reader.read_frame(constant, time_s)


def test_read_frames_takes_the_nearest_to_each_time(variable, constant):
    found = list(reader.read_frames(variable, [0.0149, 0.49, 0.76, 1.92]))
    assert [number_in(image) for _, image in found] == [1, 49, 50, 59]
    assert [t for t, _ in found] == reader.frame_times(variable)[[1, 49, 50, 59]].tolist()
    assert list(reader.read_frames(variable, [])) == []
    with pytest.raises(InputError, match=r"expected times from 0 to 2\.000 s, found 0\.1 to 9"):
        list(reader.read_frames(constant, [0.1, 9.0]))
    with pytest.raises(ValueError, match="expected times of different frames"):
        list(reader.read_frames(constant, [0.1, 0.101]))


def test_extract_frames_takes_the_nearest_to_a_grid_once(variable):
    found = list(reader.extract_frames(variable, 0.125))
    times_s = reader.frame_times(variable)
    # Midway between two frames (at 0.125 s) the earlier, which argmin meets first.
    expected = sorted(
        {int(np.argmin(np.round(np.abs(times_s - g), 9))) for g in 0.125 * np.arange(16)}
    )
    assert [index for index, _, _ in found] == expected
    assert [number_in(image) for _, _, image in found] == expected
    assert [t for _, t, _ in found] == times_s[expected].tolist()


def test_extract_frames_denser_than_the_video_gives_every_frame(constant):
    assert [k for k, _, _ in reader.extract_frames(constant, 0.01)] == list(range(60))


def test_extract_frames_begins_its_grid_at_the_start_and_reaches_the_last_frame(constant):
    assert [k for k, _, _ in reader.extract_frames(constant, 0.5)] == [0, 15, 30, 45]
    assert [k for k, _, _ in reader.extract_frames(constant, 59 / 30)] == [0, 59]
    # 11 steps fall short of the last frame in binary; it is on the grid all the same.
    assert [k for k, _, _ in reader.extract_frames(constant, 59 / 330)][-1] == 59


@pytest.mark.parametrize("every_s", [0, -1, np.nan])
def test_extract_frames_wants_a_spacing(constant, every_s):
    with pytest.raises(ValueError, match="positive"):
        next(reader.extract_frames(constant, every_s))


@pytest.mark.parametrize("image", [draw(77), draw(77)[..., 0]], ids=["colour", "grey"])
def test_a_png_reads_back_the_same(tmp_path, image):
    path = tmp_path / "new" / "a.png"
    reader.write_png(path, image)
    np.testing.assert_array_equal(cv2.imread(str(path), cv2.IMREAD_UNCHANGED), image)
    assert [p.name for p in path.parent.iterdir()] == ["a.png"]


@pytest.mark.parametrize(
    "image", [np.zeros((4, 4, 3)), np.zeros((0, 4, 3), np.uint8), np.zeros(4, np.uint8)]
)
def test_what_is_no_picture_is_not_written(tmp_path, image):
    with pytest.raises(ValueError, match="not an 8-bit picture"):
        reader.write_png(tmp_path / "a.png", image)


def test_a_png_the_disk_refuses_leaves_nothing(tmp_path):
    resource = pytest.importorskip("resource", reason="Windows has no such limits")
    image = np.random.default_rng(0).integers(0, 255, (200, 200, 3), np.uint8)
    reader.write_png(tmp_path / "a.png", draw(5))
    before = (tmp_path / "a.png").read_bytes()
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, limits[1]))
        with pytest.raises(InputError, match="free or allow the space"):
            reader.write_png(tmp_path / "a.png", image)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]
    assert (tmp_path / "a.png").read_bytes() == before


def test_sharpness_is_the_variance_of_the_laplacian():
    rng = np.random.default_rng(3)
    grey = rng.integers(0, 255, (60, 80), np.uint8)
    image = np.repeat(grey[..., None], 3, axis=-1)
    # OpenCV mirrors about the edge pixel.
    expected = scipy.ndimage.laplace(grey.astype(float), mode="mirror").var()
    assert reader.sharpness(image) == pytest.approx(expected)
    assert reader.sharpness(cv2.GaussianBlur(image, (0, 0), 2)) < expected / 100
    assert reader.sharpness(np.full((9, 9, 3), 7, np.uint8)) == 0


WALK = [f"walk-4cams/videos/cam0{k}.mp4" for k in (1, 2, 3, 4)]
BOARD = [f"charuco-4cams/calibration/extrinsic/cam_{k}.mp4" for k in range(4)]


@needs_real
@pytest.mark.parametrize("name", WALK + BOARD)
def test_real_files_have_the_frames_they_declare(name):
    walk = name in WALK
    n, rate = (100, 60) if walk else (57, 6)
    size = (1280, 720) if not walk else (1080, 1920) if name in WALK[:2] else (1088, 1920)
    info = reader.probe(REAL / name)
    assert (info.size, info.n_frames, info.rotation_deg, info.variable_rate) == (size, n, 0, False)
    assert info.rate_hz == pytest.approx(rate) and info.duration_s == pytest.approx(n / rate)
    np.testing.assert_allclose(reader.frame_times(REAL / name), np.arange(n) / rate, atol=1e-12)


@needs_real
@pytest.mark.parametrize("name", [WALK[0], WALK[1], WALK[3], BOARD[2]])
def test_real_files_decode_as_with_opencv(name):
    capture = cv2.VideoCapture(str(REAL / name))
    for time_s, image in reader.frames(REAL / name):
        found, theirs = capture.read()
        assert found and time_s == pytest.approx(capture.get(cv2.CAP_PROP_POS_MSEC) / 1000)
        np.testing.assert_array_equal(image[::3, ::3], theirs[::3, ::3])
    assert not capture.read()[0]


@needs_real
@pytest.mark.parametrize("name", [WALK[0], WALK[1], BOARD[0]])
def test_a_late_frame_of_a_real_file_is_the_one_opencv_decodes(name):
    capture = cv2.VideoCapture(str(REAL / name))
    for _ in range(52):
        capture.grab()
    theirs = capture.retrieve()[1]
    time_s, image = reader.read_frame(REAL / name, 51 / capture.get(cv2.CAP_PROP_FPS))
    assert time_s == pytest.approx(51 / capture.get(cv2.CAP_PROP_FPS))
    np.testing.assert_array_equal(image, theirs)


@needs_real
@pytest.mark.parametrize("name", [WALK[0], BOARD[3]])
def test_a_real_file_cut_short_is_refused(tmp_path, name):
    data = (REAL / name).read_bytes()
    path = tmp_path / "cut.mp4"
    path.write_bytes(data[: int(0.8 * len(data))])
    with pytest.raises(InputError, match=r"last good frame|cut short"):
        reader.frame_times(path)


def test_no_stored_frame_outlives_its_turn(constant):
    """A frame whose side data was read refers to itself and could stay until garbage collection."""
    gc.collect()
    gc.disable()
    gc.freeze()  # millions of objects of other tests need not be looked through for each frame
    try:
        alive = []
        for _ in reader.frames(constant):
            alive.append(sum(isinstance(each, av.VideoFrame) for each in gc.get_objects()))
    finally:
        gc.unfreeze()
        gc.enable()
    assert len(alive) == 60
    assert max(alive[10:]) <= max(alive[:10]) + 1
