"""Pictures of a chessboard: OpenCV finds its corners and calibrates the lens with them."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from courtside.calibration.court import court
from virtualgym import presets
from virtualgym.cameras import layouts
from virtualgym.devices import chessboard

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
CRITERIA = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 50, 1e-4)


@pytest.fixture(scope="module")
def camera():
    rng = np.random.default_rng(5)
    return layouts.fixed_cameras("a", COURT, (1280, 720), presets.PRESETS["plain"], rng)[0]


@pytest.fixture(scope="module")
def simulated(camera, tmp_path_factory):
    folder = tmp_path_factory.mktemp("boards")
    rng = np.random.default_rng(0)
    background = np.full((720, 1280, 3), 120, np.uint8)
    held = chessboard.simulate(camera, folder, background, rng, n_boards=12, noise=1.0)
    paths = sorted(folder.iterdir())
    return held, [cv2.imread(str(path)) for path in paths], [path.name for path in paths]


def expected(camera, held):
    turn, _ = cv2.Rodrigues(held[:, :3])
    xy, _ = cv2.projectPoints(chessboard.corners_m(), turn, held[:, 3], camera.K, camera.dist)
    return xy[:, 0]


def corners(image):
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    found, xy = cv2.findChessboardCorners(grey, chessboard.INNER_CORNERS)
    assert found
    return cv2.cornerSubPix(grey, xy.astype(np.float32), (7, 7), (-1, -1), CRITERIA).reshape(-1, 2)


def test_the_corners_are_60_mm_apart():
    grid = chessboard.corners_m().reshape(4, 7, 3)
    np.testing.assert_allclose(np.diff(grid, axis=1), [[[0.06, 0, 0]] * 6] * 4, atol=1e-12)
    np.testing.assert_allclose(np.diff(grid, axis=0), [[[0, 0.06, 0]] * 7] * 3, atol=1e-12)


def test_opencv_finds_the_corners_where_they_are(camera, simulated):
    errors = []
    for held, image in zip(*simulated[:2], strict=True):
        found, true = corners(image), expected(camera, held)
        flipped = np.linalg.norm(found[0] - true[0]) > np.linalg.norm(found[-1] - true[0])
        errors.append((found[::-1] if flipped else found) - true)
    errors = np.array(errors)
    assert np.sqrt(np.mean(errors**2)) < 0.06
    assert np.linalg.norm(errors.mean((0, 1))) < 0.01, (
        "no common shift: first pixel centre at (0, 0)"
    )
    assert np.abs(errors).mean((1, 2)).max() < 0.1


def test_the_pictures_fill_the_field_of_view_and_calibrate_it(camera, simulated):
    _, images, names = simulated
    assert names[0] == "000000.png" and len(names) == 12
    found = [corners(image) for image in images]
    everything = np.concatenate(found) / [1280, 720]
    assert (everything.min(0) < 0.15).all() and (everything.max(0) > 0.85).all()
    board = chessboard.corners_m().astype(np.float32)
    # A board seen from its other end is the same board: the order of its corners does not matter.
    rms, matrix, dist, *_ = cv2.calibrateCamera(
        [board] * 12, [xy.astype(np.float32) for xy in found], (1280, 720), None, None,
        flags=cv2.CALIB_FIX_K3,
    )  # fmt: skip
    assert rms < 0.1
    assert matrix[0, 0] == pytest.approx(camera.K[0, 0], rel=0.002)
    np.testing.assert_allclose(matrix[:2, 2], camera.K[:2, 2], atol=4)
    assert dist.ravel()[0] == pytest.approx(camera.dist[0], abs=0.02)


def test_every_board_is_wholly_in_the_picture(camera):
    for held in chessboard.poses(camera, 15, np.random.default_rng(3)):
        xy = expected(camera, held)
        assert (xy > 20).all() and (xy < [1260, 700]).all()
        assert held[2, 3] > 0


def test_the_noise_is_as_asked_and_the_background_shows(camera):
    background = np.full((720, 1280, 3), 90, np.uint8)
    held = chessboard.poses(camera, 1, np.random.default_rng(3))[0]
    quiet, noisy = (
        chessboard.picture(camera, held, background, np.random.default_rng(1), noise=noise)
        for noise in (0.0, 4.0)
    )
    assert (noisy.astype(float) - quiet).std() == pytest.approx(4.0, rel=0.05)
    assert (quiet == 90).mean() > 0.3
