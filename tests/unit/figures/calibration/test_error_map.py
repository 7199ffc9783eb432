"""Expected errors match those of moved cameras, triangulated with OpenCV and SciPy."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from scipy.optimize import least_squares

from courtside.calibration.court import court
from courtside.calibration.records.covariance import PARAMETERS, CameraCovariance
from courtside.figures.calibration import error_map
from courtside.geometry.camera import Camera
from fixtures.cameras import scene

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
K = np.array([[1100.0, 0, 640], [0, 1000, 360], [0, 0, 1]])
DIST = np.array([-0.05, 0.01, 1e-3, -1e-3, 0.0])
SHIFT_M, FOCAL_PX = 0.03, 4.0


def cameras():
    places = {"side": (-18, 6.7, 1.9), "back": (3, -14, 2.1)}
    return [
        Camera(name, (1280, 720), K, DIST, scene.look_at(place, (3.05, 6.7, 1.3)))
        for name, place in places.items()
    ]


def covariance():
    """Two numbers are uncertain: the first camera's shift along x, the second's focal length."""
    names = list(PARAMETERS)
    variance = np.zeros(2 * len(names))
    variance[names.index("tx_m")] = SHIFT_M**2
    variance[len(names) + names.index("f_px")] = FOCAL_PX**2
    return CameraCovariance(["side", "back"], np.diag(variance))


def triangulate(found, seen, near):
    def residuals(xyz):
        made = [scene.opencv_projection(camera, xyz[None])[0] for camera in found]
        return np.ravel(np.array(made) - seen)

    return least_squares(residuals, near, xtol=1e-14, ftol=1e-14, gtol=1e-14).x


def test_the_error_is_that_of_moved_cameras():
    side, back = cameras()
    shifted = side.cam_from_world.copy()
    shifted[0, 3] += SHIFT_M / 100
    longer = K.copy()
    longer[0, 0] += 1.1 * FOCAL_PX / 100  # f is along y; x keeps its ratio to it
    longer[1, 1] += FOCAL_PX / 100
    trials = [(replace(side, cam_from_world=shifted), back), (side, replace(back, K=longer))]
    rows = error_map.table([side, back], covariance(), COURT, [0.0, 2.0])
    for at in (0, 700, 1400, 2600):
        xyz = rows.loc[at, ["x_m", "y_m", "z_m"]].to_numpy(float)
        seen = np.array([scene.opencv_projection(camera, xyz[None])[0] for camera in (side, back)])
        moved = [100 * (triangulate(pair, seen, xyz) - xyz) for pair in trials]
        expected_cm = 100 * np.sqrt(np.sum(np.square(moved)))
        assert rows.loc[at, "sigma_cm"] == pytest.approx(expected_cm, rel=0.01)


def test_points_outside_a_picture_are_blank():
    side, back = cameras()
    narrow = replace(
        side, K=np.diag([4.0, 4.0, 1.0]) @ K - np.array([[0, 0, 1920], [0, 0, 1080], [0, 0, 0]])
    )
    rows = error_map.table([narrow, back], covariance(), COURT, [1.0])
    rotation, _ = cv2.Rodrigues(narrow.cam_from_world[:, :3])
    xyz = rows[["x_m", "y_m", "z_m"]].to_numpy()
    xy, _ = cv2.projectPoints(xyz, rotation, narrow.cam_from_world[:, 3], narrow.K, narrow.dist)
    inside = ((xy[:, 0] > -0.5) & (xy[:, 0] < (1279.5, 719.5))).all(axis=1)
    assert 0.1 < inside.mean() < 0.9
    np.testing.assert_array_equal(rows["sigma_cm"].notna(), inside)


def test_a_place_has_the_error_of_the_cameras_that_show_it():
    side, back = cameras()
    away = replace(side, name="away", cam_from_world=scene.look_at((40, 40, 2), (80, 80, 1)))
    names, variance = ["side", "back", "away"], np.diag(covariance().covariance)
    wide = np.concatenate([variance, np.ones(len(PARAMETERS))])
    both = error_map.table([side, back], covariance(), COURT, [1.0])["sigma_cm"]
    assert both.notna().all()
    known = CameraCovariance(names, np.diag(wide))
    of_three = error_map.table([side, back, away], known, COURT, [1.0])["sigma_cm"]
    np.testing.assert_allclose(of_three, both, rtol=1e-6)


def test_the_covariance_must_contain_these_cameras():
    orders = cameras(), cameras()[::-1]
    one, other = (error_map.table(order, covariance(), COURT, [0.0]) for order in orders)
    np.testing.assert_allclose(one["sigma_cm"], other["sigma_cm"], rtol=1e-9)
    with pytest.raises(ValueError, match="back"):
        error_map.table(cameras(), covariance().of(["side"]), COURT, [0.0])


def test_heights_share_one_scale():
    rows = error_map.table(cameras(), covariance(), COURT, [0.0, 1.0, 2.0])
    drawing = error_map.draw(rows, cameras(), COURT, "made up")
    panels = [axis for axis in drawing.axes if axis.get_title().startswith("z = ")]
    assert len(panels) == 3
    levels = {tuple(axis.collections[0].levels) for axis in panels}
    assert len(levels) == 1
    (scale,) = levels
    assert scale[0] <= rows["sigma_cm"].min() <= rows["sigma_cm"].max() <= scale[-1]
    assert all(
        {"side\n21 m", "back\n21 m"} <= {t.get_text() for t in axis.texts} for axis in panels
    )


def test_an_unknown_covariance_is_drawn_blank():
    unknown = CameraCovariance(["side", "back"], np.full((28, 28), np.nan))
    rows = error_map.table(cameras(), unknown, COURT, [0.0])
    assert rows["sigma_cm"].isna().all()
    error_map.draw(rows, cameras(), COURT, "made up").draw_without_rendering()


def test_refined_cameras_are_drawn_below_those_before_on_one_scale():
    half = CameraCovariance(["side", "back"], covariance().covariance / 4)
    tables = [error_map.table(cameras(), one, COURT, [0.0, 1.0]) for one in (half, covariance())]
    rows = error_map.compared(*tables)
    np.testing.assert_allclose(rows["before_cm"], 2 * rows["sigma_cm"])
    drawing = error_map.draw(rows, cameras(), COURT, "made up")
    panels = [axis for axis in drawing.axes if "z = " in axis.get_title()]
    words = [axis.get_title().split(":")[0] for axis in panels]
    assert words == ["before", "before", "after", "after"]
    assert panels[0].get_position().y0 > panels[2].get_position().y1
    (scale,) = {tuple(axis.collections[0].levels) for axis in panels}
    assert scale[0] <= rows["sigma_cm"].min() < rows["before_cm"].max() <= scale[-1]


def test_a_camera_above_the_courts_centre_is_named_there():
    side, back = cameras()
    above = scene.look_at((3.05, 6.7, 9.0), (3.05, 7.0, 0.0))
    made = [side, replace(back, cam_from_world=above)]
    rows = error_map.table(made, covariance(), COURT, [0.0])
    drawing = error_map.draw(rows, made, COURT, "made up")
    drawing.draw_without_rendering()
    (place,) = (t.get_position() for t in drawing.axes[0].texts if t.get_text() == "back\n0 m")
    np.testing.assert_allclose(place, (3.05, 6.7), atol=1e-6)
