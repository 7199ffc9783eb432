"""What is said of calibrated cameras without the truth, where the truth is known."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court, quality
from courtside.calibration.records.covariance import CameraCovariance
from courtside.calibration.records.support import Support
from courtside.geometry import camera as camera_models
from courtside.study.errors import InputError
from fixtures.cameras.scene import look_at, opencv_projection

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")


def fixed():
    matrix = np.array([[1120.0, 0, 639.5], [0, 1120, 359.5], [0, 0, 1]])
    places = {"side": (-18, 6.7, 1.9), "back": (3.05, -14.3, 2.1)}
    return [
        camera_models.Camera(name, (1280, 720), matrix, np.zeros(5), look_at(at, (3.05, 6.7, 1)))
        for name, at in places.items()
    ]


def clicks_of(xyz=COURT.xyz):
    return {camera.name: opencv_projection(camera, xyz) for camera in fixed()}


def of_court(clicks, **options):
    found = quality.check_cameras(COURT, fixed(), clicks, click_sigma_px=0.3, **options)
    json.dumps(found, allow_nan=False)  # as it is written
    return found


def test_exact_cameras_leave_nothing_to_say():
    found = of_court(clicks_of())
    assert found["warnings"] == []
    assert set(found["left_out"]) == set(COURT.points)
    for row in found["left_out"].values():
        assert row["error_cm"] == pytest.approx(0, abs=1e-3)
        assert set(row["error_px"]) == {"side", "back"}


def test_a_point_that_is_off_is_measured_by_the_others():
    moved = COURT.xyz.copy()
    moved[6] += (0.1, 0.05, 0)
    row = of_court(clicks_of(moved))["left_out"]["p07"]
    assert row["error_cm"] == pytest.approx(100 * np.hypot(0.1, 0.05), abs=0.01)
    for camera in fixed():
        off = opencv_projection(camera, np.stack([moved[6], COURT.xyz[6]]))
        expected = np.linalg.norm(off[0] - off[1])
        assert row["error_px"][camera.name] == pytest.approx(expected, abs=0.01)


def test_a_click_that_is_missing_is_null():
    clicks = clicks_of()
    clicks["back"][3] = np.nan
    row = of_court(clicks)["left_out"]["p04"]
    assert row["error_cm"] is None and row["error_px"]["back"] is None
    assert row["error_px"]["side"] == pytest.approx(0, abs=1e-3)


def test_an_impossible_court_is_an_error_or_a_warning():
    stretched = clicks_of(COURT.xyz * [5.18 / 6.1, 1, 1])
    with pytest.raises(InputError, match="right court file"):
        of_court(stretched)
    (warning,) = of_court(stretched, strict=False)["warnings"]
    assert "found 5.18 m by 13.4 m" in warning


def test_too_few_points_to_leave_one_out_are_said():
    clicks = {
        name: np.where(np.arange(18)[:, None] < 3, xy, np.nan) for name, xy in clicks_of().items()
    }
    found = of_court(clicks)
    assert found["left_out"].startswith("court points: expected three or more")
    assert any("3 are seen by two cameras" in line for line in found["warnings"])


@pytest.mark.parametrize("line", [("p01", "p06", "p03"), ("p01", "p04", "p06", "p03")])
def test_points_of_which_one_alone_is_beside_a_line_are_said_to_be_unchecked(line):
    used = np.isin(COURT.points, [*line, "p02"])[:, None]
    found = of_court({name: np.where(used, xy, np.nan) for name, xy in clicks_of().items()})
    (said,) = [line for line in found["warnings"] if "a wrong click cannot be noticed" in line]
    assert "without one of them, the others do not tell where" in said and "\n" not in said


@pytest.mark.parametrize(
    ("inwards", "n_warnings"), [((1.1, 0.15), 1), ((0.2, 0.15), 0), ((1, 0.4), 0)]
)
def test_line_centres_are_said_where_the_shift_is_certain(inwards, n_warnings):
    found = of_court(clicks_of(), inwards=inwards)["warnings"]
    assert len(found) == n_warnings
    assert all("inwards of the edges by 22 mm (+-3), half a line width" in line for line in found)


def test_without_a_court_maps_that_disagree_are_a_warning():
    assert len(quality.check_maps(2, 3)["warnings"]) == 1
    (unscaled,) = quality.check_maps(1, 1)["warnings"]
    assert unscaled.startswith(
        "no court: scale and frame are arbitrary, and lengths have no unit; "
    )
    assert "click three of its points or more" in unscaled
    _, warning = quality.check_maps(1, 6)["warnings"]
    assert "found that none of 5 others agrees with the best" in warning and "\n" not in warning


@pytest.mark.parametrize("above", [0.0, 0.2])
def test_a_map_that_contradicts_a_pair_is_doubtful(above):
    pair = "static/side.png", "frames/walk/000003.png"
    support = Support(0.8, pair[1], 0.6, pair, quality.SUPPORTED + above)
    assert quality.map_warning(support) == ""
    warning = quality.map_warning(support._replace(pair_share=0.244))
    assert warning.startswith("map doubtful: expected 30 % or more of the matches of static/side")
    assert "000003.png" in warning and "found 24 %; take more bridging images; if" in warning


def test_fixed_cameras_in_one_place_of_the_map_are_told():
    walk = np.random.default_rng(0).uniform(-5, 5, (30, 3))  # an extent of about 17
    apart = {"c1": walk[0], "c2": walk[1], "c3": walk[0] + (0, 0.5, 0)}
    assert quality.one_place(apart, walk) == ""
    line = quality.one_place(apart | {"c3": walk[0] + (0, 0.05, 0)}, walk)
    assert line.startswith("cameras c1 and c3: expected them in two places of the map")
    assert "its ends look alike" in line and "\n" not in line


@pytest.mark.parametrize(("lower_m", "told"), [(0.0, False), (1.2, True)])
@pytest.mark.parametrize(("n_above", "found"), [(0, "1.2 m"), (60, "1.1 m")])  # of the ceiling
def test_a_map_below_the_floor_of_the_court_is_told(lower_m, told, n_above, found):
    rng = np.random.default_rng(0)
    floor = np.column_stack([rng.uniform(-2, 8, (30, 2)), rng.uniform(0, 0.1, 30)])
    walls = np.column_stack([rng.uniform(20, 30, (200, 2)), rng.uniform(-3, -2, 200)])  # far away
    above = floor[rng.integers(30, size=n_above)] + (0, 0, 8)
    line = quality.sunken(COURT, np.concatenate([floor - (0, 0, lower_m), walls, above]))
    assert bool(line) is told
    if told:
        assert f"{found} or more below it; click the same court in all cameras" in line
        assert quality.sunken(COURT, floor[:9] - (0, 0, lower_m)) == ""  # too few to tell


def test_clicks_that_bend_the_map_are_told():
    assert quality.strained(7.0) == quality.strained(np.nan) == ""
    line = quality.strained(38.1)
    assert "by 38 half squared sigmas (good: up to 20)" in line and "\n" not in line
    assert "all walks are of this hall" in line


def test_the_volume_of_a_court_without_lines_begins_in_its_corner_too():
    cameras = fixed()
    spread = CameraCovariance([one.name for one in cameras], np.eye(28) * 1e-4)
    bare = replace(COURT, lines_m=np.zeros((0, 4)), xyz=np.add(COURT.xyz, (1, 2, 0)))
    assert quality.expected_volume(bare, cameras, spread) == quality.expected_volume(
        COURT, cameras, spread
    )


def test_the_volume_is_a_grid_over_the_court():
    grid = quality.volume(COURT)
    assert grid.shape == (4 * 7 * 5, 3)
    np.testing.assert_allclose(grid.min(axis=0), [0, 0, 0])
    np.testing.assert_allclose(grid.max(axis=0), [6.1, 13.4, 3])
    np.testing.assert_allclose(grid[:6, 0], [0, 1.525, 3.05, 4.575, 6.1, 0])
    np.testing.assert_allclose(grid[[0, 5, 35], 1], [0, 13.4 / 6, 0])
    assert len(np.unique(grid.round(9), axis=0)) == len(grid)
    assert quality.volume(COURT, [0.5], 2, 3)[:, 2].tolist() == [0.5] * 6
