"""What is told of cameras from boards: the fit, and what is wrong with clocks and lenses."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.boards import adjustment, quality
from courtside.calibration.boards.board import Board
from fixtures.cameras import boards_made
from fixtures.recordings import charuco
from fixtures.recordings.real_data import needs_real

BOARD = Board.of(boards_made.CHARUCO)
RIG = boards_made.hall()
SIZES = {camera.name: camera.size for camera in RIG}
LENSES = {camera.name: camera for camera in RIG}


def at_rest(sigma_px=0.2, known=False):
    """Return what cameras see of boards at rest, and the calibration."""
    seen = boards_made.seen(BOARD, RIG, boards_made.places(30, 5), sigma_px, 1)
    return seen, solved(seen, known)


def solved(seen, known, **lenses):
    given = {**LENSES, **lenses} if known else None
    return adjustment.calibrate(BOARD, seen, SIZES, floor="000", lenses=given)


def told(found, seen, known):
    return quality.summary(found, seen, BOARD, known=known)["warnings"]


def test_of_good_corners_nothing_is_told_but_numbers():
    seen, found = at_rest()
    report = quality.summary(found, seen, BOARD, known=False)
    assert report["warnings"] == []
    assert "late_pictures" not in report
    assert report["rms_px"] == pytest.approx(dict.fromkeys(SIZES, 0.2), rel=0.2)
    assert report["remarks"] == []
    found = adjustment.calibrate(BOARD, seen, SIZES, lenses=LENSES)
    report = quality.summary(found, seen, BOARD, known=True)
    (floor,) = report["remarks"]
    assert f"z is up as in the pictures, within {report['vertical_sigma_deg']:.0f} deg" in floor
    assert f"at the board of picture {found.world}, not at the floor" in floor
    same = found.cameras[0].cam_from_world[:, :3]  # in parallel, whatever their corners say
    alike = [
        replace(one, cam_from_world=np.column_stack([same, one.cam_from_world[:, 3]]))
        for one in found.cameras
    ]
    report = quality.summary(replace(found, cameras=alike), seen, BOARD, known=True)
    assert report["remarks"] == []
    assert any("the pictures do not tell what is up" in line for line in report["warnings"])
    mean, spread, count = quality.neighbours_mm(found, seen, BOARD)
    assert abs(mean) < 0.2
    assert (spread < 2, count > 100) == (True, True)


@pytest.mark.parametrize("known", [False, True])
def test_a_camera_whose_corners_fit_much_worse_is_named(known):
    seen, _ = at_rest()
    noise = np.random.default_rng(1).normal(0, 2.5, seen.xy.shape)
    seen = replace(seen, xy=seen.xy + np.where(seen.camera[:, None] == 1, noise, 0.0))
    (line,) = (one for one in told(solved(seen, known), seen, known) if one.startswith("camera "))
    assert line.startswith(f"camera {RIG[1].name}: its corners fit by 2.")
    assert ("give `lenses`" in line, "check `lenses`" in line) == (not known, known)


@pytest.mark.parametrize(("steps", "words"), [(0.4, "late"), (-0.4, "early")])
@pytest.mark.parametrize("known", [False, True])
def test_of_a_camera_that_films_late_the_clock_is_told_and_not_its_lens(steps, words, known):
    seen = boards_made.waved(BOARD, RIG, 40, {"c1": steps}, 0.2)
    lines = told(solved(seen, known), seen, known)
    (line,) = (one for one in lines if one.startswith("camera "))
    assert line.startswith("camera c1: films probably 0.")
    assert f"pictures {words} by the movement of the board" in line
    (scatter,) = (one for one in lines if "scatter" in one)
    assert ("give `lenses`" in scatter) == (not known)
    in_s = told(solved(seen, known), replace(seen, every_s=0.5), known)
    assert any(f"s) {words} by" in one for one in in_s)


def test_of_a_waved_board_whose_lens_is_wrong_no_clock_is_told():
    seen = boards_made.waved(BOARD, RIG, 40, {}, 0.2)
    wrong = replace(RIG[1], K=RIG[1].K * [[1.2], [1.2], [1]])
    lines = told(solved(seen, True, c1=wrong), seen, True)
    assert any("check `lenses`" in line for line in lines)
    assert any("or a given lens is wrong" in line for line in lines if "scatter" in line)
    assert not any("films" in line for line in lines)


def test_of_a_lens_that_bends_more_than_the_model_the_lens_is_told():
    """Boards at rest, sharp and exact, before lenses with k3: the movement is not to blame."""
    dist, wide = [-0.3, 0.15, 0, 0, -0.06], [[0.6, 1, 1], [1, 0.6, 1], [1, 1, 1]]
    bent = [replace(one, dist=dist, K=one.K * wide) for one in RIG]
    places = boards_made.places(60, 5)
    places[1:, :2, 3] *= 3  # out to the edges of the pictures
    seen = boards_made.seen(BOARD, bent, places, 0.03, 1)
    lines = told(solved(seen, False), seen, False)
    (line,) = (one for one in lines if "scatter" in one)
    assert "or a wide lens bends more than k1 k2 follow" in line
    assert "give `lenses` (those from `chessboard` have k3)" in line


@needs_real
def test_of_a_real_recording_the_clock_is_told():
    """Webcams without a common clock: one camera dropped a picture, its lens is Caliscope's own."""
    board, seen, _, found = charuco.calibrated()
    mean, spread, count = quality.neighbours_mm(found, seen, board)
    assert -0.3 < mean < 0.3
    assert spread < 0.9
    assert count > 900
    report = quality.summary(found, seen, board, known=True)
    assert report["late_pictures"]["cam_1"] == pytest.approx(-0.5, abs=0.2)
    (floor,), (scatter, clock) = report["remarks"], report["warnings"]
    assert "z is up as in the pictures, within 2 degrees" in floor
    assert "the cameras did not film at one time" in scatter
    assert "camera cam_1: films probably 0.5 pictures early" in clock
    assert not any("give `lenses`" in line for line in report["warnings"])
