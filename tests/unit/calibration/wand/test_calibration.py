"""Cameras from a simulated wand: comparison with the truth, stated errors, bad input."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.court import place_checks
from courtside.calibration.wand import adjustment, calibration, start
from courtside.calibration.wand.calibration import Floor
from courtside.geometry import camera as cameras
from courtside.geometry import similarity
from courtside.geometry.triangulation import triangulate_all
from courtside.statistics import normal_errors
from courtside.study.errors import InputError
from fixtures import remembered_calls
from fixtures.cameras.wands_made import (
    LENSES,
    RIG,
    SIZES,
    THREE,
    WAND,
    WEIGHTS,
    floor_points,
    seen,
    swung,
)

PLACES = np.stack(np.meshgrid([-1.5, 0, 1.5], [-1.5, 0, 1.5], [0.3, 1.1, 2.0]), -1).reshape(-1, 3)


@pytest.fixture(scope="module", autouse=True)
def solved_once():
    """Solve the same cameras only once: tests differ in what they do with them."""
    with remembered_calls.of((start, "guess"), (adjustment, "adjust")):
        yield


def calibrate(found, wand=WAND, lenses=None, **more):
    return calibration.calibrate(wand, found, SIZES, lenses=lenses or {}, **more)


def errors(found, markers):
    """Return errors (N, 3) m at `PLACES`, after the rigid motion that fits the wand's markers."""
    exact = np.stack([cameras.project(camera, markers) for camera in RIG])
    placed = triangulate_all(found.cameras, exact)
    rigid = similarity.rigid(placed, markers)
    there = triangulate_all(found.cameras, np.stack([cameras.project(c, PLACES) for c in RIG]))
    network = conversion.network_of(found.cameras)
    spread = point_covariance.point_covariance(network, found.covariance.of_columns(), there)
    return rigid.points(there) - PLACES, rigid.rotation @ spread @ rigid.rotation.T


@pytest.mark.parametrize(
    ("lenses", "wand"), [(LENSES, WAND), ({}, WAND), ({"c1": LENSES["c1"]}, THREE)]
)
def test_without_noise_the_true_cameras_are_found(lenses, wand):
    xyz = swung(wand.along_m)
    found = calibrate(seen(xyz, sigma_px=0.0), wand, lenses)
    off, _ = errors(found, xyz.reshape(-1, 3))
    assert np.linalg.norm(off, axis=1).max() < (1e-5 if len(lenses) == 4 else 2e-3)
    for camera, true in zip(found.cameras, RIG, strict=True):
        assert camera.K[1, 1] == pytest.approx(true.K[1, 1], rel=2e-3)
        if camera.name in lenses:
            np.testing.assert_array_equal(camera.dist, true.dist)


@pytest.mark.parametrize(
    ("order", "middle_m", "found"),
    [([2, 1, 0], 0.2, "66"), ([0, 2, 1], 0.2, "(29|30)"), ([1, 0, 2], 0.2, "-(49|50)"),
     ([0, 1, 2], 0.23, "33")],
)  # fmt: skip
def test_three_markers_in_another_order_or_with_a_wrong_middle_are_refused(order, middle_m, found):
    wand = replace(THREE, along_m=np.array([0.0, middle_m, 0.6]))
    refused(
        rf"wand: expected the middle marker at {100 * middle_m / 0.6:.1f} % of the length from the "
        rf"first, found it at {found}\d*\.\d %; correct the order of `markers`, or `middle_m`$",
        seen(swung(THREE.along_m)[:, order]),
        wand=wand,
    )


def test_errors_are_as_large_as_stated():
    xyz, squares, most = swung(), [], []
    for seed in range(4):
        found = calibrate(seen(xyz, seed=seed, hidden=0.15, misread=0.03), lenses=LENSES)
        assert found.adjusted.sigma_px == pytest.approx(0.5, rel=0.08)
        off, spread = errors(found, xyz.reshape(-1, 3))
        squares.append(normal_errors.mahalanobis(off, spread))
        most.append(np.linalg.norm(off, axis=1).max())
    assert max(most) < 4e-3
    assert 1.0 < np.mean(squares) < 6.0  # 3 over many draws: places here err together


def board_lenses(seed):
    """Return the lenses with the errors of chessboards: 0.2 % of f, 0.1 % of the width, k1 0.01."""
    rng, found = np.random.default_rng(seed), {}
    for name, lens in LENSES.items():
        f, (cx, cy) = 1 + 0.002 * rng.standard_normal(), 1.9 * rng.standard_normal(2)
        K = lens.K * [[f, 1, 1], [1, f, 1], [1, 1, 1]] + [[0, 0, cx], [0, 0, cy], [0, 0, 0]]
        dist = lens.dist + np.array([0.01 * rng.standard_normal(), 0, 0, 0, 0])
        found[name] = replace(lens, K=K, dist=dist)
    return found


@pytest.mark.parametrize("clicked", [False, True])
def test_errors_of_lenses_from_chessboards_are_part_of_what_is_stated(clicked):
    xyz, off, stated = swung(), [], []
    for seed in range(5):
        lenses = board_lenses(seed)
        more = {"clicks": floor_points()} if clicked else {}
        found = calibrate(seen(xyz, seed=seed), lenses=lenses, of_boards=list(LENSES), **more)
        assert found.covariance.sigma("c1", "f_px") == pytest.approx(2.8, rel=0.02)
        markers, there = (
            triangulate_all(found.cameras, np.stack([cameras.project(c, at) for c in RIG]))
            for at in (xyz.reshape(-1, 3), PLACES)
        )
        moved = similarity.rigid(markers, xyz.reshape(-1, 3))
        off.append(((there if clicked else moved.points(there)) - PLACES) ** 2)
        stated.append(np.trace(errors(found, xyz.reshape(-1, 3))[1], axis1=1, axis2=2))
    least = 0.2 if clicked else 0.6  # the clicks are 3 times as exact as stated
    assert least < np.sqrt(np.mean(np.sum(off, axis=2)) / np.mean(stated)) < 1.4
    exact = calibrate(seen(xyz, seed=4), lenses=lenses, **more)  # as of a calibration file
    assert exact.covariance.sigma("c1", "f_px") == 0
    np.testing.assert_array_equal(exact.cameras[1].K, found.cameras[1].K)
    np.testing.assert_array_equal(exact.cameras[1].cam_from_world, found.cameras[1].cam_from_world)


def test_the_stated_length_is_the_unit_and_its_uncertainty_is_that_of_all_lengths():
    xyz = swung()
    longer = replace(WAND, along_m=1.01 * WAND.along_m, sigma_m=0.005)
    found = calibrate(seen(xyz, sigma_px=0.1), longer, LENSES)
    placed = triangulate_all(
        found.cameras, np.stack([cameras.project(camera, PLACES) for camera in RIG])
    )
    assert similarity.umeyama(PLACES, placed).scale == pytest.approx(1.01, abs=1e-3)
    off, spread = errors(found, xyz.reshape(-1, 3))
    corner = np.linalg.norm(PLACES - xyz.reshape(-1, 3).mean(axis=0), axis=1).argmax()
    assert np.sqrt(np.trace(spread[corner])) == pytest.approx(np.linalg.norm(off[corner]), rel=0.15)


def test_a_wand_on_the_floor_gives_the_floor():
    xyz = swung()
    xyz[10] = [[1.0, 0.5, 0.02], [1.0, 1.0, 0.02]]
    xyz[20] = [[-0.5, 0.0, 0.02], [-1.0, 0.0, 0.02]]
    floor = Floor((10.0, 20.0), 0.02)
    found = calibrate(seen(xyz, sigma_px=0.2), lenses=LENSES, floor=floor)
    for camera, true in zip(found.cameras, RIG, strict=True):
        # Origin below the first marker, x along the wand, which lies along y.
        x, y, z = true.centre_in_world - [1.0, 0.5, 0.0]
        np.testing.assert_allclose(camera.centre_in_world, [y, -x, z], atol=0.03)
    assert found.stated
    with pytest.raises(InputError, match=r"wand.floor: expected frames of .* found 999; list"):
        calibrate(seen(xyz), lenses=LENSES, floor=Floor((10.0, 999.0)))
    with pytest.raises(InputError, match=r"wand.floor: expected two frames or more .* on one line"):
        calibrate(seen(xyz), lenses=LENSES, floor=Floor((10.0,)))
    hidden = seen(xyz)
    hidden.xy[:, 20] = np.nan
    with pytest.raises(InputError, match=r"times at which a camera sees it, found 20; list"):
        calibrate(hidden, lenses=LENSES, floor=floor)
    hidden = seen(xyz)
    hidden.xy[:, 10, 1] = np.nan
    with pytest.raises(InputError, match=r"wand.floor: expected a first frame .* list another fr"):
        calibrate(hidden, lenses=LENSES, floor=floor)


def test_without_a_floor_the_frame_is_the_cameras_own():
    found = calibrate(seen(swung(), sigma_px=0.2), lenses=LENSES)
    along = found.cameras[1].centre_in_world - found.cameras[0].centre_in_world
    assert not found.stated
    assert abs(along[1]) < 1e-6 < along[0]
    heights = [camera.centre_in_world[2] for camera in found.cameras]
    assert np.ptp(heights) < 1.5
    assert np.abs(np.nanmedian(found.xyz, axis=(0, 1))).max() < 1e-9


def test_clicked_points_give_the_world():
    found = calibrate(seen(swung()), clicks=floor_points())
    for camera, true in zip(found.cameras, RIG, strict=True):
        assert np.linalg.norm(camera.centre_in_world - true.centre_in_world) < 0.03
    placed = triangulate_all(
        found.cameras, np.stack([cameras.project(camera, PLACES) for camera in RIG])
    )
    assert np.linalg.norm(placed - PLACES, axis=1).max() < 0.01
    network = conversion.network_of(found.cameras)
    spread = point_covariance.point_covariance(network, found.covariance.of_columns(), placed)
    square = normal_errors.mahalanobis(placed - PLACES, spread)
    assert np.mean(square < normal_errors.ellipsoid(0.9)) > 0.7


def test_clicks_have_the_variances_of_the_cameras_where_they_stand():
    points, centres = floor_points(), []

    def clicks(rig):
        centres.append([camera.centre_in_world for camera in rig])
        return points(rig)

    calibrate(seen(swung()), clicks=clicks)
    true = [camera.centre_in_world for camera in RIG]
    assert np.linalg.norm(np.subtract(centres[-1], true), axis=1).max() < 0.1


def test_left_handed_floor_points_put_the_cameras_below_the_floor():
    points = floor_points()
    court, marked = points.args
    mirrored = replace(court, xyz=court.xyz * [1, -1, 1])
    for there, wrong in (court, False), (mirrored, True):
        clicks = partial(points.func, there, marked, **WEIGHTS)
        cameras_found = calibrate(seen(swung()), lenses=LENSES, clicks=clicks).cameras
        if wrong:
            with pytest.raises(InputError, match="m below: points or clicks are mirrored; x_m, y"):
                place_checks.check_cameras(there, cameras_found, marked)
        else:
            assert place_checks.check_cameras(there, cameras_found, marked) == []


def test_clicks_in_one_place_are_refused():
    points = floor_points()
    court, marked = points.args
    here = {name: np.full_like(px, 300.0) for name, px in marked.items()}
    with pytest.raises(
        InputError, match=r"^wand: expected 4 clicked points .*, not all in one place"
    ):
        calibrate(seen(swung()), clicks=partial(points.func, court, here, **WEIGHTS))


def test_clicks_have_the_loss_that_is_stated_for_them():
    """A wrong click moves the cameras only if the loss of clicks is wide."""
    points = floor_points()
    court, marked = points.args
    marked = {name: px.copy() for name, px in marked.items()}
    marked["c0"][4] += 40
    most = []
    for click_loss in (3.0, 1e6):
        clicks = partial(points.func, court, marked, **WEIGHTS | {"click_loss": click_loss})
        found = calibrate(seen(swung()), lenses=LENSES, clicks=clicks)
        off = [
            a.centre_in_world - b.centre_in_world for a, b in zip(found.cameras, RIG, strict=True)
        ]
        most.append(np.linalg.norm(off, axis=1).max())
    assert most[0] < 5e-3 < 10e-3 < most[1]


def test_clicked_points_show_that_y_of_the_markers_runs_up():
    xyz = swung()
    upside = seen(xyz)
    upside.xy[..., 1] = 1080 - upside.xy[..., 1]
    with pytest.raises(InputError, match=r"their mirror image: y of the wand's .*; correct `wand"):
        calibrate(upside, clicks=floor_points())


def refused(match, found, **more):
    with pytest.raises(InputError, match=match) as error:
        calibrate(found, lenses=more.pop("lenses", LENSES), **more)
    assert "\n" not in str(error.value)


def test_bad_input_is_one_line():
    xyz = swung()
    good = seen(xyz)
    still = np.repeat(xyz[:1], len(xyz), axis=0)
    refused(r"wand: expected a path of 0.5 times its length or more in a picture", seen(still))
    refused(
        r"expected 20 frames or more in which a camera of each group sees two",
        replace(good, frames=good.frames[:12], xy=good.xy[:, :12]),
    )
    apart = good.xy.copy()
    apart[:2, ::2] = apart[2:, 1::2] = np.nan
    refused(r"wand: cameras c0, c1 and c2, c3: expected 20 frames", replace(good, xy=apart))
    mirrored = good.xy.copy()
    mirrored[2, ..., 0] = 1919 - mirrored[2, ..., 0]
    refused(r"camera c2: expected .* once mirrored; undo the flip", replace(good, xy=mirrored))
    late = good.xy.copy()
    late[1] = np.roll(late[1], 2, axis=0)
    refused(r"camera c1: expected .*check its clock", replace(good, xy=late))
    far = floor_points()
    shifted = partial(far.func, *far.args[:1], {k: v + 300 for k, v in far.args[1].items()})
    refused(r"wand: expected clicked points within 38 px", good, clicks=partial(shifted, **WEIGHTS))
    one = {name: np.full((9, 2), np.nan) for name in LENSES}
    few = partial(far.func, far.args[0], one, **WEIGHTS)
    refused(r"wand: expected 4 clicked points or more in one camera", good, clicks=few)


def test_a_wand_that_stays_in_a_plane_or_on_a_line_is_refused():
    xyz = swung()
    xyz[..., 2] = 1.0
    refused(
        r"wand: expected movement in all directions, found positions in a plane",
        seen(xyz),
        lenses={},
    )
    middle = xyz.mean(axis=1, keepdims=True)
    line = middle * [1, 0, 0] + (swung() - swung().mean(axis=1, keepdims=True)) * 0.1
    refused(r"wand: .* found positions on a line", seen(line, sigma_px=0.1))
