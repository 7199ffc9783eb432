"""Shake of a fixed camera: known rotations through a known lens, with people and noise."""

import cv2
import numpy as np
import pytest

from courtside.video import reader, shake_tracking, writer
from fixtures.recordings.real_data import REAL, needs_real
from fixtures.recordings.still_pictures import moved, texture
from fixtures.recordings.turned_pictures import SIZE, Grain, K, Turning, true_movement, wall

N_FRAMES, KNOCK = 16, 10


@pytest.fixture(scope="module")
def turning():
    return Turning()


@pytest.fixture(scope="module")
def static(turning):
    """As a temporal median leaves it: a little noise."""
    return Grain(1.7, seed=9).added(turning.picture(np.zeros(3)))


@pytest.fixture(scope="module")
def person():
    return wall(7, contrast=50.0)[:660, :200]  # a seventh of the picture


def turns():
    """Tremor of 2 px rms, slow and fast, and from KNOCK on a rotation by 0.45 degrees."""
    time_s = np.arange(N_FRAMES)[:, None] / 30
    waves = np.sin(2 * np.pi * np.array([1.3, 4.1, 2.0]) * time_s + [0, 1, 2])
    vectors = 2 * np.sqrt(2) / K[0, 0] * waves * [1, 1, 0.3]
    vectors[KNOCK:] += np.radians(0.45) * np.array([0.6, -0.7, 0.39])
    return vectors


def with_person(picture, person, at):
    left = 60 + 40 * at
    picture[40 : 40 + len(person), left : left + person.shape[1]] = person
    return picture


def values(table):
    return table[["shift_x_px", "shift_y_px"]].to_numpy()


def test_a_trembling_and_knocked_camera_is_followed(tmp_path, turning, static, person):
    grain, vectors = Grain(5.0, seed=1), turns()
    frames = (
        grain.added(with_person(turning.picture(vector), person, at))
        for at, vector in enumerate(vectors)
    )
    writer.write_video(tmp_path / "take.mp4", frames, 30, crf=26)
    table = shake_tracking.measure_take(static, reader.frames(tmp_path / "take.mp4"), first=5)
    true = [true_movement(vector) for vector in vectors]
    off = values(table) - [shift for shift, _ in true]
    assert np.sqrt(np.mean(off**2)) < 0.1
    assert np.sqrt(np.mean((off / table.sigma_px.to_numpy()[:, None]) ** 2)) < 2
    off_deg = table.rotation_deg.to_numpy() - [turn for _, turn in true]
    assert np.sqrt(np.mean(off_deg**2)) < 0.01  # a tenth of a pixel at the sides
    np.testing.assert_allclose(table.zoom_percent, 0, atol=0.03)
    np.testing.assert_allclose(table.time_s, np.arange(N_FRAMES) / 30, atol=1e-4)
    assert table.frame_idx.tolist() == list(range(5, 5 + N_FRAMES))


def test_a_camera_that_stands_still_is_said_to(turning, static, person):
    grain, picture = Grain(5.0, seed=2), turning.picture(np.zeros(3))
    frames = [
        (at / 30, grain.added(with_person(picture.copy(), person, 2 * at))) for at in range(8)
    ]
    found = shake_tracking.measure_take(static, frames)
    assert np.abs(values(found)).max() < 0.05
    assert found.sigma_px.max() < 0.1


def test_another_exposure_and_a_shadow_move_nothing(turning, static):
    other = turning.picture(np.array([0.002, 0.001, 0])).astype(float)
    other[200:530, 330:800] *= 0.7
    other = Grain(3.0).added(np.clip(0.8 * other + 6, 0, 255).astype(np.uint8))
    found = shake_tracking.Tracker(static).measure(other)
    np.testing.assert_allclose(
        found.shift_px, true_movement(np.array([0.002, 0.001, 0]))[0], atol=0.1
    )


def test_a_lost_picture_is_unknown_and_found_again_elsewhere(turning, static):
    tracker = shake_tracking.Tracker(static)
    assert tracker.measure(static).known
    for _ in range(3):
        lost = tracker.measure(texture(4, SIZE))
        assert not lost.known and np.isnan(lost.shift_px).all() and np.isnan(lost.sigma_px)
    vector = np.array([-0.03, 0.035, 0.003])
    found = tracker.measure(turning.picture(vector))
    assert np.hypot(*found.shift_px) > 40
    np.testing.assert_allclose(found.shift_px, true_movement(vector)[0], atol=0.2)


@pytest.mark.parametrize(
    ("size", "zoom"), [((640, 360), 1.002), ((2200, 1240), 1.0), ((360, 640), 1.0)]
)
def test_pictures_of_any_size_are_measured_in_their_own_pixels(size, zoom):
    before = texture(0, (size[0] // 2, size[1] // 2))
    before = cv2.resize(before, size, interpolation=cv2.INTER_CUBIC)
    found = shake_tracking.Tracker(before).measure(moved(before, (4.0, -2.5), zoom, 0.1))
    np.testing.assert_allclose(found.shift_px, (4.0, -2.5), atol=0.1)
    assert found.rotation_deg == pytest.approx(0.1, abs=0.01)
    assert found.zoom == pytest.approx(zoom, abs=2e-4)


def test_nothing_to_see_tells_nothing():
    flat = np.full((360, 640, 3), 90, np.uint8)
    for static, frame in [(flat, texture(0)), (texture(0), flat), (flat, flat)]:
        assert not shake_tracking.Tracker(static).measure(frame).known


def test_pictures_of_two_sizes_are_a_fault():
    with pytest.raises(ValueError, match="two sizes"):
        shake_tracking.Tracker(texture(0)).measure(texture(0, (320, 180)))


@needs_real
def test_a_real_tripod_stands_still_while_a_person_walks_by():
    path = REAL / "walk-4cams" / "videos" / "cam03.mp4"
    frames = [found for at, found in enumerate(reader.frames(path)) if at % 16 == 0]
    static = np.median([image for _, image in frames], axis=0).astype(np.uint8)
    table = shake_tracking.measure_take(static, frames)
    assert np.abs(values(table)).max() < 0.05 and np.abs(table.rotation_deg).max() < 0.003
