"""Movement of a fixed camera: known transforms of real pictures, and undetermined ones."""

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.video import camera_movement, reader
from fixtures.recordings.real_data import REAL, needs_real
from fixtures.recordings.still_pictures import moved, texture
from fixtures.recordings.turned_pictures import CENTRE, DIST, SIZE, K, true_movement, undistorted

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


HALF = SIZE[0] / 2
VECTORS = np.array([[0.001, -0.0012, 0.0005], [0.006, 0.007, -0.004], [0, 0, 0.02]])


def tracked(vector, sigma_px, n_wrong=0, seed=0, n=220):
    """Return places and noisy movements in px by OpenCV; the first `n_wrong` are on a walker."""
    rng = np.random.default_rng(seed)
    xy = rng.uniform([20, 20], np.array(SIZE) - 20, (n, 2))
    seen = undistorted(xy)
    rotated = np.column_stack([seen, np.ones(n)]) @ Rotation.from_rotvec(vector).as_matrix().T
    after = cv2.projectPoints(rotated[:, None], np.zeros(3), np.zeros(3), K, DIST)[0][:, 0]
    by = after - xy + rng.normal(0, sigma_px, (n, 2))
    by[:n_wrong] = rng.normal([-3.0, 1.0], 1, (n_wrong, 2))
    return (xy - CENTRE) / HALF, by


@pytest.mark.parametrize("vector", VECTORS)
def test_a_turn_is_found_among_wrong_points(vector):
    places, by = tracked(vector, sigma_px=0.2, n_wrong=60)
    found = camera_movement.fit_turn(places, by, SIZE[::-1], len(places))
    shift, turn = true_movement(vector)
    assert found.known and 120 < found.n_matches <= 170
    np.testing.assert_allclose(found.model[:2] * HALF, shift, atol=0.08)
    linear = complex(1 + found.model[2], found.model[3])
    assert np.degrees(np.angle(linear)) == pytest.approx(turn, abs=0.01)


def test_the_stated_sigma_is_the_scatter():
    off = []
    for seed in range(60):
        places, by = tracked(VECTORS[0], sigma_px=0.2, n_wrong=30, seed=seed)
        found = camera_movement.fit_turn(places, by, SIZE[::-1], len(places))
        off.append((found.model[:2] * HALF - true_movement(VECTORS[0])[0]) / (found.sigma * HALF))
    assert 0.75 < np.sqrt(np.mean(np.square(off))) < 1.3


def test_the_derivative_is_that_of_the_field():
    places, model = tracked(VECTORS[0], 0)[0], np.array([0.01, -0.02, 0.003, 0.004, -0.05, 0.4])
    step = 1e-6
    numeric = [
        (camera_movement.moved(places, model + row) - camera_movement.moved(places, model - row))
        / (2 * step)
        for row in step * np.eye(6)
    ]
    np.testing.assert_allclose(
        camera_movement._jacobian(places, model), np.moveaxis(numeric, 0, -1), atol=1e-8
    )


def test_too_few_or_bunched_points_tell_nothing():
    places, by = tracked(VECTORS[0], 0.1)
    bunched = 0.05 * places + [0.5, 0.2]
    assert not camera_movement.fit_turn(bunched, by, SIZE[::-1], len(places)).known
    assert not camera_movement.fit_turn(places[:15], by[:15], SIZE[::-1], 15).known
    assert not camera_movement.fit_turn(places[:40], by[:40], SIZE[::-1], 300).known
    scattered = np.random.default_rng(5).uniform(-40, 40, by.shape)
    assert not camera_movement.fit_turn(places, scattered, SIZE[::-1], len(places)).known
