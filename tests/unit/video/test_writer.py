"""Written videos: read back by the reader, by PyAV and by OpenCV."""

import av
import cv2
import numpy as np
import pytest

from courtside.video import reader, writer
from fixtures.recordings.video_files import draw, number_in


def write(path, n=40, rate_hz=30.0, crf=18, size=(160, 120)):
    writer.write_video(path, (draw(k, size) for k in range(n)), rate_hz, crf=crf)
    return path


@pytest.mark.parametrize("rate_hz", [30.0, 29.97, 2.6542, 0.5, 240.0, 149 / 56.4261])
def test_every_frame_is_there_at_its_time(tmp_path, rate_hz):
    path = write(tmp_path / "a.mp4", rate_hz=rate_hz)
    times_s = reader.frame_times(path)
    np.testing.assert_allclose(times_s, np.arange(40) / rate_hz, rtol=1e-6, atol=1e-9)
    info = reader.probe(path)
    assert (info.size, info.n_frames, info.variable_rate) == ((160, 120), 40, False)
    assert [number_in(image) for _, image in reader.frames(path)] == list(range(40))


@pytest.mark.parametrize("start_s", [0.0, 7.31])
def test_uneven_frames_are_shown_at_their_times(tmp_path, start_s):
    """As of a phone: 30 Hz, 15 in the dark, a frame of 24 ms between, one dropped."""
    steps = np.r_[np.full(12, 1 / 30), np.full(10, 1 / 15), 0.024, np.full(8, 1 / 30), 0.1]
    times_s = start_s + np.concatenate([[0], np.cumsum(steps)])
    path, n = tmp_path / "a.mp4", len(times_s)
    pictures = (draw(k) for k in range(n))
    assert writer.write_video(path, pictures, 1 / steps.mean(), crf=18, times_s=times_s) == n
    read = list(reader.frames(path))
    assert [number_in(image) for _, image in read] == list(range(n))
    np.testing.assert_allclose([t for t, _ in read], times_s - start_s, atol=1 / 90_000)
    capture, by_opencv = cv2.VideoCapture(str(path)), []
    while capture.read()[0]:
        by_opencv.append(capture.get(cv2.CAP_PROP_POS_MSEC) / 1000)
    np.testing.assert_allclose(by_opencv, times_s - start_s, atol=1 / 90_000)


@pytest.mark.parametrize(
    ("times_s", "message"),
    [
        ([0, 0.1, 0.1], "increasing"),
        ([0, 0.1], "a time for each frame, found 2"),
        ([0, 1, 2, 3], "found 4"),
    ],
)
def test_times_that_are_not_those_of_the_frames_are_refused(tmp_path, times_s, message):
    with pytest.raises(ValueError, match=message):
        pictures = (draw(k) for k in range(3))
        writer.write_video(tmp_path / "a.mp4", pictures, 10, crf=18, times_s=times_s)
    assert list(tmp_path.iterdir()) == []


def test_any_frame_can_be_sought(tmp_path):
    path = write(tmp_path / "a.mp4", rate_hz=10.0)
    for k in (39, 0, 17, 25):
        assert number_in(reader.read_frame(path, k / 10)[1]) == k
    with av.open(str(path)) as container:
        keys = [k for k, frame in enumerate(container.decode(video=0)) if frame.key_frame]
    assert max(np.diff([*keys, 40])) <= writer.KEYFRAME_EVERY


def test_opencv_reads_the_same_pictures(tmp_path):
    capture = cv2.VideoCapture(str(write(tmp_path / "a.mp4", n=5)))
    seen = [capture.read()[1] for _ in range(5)]
    assert [number_in(image) for image in seen] == list(range(5)) and not capture.read()[0]


def noisy(count, size=(160, 120)):
    rng = np.random.default_rng(0)
    for k in range(count):
        picture = draw(k, size).astype(float) + rng.normal(0, 6, (size[1], size[0], 1))
        yield np.clip(picture, 0, 255).astype(np.uint8)


def test_a_lower_crf_is_nearer_to_the_pictures(tmp_path):
    errors = []
    for crf in (1, 18, 34):
        path = tmp_path / f"{crf}.mp4"
        writer.write_video(path, noisy(10), 30, crf=crf)
        pairs = zip(reader.frames(path), noisy(10), strict=True)
        grey = [(cv2.cvtColor(a, 6).astype(int), cv2.cvtColor(b, 6)) for (_, a), b in pairs]
        errors.append(np.mean([np.abs(a - b).mean() for a, b in grey]))
    assert errors[0] < 1.5 and errors[0] < errors[1] < errors[2]


def moving(count):
    """Yield a noisy texture that moves."""
    rng = np.random.default_rng(0)
    texture = cv2.GaussianBlur(rng.uniform(0, 255, (270, 480)).astype(np.float32), (0, 0), 8)
    texture = cv2.cvtColor((texture - 127) * 15 + 127, cv2.COLOR_GRAY2BGR)
    for k in range(count):
        picture = np.roll(texture, 3 * k, axis=1) + rng.normal(0, 5, texture.shape)
        yield np.clip(picture, 0, 255).astype(np.uint8)


def test_the_same_pictures_give_the_same_bytes(tmp_path):
    rng, found = np.random.default_rng(0), set()
    pictures = list(moving(12))
    for _ in range(6):
        # What lies in memory that was freed must not matter.
        used = [rng.integers(0, 255, rng.integers(1000, 300_000), np.uint8) for _ in range(100)]
        del used
        assert writer.write_video(tmp_path / "a.mp4", pictures, 2.5, crf=26) == 12
        found.add((tmp_path / "a.mp4").read_bytes())
    assert len(found) == 1


@pytest.mark.parametrize(
    ("images", "rate_hz", "message"),
    [
        ([], 30, "at least one frame"),
        ([np.zeros((120, 161, 3), np.uint8)], 30, "even width and height"),
        ([np.zeros((121, 160, 3), np.uint8)], 30, "even width and height"),
        ([np.zeros((120, 160, 3), float)], 30, "8-bit BGR"),
        ([np.zeros((120, 160), np.uint8)], 30, "8-bit BGR"),
        ([np.zeros((120, 160, 3), np.uint8), np.zeros((60, 80, 3), np.uint8)], 30, "one size"),
        ([np.zeros((120, 160, 3), np.uint8)], 0, "positive rate_hz"),
        ([np.zeros((120, 160, 3), np.uint8)], np.nan, "positive rate_hz"),
    ],
)
def test_what_cannot_be_written_is_refused_and_leaves_no_file(tmp_path, images, rate_hz, message):
    with pytest.raises(ValueError, match=message):
        writer.write_video(tmp_path / "a.mp4", images, rate_hz, crf=20)
    assert list(tmp_path.iterdir()) == []
