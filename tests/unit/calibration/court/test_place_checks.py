"""Places that are wrong for a whole camera are named; other cameras' places tell."""

import numpy as np
import pytest

from courtside.calibration.court import place_checks
from courtside.records.cameras.placed_points import PlacedPoints
from courtside.study.errors import InputError

# Corners and crossings of a hall with two courts.
PLACES = np.array(
    [[x, y, 0] for x in (-9, -3, 0, 3, 9) for y in (-4.5, 4.5)]
    + [[x, y, 0] for x in (-14, -5, 0, 5, 14) for y in (-7.5, 7.5)],
    dtype=float,
)


def placed(moved, cameras=("a", "b", "c"), chosen=lambda at: slice(None)):
    """Return points of cameras, those in `moved` at other places."""
    names, xyz, clicks = [], [], {}
    rows = [
        (camera, place)
        for at, camera in enumerate(cameras)
        for place in (PLACES + np.asarray(moved.get(camera, 0.0)))[chosen(at)]
    ]
    for _, place in rows:
        name = str(np.round(place, 3).tolist())
        if name not in names:
            names.append(name)
            xyz.append(place)
    for camera in cameras:
        clicks[camera] = np.full((len(names), 2), np.nan)
    for camera, place in rows:
        clicks[camera][names.index(str(np.round(place, 3).tolist()))] = [1, 2]
    return PlacedPoints(tuple(names), np.array(xyz), clicks)


def test_points_with_coordinates_are_read_as_a_court_unless_a_camera_s_are_shifted(tmp_path):
    def read(moved):
        rows = ["camera,x_px,y_px,x_m,y_m,z_m"]
        for camera in "abc":
            places = PLACES + np.asarray(moved.get(camera, 0.0))
            rows += [f"{camera},{at},2,{x},{y},{z}" for at, (x, y, z) in enumerate(places)]
        path = tmp_path / "points.csv"
        path.write_text("\n".join([*rows, ""]))
        return place_checks.read(path, None, ["a", "b", "c"], placed=True)

    court, clicks = read({})
    np.testing.assert_allclose(court.xyz, PLACES)
    assert clicks["b"][3].tolist() == [3, 2]
    with pytest.raises(InputError, match=r"points.csv: camera b: expected its 20 points"):
        read({"b": (0, -0.5, 0)})


def test_right_places_are_left_alone():
    assert place_checks.shifts(placed({})) == []


@pytest.mark.parametrize(
    ("moved", "message"),
    [
        ((0, -0.5, 0), "y_m is 0.50 m too small"),
        ((0.4, 0, 0), "x_m is 0.40 m too large"),
        ((0.3, 0.6, 0), "x_m is 0.30 m too large, y_m is 0.60 m too large"),
    ],
)
def test_a_camera_whose_places_are_all_off_is_named_with_the_way(moved, message):
    (found,) = place_checks.shifts(placed({"b": moved}))
    assert found.camera == "b"
    np.testing.assert_allclose(found.by_m, -np.array(moved), atol=1e-9)
    assert f"camera b: expected its {len(PLACES)} points" in str(found) and message in str(found)


def test_rounded_places_hide_nothing():
    rng = np.random.default_rng(0)
    shift = [0, -0.5, 0] + rng.uniform(-0.05, 0.05, (len(PLACES), 3)) * [1, 1, 0]
    (found,) = place_checks.shifts(placed({"b": shift}))
    np.testing.assert_allclose(found.by_m, [0, 0.5, 0], atol=0.04)


def test_cameras_that_see_other_lines_are_not_taken_for_moved_ones():
    halves = (slice(0, 4), slice(4, 10), slice(10, 20))
    assert place_checks.shifts(placed({}, chosen=lambda at: halves[at])) == []


def test_few_points_say_nothing():
    found = place_checks.shifts(placed({"b": (0, 0.5, 0)}, chosen=lambda at: slice(0, 3)))
    assert found == []


def test_of_two_cameras_both_are_named():
    found = place_checks.shifts(placed({"b": (0, -0.5, 0)}, cameras=("a", "b")))
    assert [one.camera for one in found] == ["a", "b"]
    np.testing.assert_allclose(found[0].by_m, -found[1].by_m)
