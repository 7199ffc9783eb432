"""Movement of a fixed camera: known transforms of real pictures are measured, the unknowable is said."""

import numpy as np
import pytest

from courtside.video import camera_movement, reader
from fixtures.recordings.real_data import REAL, needs_real
from fixtures.recordings.still_pictures import moved, texture

LATER = 60  # frames: a second, in which the person moves
CASES = [
    ((0.3, -0.4), 1.0, 0.0),
    ((3.0, -2.0), 1.001, 0.05),
    ((-15.0, 8.0), 0.995, -0.3),
    ((40.0, -60.0), 1.02, 1.0),
]


def another_exposure(image, seed):
    noise = np.random.default_rng(seed).normal(0, 3, image.shape)
    return np.clip(0.85 * image + 4 + noise, 0, 255).round().astype(np.uint8)


@pytest.fixture(scope="module", params=[2, 3])
def real_pair(request):
    """Two frames of one fixed camera, a second apart."""
    path = REAL / "walk-4cams" / "videos" / f"cam0{request.param}.mp4"
    return [image for k, (_, image) in enumerate(reader.frames(path)) if k in (0, LATER)]


@needs_real
@pytest.mark.parametrize(("shift_px", "zoom", "rotation_deg"), CASES)
def test_known_movements_of_real_pictures_are_measured(real_pair, shift_px, zoom, rotation_deg):
    other = another_exposure(moved(real_pair[1], shift_px, zoom, rotation_deg), seed=1)
    found = camera_movement.movement(real_pair[0], other)
    assert found.known and found.n_matches > 200
    assert np.hypot(*(found.shift_px - shift_px)) < 0.3
    assert abs(found.zoom - zoom) < 5e-4
    assert abs(found.rotation_deg - rotation_deg) < 0.02


def test_people_are_outliers():
    before = texture(0)
    after = moved(before, (2.0, -1.0))
    for image, x, seed in [(before, 60, 5), (before, 400, 6), (after, 120, 5), (after, 330, 6)]:
        image[60:360, x : x + 90] = texture(seed, (90, 300))
    found = camera_movement.movement(before, after)
    np.testing.assert_allclose(found.shift_px, (2, -1), atol=0.1)
    assert abs(found.zoom - 1) < 5e-4


def test_an_unmoved_picture_has_not_moved():
    found = camera_movement.movement(texture(3), texture(3))
    np.testing.assert_allclose(
        [*found.shift_px, found.zoom, found.rotation_deg], [0, 0, 1, 0], atol=1e-4
    )
    assert found.row()["zoom_percent"] == pytest.approx(0, abs=0.01)


@pytest.mark.parametrize(
    "other",
    [texture(1), np.full((360, 640, 3), 90, np.uint8)],
    ids=["another view", "nothing to see"],
)
def test_what_cannot_be_told_is_unknown(other):
    for pair in [(texture(0), other), (other, texture(0))]:
        found = camera_movement.movement(*pair)
        assert not found.known and np.isnan(found.shift_px).all() and np.isnan(found.rotation_deg)


def test_points_in_one_corner_tell_nothing():
    picture = np.full((360, 640, 3), 90, np.uint8)
    picture[:60, :80] = texture(0, (80, 60))
    assert not camera_movement.movement(picture, picture).known


def test_pictures_of_two_sizes_are_a_fault():
    with pytest.raises(ValueError, match="two sizes"):
        camera_movement.movement(texture(0), texture(0, (320, 180)))
