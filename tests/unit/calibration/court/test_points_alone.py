"""Cameras from points alone, together: the true ones within what the covariance states."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.bundle.problem import IMAGE, LENS
from courtside.calibration.court import court, points_alone, quality
from courtside.calibration.records import covariance as camera_covariance
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera, in_picture
from courtside.study.errors import InputError
from fixtures.cameras.scene import look_at, opencv_projection

COURTS = Path(__file__).parents[4] / "config" / "courts"
HALL = court.read(COURTS / "sports-hall.yaml")
SIZE = (1920, 1080)
WEIGHTS = {"click_sigma_px": 2.5, "click_bias_px": 1.25, "click_loss": 4.0}


def true_cameras(k1=-0.29, k2=0.06):
    """Return four cameras on the stands, wide lenses with the principal point off the centre."""
    places = {"east": (27, 18, 7), "west": (-7, 22, 6.5), "south": (9, -6, 7), "north": (12, 46, 6)}
    matrix = np.array([[1010.0, 0, 966.5], [0, 1010, 551.5], [0, 0, 1]])
    return [
        Camera(name, SIZE, matrix, (k1, k2, 0, 0, 0), look_at(at, (10, 20, 0)))
        for name, at in places.items()
    ]


def clicked(cameras, noise_px=1.0, seed=0):
    rng = np.random.default_rng(seed)
    found = {}
    for camera in cameras:
        xy = opencv_projection(camera, HALL.xyz)
        in_cam = HALL.xyz @ camera.cam_from_world[:, :3].T + camera.cam_from_world[:, 3]
        shown = in_picture(camera, xy) & (in_cam[:, 2] > 1)
        radius = np.hypot(*(in_cam[:, :2] / in_cam[:, 2:]).T)
        shown &= radius < camera.fold_radius
        noisy = xy + rng.normal(0, noise_px, xy.shape)
        found[camera.name] = np.where(shown[:, None], noisy, np.nan)
    return found


def calibrate(clicks, cameras=None):
    return points_alone.calibrate(HALL, clicks, dict.fromkeys(cameras or clicks, SIZE), **WEIGHTS)


@cache
def solved(seed):
    """Return the cameras that points with errors give; nobody changes them."""
    return calibrate(clicked(true_cameras(), seed=seed)).solution


def apart_px(found, true):
    grid = np.stack(np.meshgrid([3.0, 10, 17], [8, 20, 32], [0, 1, 2]), axis=-1).reshape(-1, 3)
    xy = opencv_projection(true, grid)
    seen = in_picture(true, xy)
    return np.linalg.norm(opencv_projection(found, grid) - xy, axis=1)[seen]


def test_exact_clicks_give_the_true_pictures():
    made = true_cameras()
    found = calibrate(clicked(made, noise_px=0)).solution.cameras
    for camera, true in zip(found, made, strict=True):
        assert apart_px(camera, true).max() < 1.0
        assert camera.K[1, 1] == pytest.approx(true.K[1, 1], rel=0.01)


def test_errors_are_about_as_large_as_stated():
    made, square = true_cameras(), []
    for seed in range(12):
        found = solved(seed)
        spread = np.sqrt(np.diag(found.covariance))
        first = IMAGE * len(made) + LENS.index("f_px")
        for at, (camera, true) in enumerate(zip(found.cameras, made, strict=True)):
            sigma = spread[first + len(LENS) * at]
            square.append(((camera.K[1, 1] - true.K[1, 1]) / sigma) ** 2)
    assert 0.5 < np.mean(square) < 1.7


def test_the_expected_error_is_of_places_that_two_cameras_see():
    found = solved(0)
    spread = camera_covariance.of_network([c.name for c in found.cameras], found.covariance)
    here, nowhere = np.array([[10.0, 20, 1]]), np.array([[10.0, 20, 1000]])
    error_cm, share = quality.expected_cm(found.cameras, spread, here)
    assert 0.1 < error_cm < 5 and share == 1
    assert np.isnan(quality.expected_cm(found.cameras, spread, nowhere)[0])
    both = np.concatenate([here, nowhere])
    assert quality.expected_cm(found.cameras, spread, both) == (error_cm, 0.5)


def test_a_wrong_click_is_named_and_moves_nothing():
    made = true_cameras()
    clicks = clicked(made)
    at = int(np.flatnonzero(np.isfinite(clicks["north"][:, 0]))[5])
    clicks["north"][at] += [40, -25]
    found = calibrate(clicks)
    (wrong,) = found.wrong
    assert (wrong.camera, wrong.point) == ("north", HALL.points[at])
    assert wrong.error_px == pytest.approx(np.hypot(40, 25), abs=8)
    assert apart_px(found.solution.cameras[3], made[3]).max() < 6
    assert str(wrong) in found.warnings


def test_a_wrong_click_is_named_also_beside_a_camera_of_larger_pictures():
    """17 sigmas in its own picture, 9 of clicks in the larger one; less across its edges."""
    made = true_cameras()
    made[0] = camera_models.scaled(made[0], 2)
    clicks = clicked(made)
    at = int(np.flatnonzero(np.isfinite(clicks["north"][:, 0]))[5])
    clicks["north"][at] += [18, -12]
    sizes = {camera.name: camera.size for camera in made}
    found = points_alone.calibrate(HALL, clicks, sizes, **WEIGHTS)
    (wrong,) = found.wrong
    assert (wrong.camera, wrong.point) == ("north", HALL.points[at])


@pytest.mark.parametrize("with_lines", [False, True])
def test_a_click_beside_a_point_is_wrong_unless_flat_lines_make_it_uncertain(with_lines):
    """Seen from 1.6 m above the floor, lines cross flat; points of one's own have none."""
    of_lines = court.read(COURTS / "badminton.yaml")
    places = court.of_places("points", of_lines.points, of_lines.xyz)
    where = of_lines if with_lines else places
    matrix = np.array([[1152.0, 0, 959.5], [0, 1152, 539.5], [0, 0, 1]])
    made = [
        Camera(name, SIZE, matrix, (-0.05, 0.01, 0, 0, 0), look_at(at, (3, 6.7, 0.8)))
        for name, at in {"a": (3, -6, 1.6), "b": (12, 2, 1.6), "c": (-4, 15, 1.6)}.items()
    ]
    rng = np.random.default_rng(0)
    clicks = {c.name: opencv_projection(c, where.xyz) + rng.normal(0, 0.9, (18, 2)) for c in made}
    clicks["a"][4, 0] += 10  # 11 sigmas to the right
    found = points_alone.calibrate(
        where, clicks, dict.fromkeys(clicks, SIZE), **WEIGHTS | {"click_sigma_px": 1.75}
    )
    named = [(one.camera, one.point) for one in found.wrong]
    assert named == ([] if with_lines else [("a", where.points[4])])


def test_a_camera_whose_points_fit_badly_is_named():
    made = true_cameras()
    clicks = clicked(made)
    rng = np.random.default_rng(1)
    clicks["west"] += rng.normal(0, 12, clicks["west"].shape)
    assert any(line.startswith("camera west: expected its points to fit") for line in
               calibrate(clicks).warnings)  # fmt: skip


def test_cameras_whose_points_all_fit_badly_are_named():
    """As those of a copy of the picture: no camera is better than another."""
    clicks = clicked(true_cameras(), noise_px=9)
    found = [line for line in calibrate(clicks).warnings if "expected its points to fit" in line]
    assert len(found) >= 3
    assert all("as clicks do, to 1.2 px" in line and "own 1920 x 1080" in line for line in found)


def test_cameras_that_share_points_with_exchanged_clicks_are_not_accused():
    clicks = clicked(true_cameras())
    by_all = np.flatnonzero(np.all([np.isfinite(xy[:, 0]) for xy in clicks.values()], axis=0))
    chosen = np.sort(np.random.default_rng(0).permutation(by_all)[:16])
    for xy in clicks.values():
        xy[np.setdiff1d(np.arange(len(xy)), chosen)] = np.nan
    clicks["west"][chosen[[1, 6]]] = clicks["west"][chosen[[6, 1]]]
    found = calibrate(clicks)
    assert {one.point for one in found.wrong} == {HALL.points[at] for at in chosen[[1, 6]]}
    assert found.warnings == [str(one) for one in found.wrong]


def on_floor(places, clicks):
    """Return places of a floor without names, and the clicks on it."""
    low = HALL.xyz[:, 2] == 0
    court_there = court.of_places("points", np.array(HALL.points)[low], places[low])
    return court_there, {name: xy[low] for name, xy in clicks.items()}


def of_floor(times, change=lambda xy: xy):
    cameras = [camera for camera in true_cameras() if camera.name in ("east", "south")]
    changed = {name: change(xy) for name, xy in clicked(cameras).items()}
    where, clicks = on_floor(HALL.xyz * times, changed)
    return points_alone.calibrate(where, clicks, dict.fromkeys(clicks, SIZE), **WEIGHTS)


@pytest.mark.parametrize(
    ("times", "change", "advice"),
    [
        ([1, -1, 1], lambda xy: xy, "right-handed with z up: change the sign of y_m in all rows"),
        ([-1, 1, 1], lambda xy: xy, "right-handed with z up: change the sign of y_m in all rows"),
        ([1, 1, 1], lambda xy: [0, 1079] + xy * [1, -1], "y_px must be counted from the top"),
    ],
)
def test_mirrored_floor_points_are_refused(times, change, advice):
    assert of_floor([1, 1, 1]).warnings == []
    with pytest.raises(InputError) as caught:
        of_floor(times, change)
    said = str(caught.value)
    assert "cameras east, south: expected them above the floor points that they see" in said
    assert advice in said and "\n" not in said


def test_left_and_right_exchanged_on_the_floor_of_a_court_are_refused():
    low = HALL.xyz[:, 2] == 0
    clicks = {name: xy[low] for name, xy in clicked(true_cameras()).items()}
    points = tuple(np.array(HALL.points)[low])
    edges = tuple(np.array(HALL.edges)[low])
    mirrored = HALL.xyz[low] * [-1, 1, 1] + [HALL.size_m[0], 0, 0]
    other = replace(HALL, xyz=mirrored, points=points, edges=edges, sigma_m=HALL.sigma_m[low])
    with pytest.raises(InputError, match="exchange the names of the left and right points in all"):
        points_alone.calibrate(other, clicks, dict.fromkeys(clicks, SIZE), **WEIGHTS)


def test_too_few_points_name_the_camera():
    clicks = clicked(true_cameras())
    seen = np.flatnonzero(np.isfinite(clicks["east"][:, 0]))
    clicks["east"][seen[6:]] = np.nan
    with pytest.raises(InputError, match="camera east: expected 8 clicked points"):
        calibrate(clicks)


def test_free_places_are_a_court_without_lines():
    places = court.of_places("points", HALL.points, HALL.xyz - [10, 20, 0])
    moved = replace(HALL, xyz=places.xyz, lines_m=places.lines_m)
    clicks = clicked(true_cameras())
    one, other = (
        points_alone.calibrate(of, clicks, dict.fromkeys(clicks, SIZE), **WEIGHTS)
        for of in (places, replace(moved, sigma_m=places.sigma_m))
    )
    np.testing.assert_allclose(one.solution.covariance, other.solution.covariance)
    message = points_alone.summary(one)
    assert message["n_points"]["east"] == np.isfinite(clicks["east"][:, 0]).sum()
    assert 0.5 < message["rms_px"]["east"] < 1.5
    assert message["f_sigma_px"]["east"] > 0
