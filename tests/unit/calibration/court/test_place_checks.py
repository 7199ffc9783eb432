"""Places that are wrong for a whole camera are named; other cameras' places tell."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from courtside.calibration.court import place_checks
from courtside.geometry.camera import Camera
from courtside.records.cameras.placed_points import PlacedPoints
from courtside.study.errors import InputError
from fixtures.cameras.scene import look_at

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


def read(tmp_path, moved, times=1.0):
    """Read points from a file, those of cameras in `moved` at other places."""
    rows = ["camera,x_px,y_px,x_m,y_m,z_m"]
    for camera in "abc":
        places = times * (PLACES + np.asarray(moved.get(camera, 0.0)))
        rows += [f"{camera},{at},2,{x},{y},{z}" for at, (x, y, z) in enumerate(places)]
    path = tmp_path / "points.csv"
    path.write_text("\n".join([*rows, ""]))
    return place_checks.read(path, None, ["a", "b", "c"], placed=True)


def test_points_with_coordinates_are_read_as_a_court_unless_a_camera_s_are_shifted(tmp_path):
    court, clicks = read(tmp_path, {})
    assert court.placed
    np.testing.assert_allclose(court.xyz, PLACES)
    assert clicks["b"][3].tolist() == [3, 2]
    with pytest.raises(InputError, match=r"points.csv: camera b: expected its 20 points"):
        read(tmp_path, {"b": (0, -0.5, 0)})


@pytest.mark.parametrize(
    ("times", "likely"),
    [
        (1000, "mm (31.8 m apart: multiply them by 0.001)"),
        (100, "cm (31.8 m apart: multiply them by 0.01) or mm (3.18 m apart: multiply them by 0"),
        (25, "cm (7.94 m apart: multiply them by 0.01) or inches (20.2 m apart: multiply them by"),
        (39.37, "cm (12.5 m apart: multiply them by 0.01) or inches (31.8 m apart: multiply"),
    ],
)
def test_places_in_another_unit_are_told_with_each_way_to_metres(tmp_path, times, likely):
    with pytest.raises(InputError, match=r"points.csv: camera a: expected points in m") as caught:
        read(tmp_path, {"b": (0, -0.5, 0)}, times)
    said = str(caught.value)
    assert f"found {np.hypot(28, 15) * times:.0f} m" in said
    assert f"; x_m, y_m and z_m are likely in {likely}" in said and "\n" not in said


def test_places_in_no_unit_that_fits_are_told(tmp_path):
    with pytest.raises(InputError, match=r"found 31765 m between them; x_m"):
        read(tmp_path, {}, 1000)
    with pytest.raises(InputError, match=r"m between them; give x_m, y_m and z_m in m$"):
        read(tmp_path, {}, 1e7)


def test_points_farther_apart_than_a_pitch_is_long_are_doubted(tmp_path):
    assert [*place_checks.unit_doubt(*placed_at(5))] == [
        "camera a: its points are 159 m apart: right on a field of that size; if not, x_m, y_m and "
        "z_m are likely in inches (4.03 m apart: multiply them by 0.0254) or feet (48.4 m apart: "
        "multiply them by 0.3048)"
    ]
    assert [*place_checks.unit_doubt(*placed_at(4))] == []
    assert [*place_checks.unit_doubt(PLACES, {"a": np.full((20, 2), np.nan)})] == []


def placed_at(times):
    """Return places that are so many times as large, and clicks of one camera on all."""
    return times * PLACES, {"a": np.ones((20, 2))}


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


def rig(height_m, turned=False, aim_m=0.0):
    """Return two cameras, perhaps upside down, that look at places on a floor or a ceiling."""
    found = []
    for name, at in (("a", (20, 3, height_m)), ("b", (-18, -9, height_m + 1))):
        pose = np.diag([-1.0, -1.0, 1.0] if turned else [1.0] * 3) @ look_at(at, (0, 0, aim_m))
        matrix = np.array([[1000.0, 0, 960], [0, 1000, 540], [0, 0, 1]])
        found.append(Camera(name, (1920, 1080), matrix, np.zeros(5), pose))
    return found


def checked(cameras, z, names=("a", "b")):
    """Check cameras that see all points, which have heights `z`."""
    xyz = PLACES + np.stack([0 * PLACES[:, 0], 0 * PLACES[:, 0], np.broadcast_to(z, 20)], axis=1)
    court = court_files.of_places("points", [str(k) for k in range(20)], xyz)
    seen = {c.name: np.full((20, 2), 5.0 if c.name in names else np.nan) for c in cameras}
    return place_checks.check_cameras(court, cameras, seen)


SPREAD = np.linspace(2, 5, 20)


@pytest.mark.parametrize(
    ("height_m", "turned", "z"),
    [
        (6, False, 0),  # on stands, points on the floor
        (0.1, False, 0),  # on the floor: the error of its height may be larger
        (-0.1, False, 0),
        (1.5, False, SPREAD),  # on a tripod, points on a wall
        (106, False, 100),  # survey coordinates
    ],
)
def test_cameras_that_can_stand_where_they_are_pass(height_m, turned, z):
    assert checked(rig(height_m, turned, np.median(z)), z) == []


@pytest.mark.parametrize(("height_m", "z"), [(6, 0), (1.5, SPREAD)])
def test_cameras_that_hang_upside_down_are_doubted_and_not_refused(height_m, z):
    (line,) = checked(rig(height_m, True, np.median(z)), z)
    assert line.startswith("cameras a, b: expected them upright, found them upside down: right if")
    assert "y_px must be counted from the top" in line and "right-handed with z up" in line


def test_points_at_one_height_above_the_floor_may_be_seen_from_below():
    (line,) = checked(rig(1.5, aim_m=6), 6)
    assert "cameras a, b: 3.5 to 4.5 m below all of their points" in line
    assert "right if these are on a gallery or a ceiling" in line and "right-handed" in line


@pytest.mark.parametrize("z", [0, 100, np.r_[np.zeros(17), 1, 1, 3]])
def test_cameras_below_the_floor_that_they_see_mean_left_handed_places(z):
    floor_m = np.median(z)
    with pytest.raises(InputError) as caught:
        checked(rig(floor_m - 6, turned=True, aim_m=floor_m), z)
    said = str(caught.value)
    assert "cameras a, b: expected them above the floor points" in said and "5.0 to 6.0 m" in said
    assert "right-handed with z up: change the sign of y_m in all rows" in said
    assert "\n" not in said


def test_only_cameras_that_see_points_are_named():
    with pytest.raises(InputError, match="cameras b: expected them above the floor"):
        checked(rig(-6, turned=True), 0, names=("b",))


def test_pictures_tell_why_points_seem_to_be_seen_from_below():
    with pytest.raises(InputError, match="y_px must be counted from the top"):
        checked(rig(-6), 0)
    lying = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    cameras = [replace(one, cam_from_world=lying @ one.cam_from_world) for one in rig(-6)]
    with pytest.raises(InputError, match="x_px and y_px seem to be exchanged"):
        checked(cameras, 0)


def test_cameras_too_high_for_a_hall_ask_for_the_unit():
    (line,) = checked(rig(600), 0)
    assert "cameras a, b: expected them at most 60 m above their points, found 600.0" in line
    assert "check the unit of the places, which is m" in line
