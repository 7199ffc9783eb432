"""Clicks that fit no camera: the change after which they fit is told; others stay as they are."""

import numpy as np
import pytest

from courtside.calibration.court import misfits, resection
from courtside.geometry.camera import Camera, project
from courtside.study.errors import InputError
from fixtures.cameras.scene import look_at

SIZE = (1920, 1080)
# Of a hall with two courts, and of its walls.
FLOOR = [[x, y, 0] for x in (-9, -3, 3, 9) for y in (-4.5, 4.5)]
FLOOR += [[x, y, 0] for x in (-14, -5, 0, 5, 14) for y in (-7.5, 7.5)]
WALLS = [[x, 9, z] for x in (-12, -6, 0, 6, 12) for z in (1, 2, 4)]
PLACES = np.array(FLOOR + WALLS, dtype=float)
ON_FLOOR = slice(len(FLOOR))


def clicks(noise_px=0.5):
    matrix = np.array([[900.0, 0, 959.5], [0, 900, 539.5], [0, 0, 1]])
    pose = look_at((0.5, -17.7, 6.4), (0, 0, 0))
    camera = Camera("a", SIZE, matrix, (-0.1, 0, 0, 0, 0), pose)
    rng = np.random.default_rng(1)
    return project(camera, PLACES) + rng.normal(0, noise_px, (len(PLACES), 2))


def refused(xyz, xy, placed=True):
    with pytest.raises(InputError) as caught:
        misfits.fitted(xyz, xy, SIZE, name="a", placed=placed)
    said = str(caught.value)
    assert "\n" not in said
    assert said.startswith("camera a: expected ") and ", found " in said
    return said.partition("; ")[2]


def test_clicks_that_fit_give_the_camera_of_a_resection():
    xy = clicks()
    found = misfits.fitted(PLACES, xy, SIZE, name="a", placed=True)
    np.testing.assert_array_equal(
        found.camera.cam_from_world,
        resection.nonlinear(PLACES, xy, SIZE, name="a").camera.cam_from_world,
    )


@pytest.mark.parametrize(
    ("placed", "advice"),
    [(True, "x_m, y_m and z_m must be right-handed with z up"), (False, "exchange the names of")],
)
def test_mirrored_places_are_told(placed, advice):
    said = refused(PLACES * [1, -1, 1], clicks(), placed)
    assert said.startswith("mirrored, they fit by 0.") and "the points are mirrored; " in said
    assert advice in said


@pytest.mark.parametrize("placed", [True, False])
def test_y_px_counted_from_the_bottom_is_told_by_the_camera_that_would_hang_upside_down(placed):
    said = refused(PLACES, clicks() * [1, -1] + [0, SIZE[1] - 1], placed)
    assert said.startswith("mirrored, they fit by 0.")
    assert (
        " px, but the camera hangs upside down: y_px must be counted from the top: subtract it "
        "from the picture's height minus 1"
    ) in said
    assert ("if z_m points down" in said) == placed


def test_exchanged_columns_are_told():
    said = refused(PLACES, clicks()[:, ::-1])
    assert said.startswith("with x_px and y_px exchanged, they fit by 0.")
    assert said.endswith(" px: exchange the names of these two columns")


@pytest.mark.parametrize("times", [1.5, 3.0])
def test_clicks_of_a_smaller_copy_are_told(times):
    said = refused(PLACES[ON_FLOOR], clicks()[ON_FLOOR] / times)
    assert said.startswith(f"times {times:g}, they fit by 0.")
    assert said.endswith(f"1920 x 1080 px; multiply x_px and y_px by {times:g}")


def test_clicks_that_nothing_mends_are_told_as_a_resection_does():
    mixed = np.random.default_rng(2).permutation(clicks())
    said = refused(PLACES, mixed)
    assert said == (
        "check the names of the points, their places (the court), and that clicks are px of the "
        "picture's own 1920 x 1080"
    )


def test_too_few_points_are_told():
    few = np.where(np.arange(len(PLACES))[:, None] < 5, clicks(), np.nan)
    with pytest.raises(InputError, match="camera a: expected 8 clicked points or more"):
        misfits.fitted(PLACES, few, SIZE, name="a")
