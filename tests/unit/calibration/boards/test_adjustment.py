"""Cameras from boards: against true cameras, their stated errors, and a real recording."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.boards import adjustment, start
from courtside.calibration.boards.board import Board
from courtside.calibration.bundle.problem import IMAGE
from courtside.study.errors import InputError
from fixtures.cameras import boards_made
from fixtures.recordings import charuco
from fixtures.recordings.real_data import needs_real

BOARD = Board.of(boards_made.CHARUCO)
RIG = boards_made.hall()
SIZES = {camera.name: camera.size for camera in RIG}


def in_world_of_first(places):
    """Return the true cameras in the frame of the first board."""
    rotation, shift = places[0, :, :3], places[0, :, 3]
    return [
        replace(c, cam_from_world=np.column_stack([
            c.cam_from_world[:, :3] @ rotation, c.cam_from_world @ [*shift, 1.0]
        ]))
        for c in RIG
    ]  # fmt: skip


def solved(places, sigma_px, seed, **more):
    seen = boards_made.seen(BOARD, RIG, places, sigma_px, seed)
    return seen, adjustment.calibrate(BOARD, seen, SIZES, floor="000", **more)


@pytest.mark.parametrize("known", [False, True])
def test_without_noise_the_true_cameras_are_found(known):
    places = boards_made.places(25, 3)
    lenses = {c.name: c for c in RIG} if known else None
    _, found = solved(places, 0.0, 0, lenses=lenses)
    for camera, true in zip(found.cameras, in_world_of_first(places), strict=True):
        np.testing.assert_allclose(camera.centre_in_world, true.centre_in_world, atol=2e-4)
        np.testing.assert_allclose(camera.K, true.K, atol=0.3)


def test_without_a_board_on_the_floor_z_is_up_as_in_the_pictures():
    """A board held upright defines no vertical: z would be horizontal."""
    seen = boards_made.seen(BOARD, RIG, boards_made.places(25, 3)[1:], 0.1, 0)
    lenses = {camera.name: camera for camera in RIG}
    found = adjustment.calibrate(BOARD, seen, SIZES, lenses=lenses)
    named = adjustment.calibrate(BOARD, seen, SIZES, lenses=lenses, floor=found.world)
    assert (found.stated, named.stated, named.covariance.frame.any()) == (False, True, False)
    ours, theirs = (np.array([c.centre_in_world for c in one.cameras]) for one in (found, named))
    true = np.array([camera.centre_in_world for camera in RIG])
    rotation, _ = rigid(true, ours)
    tilt = np.arccos(rotation[2, 2])
    assert tilt < 3 * np.sqrt(np.trace(found.covariance.frame)) < np.radians(15)
    rotation, _ = rigid(true, theirs)
    assert rotation[2, 2] < 0.7  # of the board
    np.testing.assert_allclose(np.linalg.norm(ours, axis=1), np.linalg.norm(theirs, axis=1))
    np.testing.assert_array_equal(found.covariance.covariance, named.covariance.covariance)


def squares_in_sigmas(found, places):
    """Return the squared errors of the cameras' positions in their stated errors: 3 on average."""
    off = []
    for k, true in enumerate(in_world_of_first(places)):
        camera = found.cameras[k]
        at = IMAGE * k + 3 + np.arange(3)
        by_shift = camera.cam_from_world[:, :3].T
        covariance = by_shift @ found.covariance.of_columns()[np.ix_(at, at)] @ by_shift.T
        error = camera.centre_in_world - true.centre_in_world
        off.append(error @ np.linalg.solve(covariance, error))
    return off


def test_errors_are_as_large_as_stated():
    places = boards_made.places(30, 5)
    off = []
    for seed in range(4):
        _, found = solved(places, 0.4, seed)
        assert found.sigma_px == pytest.approx(0.4, rel=0.15)
        assert found.factor < 1.2
        assert np.isnan(found.late).all()  # boards in no order
        off += squares_in_sigmas(found, places)
        for camera, true in zip(found.cameras, in_world_of_first(places), strict=True):
            assert np.linalg.norm(camera.centre_in_world - true.centre_in_world) < 0.05
    assert 1.0 < np.mean(off) < 4.5  # priors make the stated errors a little large


def test_errors_that_corners_of_a_picture_share_are_as_large_as_stated():
    places, off = boards_made.places(40, 5), []
    for seed in range(8):
        seen = boards_made.seen(BOARD, RIG, places, 0.4, seed)
        shift = np.random.default_rng(100 + seed).normal(0, 1.0, (4, 40, 2))
        seen = replace(seen, xy=seen.xy + shift[seen.camera, seen.picture])
        found = adjustment.calibrate(BOARD, seen, SIZES, floor="000")
        assert 2.0 < found.factor < 8.0
        off += squares_in_sigmas(found, places)
    assert 1.5 < np.mean(off) < 3.6


def test_the_error_of_the_boards_size_is_an_error_of_the_scale():
    places, lenses = boards_made.places(30, 5), {camera.name: camera for camera in RIG}
    unsure = Board.of(boards_made.CHARUCO | {"square_sigma_m": 0.001})
    _, exact = solved(places, 0.1, 1, lenses=lenses)
    seen = boards_made.seen(BOARD, RIG, places, 0.1, 1)
    found = adjustment.calibrate(unsure, seen, SIZES, floor="000", lenses=lenses)
    for k, camera in enumerate(found.cameras):
        at = IMAGE * k + 3 + np.arange(3)
        both = (one.covariance.of_columns()[np.ix_(at, at)] for one in (found, exact))
        more = np.subtract(*both)
        away_m = np.linalg.norm(camera.centre_in_world)
        assert np.sqrt(np.trace(more)) == pytest.approx(0.01 * away_m, rel=1e-6)


def filmed(seen, times):
    """Return what a video shows of boards that rest: the same errors, and noise of each frame."""
    parts = {key: np.repeat(getattr(seen, key), times, axis=0) for key in ("camera", "corner")}
    frame = times * np.repeat(seen.picture, times) + np.tile(np.arange(times), len(seen.xy))
    noise = np.random.default_rng(1).normal(0, 0.08, (len(frame), 2))
    count = times * len(seen.pictures)
    names, xy = tuple(f"{p:03d}" for p in range(count)), np.repeat(seen.xy, times, axis=0) + noise
    return replace(seen, **parts, picture=frame, xy=xy, pictures=names, step=np.arange(count))


@pytest.mark.parametrize("floor", ["7", None])
def test_a_board_that_rests_is_stated_as_one_picture(floor):
    """Most of a corner's error stays while nothing moves, however long it is filmed."""
    seen = boards_made.seen(BOARD, RIG, boards_made.places(20, 3), 0.2, 0)
    sigma_px = []
    for times in (1, 12):
        named = None if floor is None else str(int(floor) * times + times // 2)
        found = adjustment.calibrate(BOARD, filmed(seen, times), SIZES, floor=named)
        sigma_px.append([found.covariance.sigma(camera.name, "f_px") for camera in RIG])
    assert sigma_px[1] == pytest.approx(sigma_px[0], rel=0.2)


def test_a_camera_that_sees_a_rest_later_than_the_others_keeps_its_place():
    seen = filmed(boards_made.seen(BOARD, RIG, boards_made.places(20, 3), 0.2, 0), 3)
    hidden = (seen.camera == 3) & (seen.picture % 3 == 0)
    rows = {key: getattr(seen, key)[~hidden] for key in ("camera", "picture", "corner", "xy")}
    found = adjustment.calibrate(BOARD, replace(seen, **rows), SIZES)
    whole = adjustment.calibrate(BOARD, seen, SIZES)
    sigma_px = [one.covariance.sigma("c3", "f_px") for one in (found, whole)]
    assert sigma_px[0] == pytest.approx(sigma_px[1], rel=0.2)


def test_every_picture_of_a_board_that_moves_slowly_counts():
    """It moves by 5 mm from frame to frame, 1 to 2 px."""
    places = np.repeat(boards_made.places(5, 3), 8, axis=0)
    places[:, :, 3] += 0.005 * (np.arange(40) % 8)[:, None]
    seen = boards_made.seen(BOARD, RIG, places, 0.2, 0)
    lenses = {camera.name: camera for camera in RIG}
    covariance = [
        adjustment.calibrate(BOARD, one, SIZES, lenses=lenses).covariance.covariance
        for one in (seen, replace(seen, step=np.arange(40)))
    ]
    np.testing.assert_array_equal(*covariance)


def test_misread_corners_do_not_move_the_cameras():
    places = boards_made.places(30, 5)
    seen = boards_made.seen(BOARD, RIG, places, 0.2, 1)
    random = np.random.default_rng(2)
    wrong = random.random(len(seen.xy)) < 0.05
    xy = seen.xy + np.where(wrong[:, None], random.normal(0, 40, seen.xy.shape), 0.0)
    found = adjustment.calibrate(BOARD, replace(seen, xy=xy), SIZES, floor="0")
    for camera, true in zip(found.cameras, in_world_of_first(places), strict=True):
        assert np.linalg.norm(camera.centre_in_world - true.centre_in_world) < 0.02


def test_cameras_that_share_no_picture_are_named():
    places = boards_made.places(30, 5)
    seen = boards_made.seen(BOARD, RIG, places, 0.2, 1)
    alone = (seen.camera >= 2) == (seen.picture % 2 == 0)
    rows = {key: getattr(seen, key)[alone] for key in ("camera", "picture", "corner", "xy")}
    with pytest.raises(
        InputError, match=r"cameras c\d, c\d and c\d, c\d: expected pictures in"
    ) as e:
        adjustment.calibrate(
            BOARD, replace(seen, **rows), SIZES, lenses={camera.name: camera for camera in RIG}
        )
    assert "\n" not in str(e.value)


def test_other_faults_are_one_line():
    places = boards_made.places(12, 5)
    seen = boards_made.seen(BOARD, RIG, places, 0.2, 1)
    listed = r"board.floor: expected a picture .* found 'kitchen'; name one .*: {}$"
    seen = replace(seen, pictures=tuple(f"{at:06d}" for at in range(12)))
    names = ", ".join(map(str, range(12)))
    with pytest.raises(InputError, match=listed.format(names)):
        adjustment.calibrate(BOARD, seen, SIZES, floor="kitchen", lenses={c.name: c for c in RIG})
    many = boards_made.seen(BOARD, RIG, boards_made.places(26, 5), 0.2, 1)
    names = ", ".join(map(str, range(20)))
    with pytest.raises(InputError, match=listed.format(f"{names} and 6 more")):
        adjustment.calibrate(BOARD, many, SIZES, floor="kitchen", lenses={c.name: c for c in RIG})
    few = seen.picture < 3
    rows = {key: getattr(seen, key)[few] for key in ("camera", "picture", "corner", "xy")}
    with pytest.raises(InputError, match=r"camera c0: expected 4 pictures or more .*give `lenses`"):
        adjustment.calibrate(BOARD, replace(seen, **rows), SIZES)
    parts = seen.corner < 3
    rows = {key: getattr(seen, key)[parts] for key in ("camera", "picture", "corner", "xy")}
    with pytest.raises(InputError, match=r"camera c0: expected 4 pictures .* found 0; "):
        start.lens("c0", SIZES["c0"], BOARD, replace(seen, **rows), 0)
    mixed = np.random.default_rng(1).permutation(len(BOARD.corners))[seen.corner]
    with pytest.raises(
        InputError, match=r"board: .* on one plane, 6 or more .* found \d+ %.*check `squares`"
    ):
        adjustment.calibrate(
            BOARD, replace(seen, corner=mixed), SIZES, lenses={c.name: c for c in RIG}
        )


def test_cameras_that_do_not_film_at_one_time_are_refused():
    places = boards_made.places(30, 5)
    seen = boards_made.seen(BOARD, RIG, places, 0.2, 1)
    late = np.where(seen.camera % 2 == 0, seen.picture, (seen.picture + 1) % 30)
    with pytest.raises(InputError, match=r"within 5 px of one rigid board.*videos are synchronise"):
        adjustment.calibrate(
            BOARD, replace(seen, picture=late), SIZES, lenses={c.name: c for c in RIG}
        )


def late_by(steps, seed=0, sigma_px=0.2, **more):
    """Return what cameras find of a waved board, of which the second one films late."""
    seen = boards_made.waved(BOARD, RIG, 40, {"c1": steps}, sigma_px, seed)
    return seen, adjustment.calibrate(BOARD, seen, SIZES, floor="000", **more)


@pytest.mark.parametrize("steps", [0.0, 0.3, -0.15])
@pytest.mark.parametrize("known", [True, False])
def test_a_camera_that_films_late_is_found(steps, known):
    lenses = {camera.name: camera for camera in RIG} if known else None
    _, found = late_by(steps, lenses=lenses)
    assert found.late[1] == pytest.approx(steps, abs=0.05 + 0.3 * abs(steps))
    assert (found.late_sigma < 0.1).all()


def test_the_error_of_a_delay_is_as_large_as_stated():
    lenses = {camera.name: camera for camera in RIG}
    off = []
    for seed in range(6):
        _, found = late_by(0.0, seed, 0.5, lenses=lenses)
        off += list(found.late / found.late_sigma)
    assert 0.5 < np.std(off) < 2.0


@needs_real
def test_a_real_recording_against_caliscope():
    """Webcams that film at 6 fps without a common clock, a board in a man's hands."""
    _, _, theirs, found = charuco.calibrated()
    ours, others = (np.array([c.centre_in_world for c in one]) for one in (found.cameras, theirs))
    rotation, shift = rigid(ours, others)
    assert np.linalg.norm(ours @ rotation.T + shift - others, axis=1).max() < 0.008


def rigid(start, end):
    """Return rotation and shift of the rigid motion between points by least squares."""
    left, _, right = np.linalg.svd((end - end.mean(axis=0)).T @ (start - start.mean(axis=0)))
    rotation = left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
    return rotation, end.mean(axis=0) - rotation @ start.mean(axis=0)
