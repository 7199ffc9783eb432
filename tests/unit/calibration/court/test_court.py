"""Courts against the rule books' other lengths, and every fault of a court file in one line."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from courtside.calibration.court import court as court_files
from courtside.calibration.court import line_edges, sfm_alignment
from courtside.calibration.court_lines import walk_and_lines
from courtside.study.errors import InputError

FOLDER = Path(__file__).parents[4] / "config" / "courts"
NAMES = ["badminton", "tennis", "rectangle-10x5", "volleyball"]
ARCS = ["basketball", "futsal", "sports-hall"]  # points of these may lie on arcs


def court(name="badminton"):
    return court_files.read(FOLDER / f"{name}.yaml")


def distance(where, first, second):
    at = where.indices([first, second])
    return np.linalg.norm(np.subtract(*where.xyz[at]))


@pytest.mark.parametrize(
    ("name", "pair", "length_m"),
    [  # lengths that the rule books print and that are not in the file
        ("badminton", ("p03", "p02"), 14.723),  # diagonal of the doubles court
        ("badminton", ("p08", "p09"), 3.96),  # between the short service lines
        ("badminton", ("p12", "p08"), 4.72),  # service court
        ("badminton", ("p14", "p08"), 3.96),  # service court for doubles
        ("tennis", ("p12", "p13"), 8.23),  # singles court
        ("tennis", ("p08", "p09"), 12.80),  # two service courts of 6.40 m
        ("tennis", ("p10", "p11"), 12.798),  # posts, 0.914 m outside each side line
        ("rectangle-10x5", ("p02", "p03"), np.hypot(10, 5)),
        ("volleyball", ("p05", "p07"), 6.0),  # both front zones
        ("volleyball", ("p01", "p05"), 6.0),  # back zone
        ("basketball", ("p01", "p02"), 15.0),  # inner edges of the boundary
        ("basketball", ("p01", "p03"), 28.0),
        ("basketball", ("p11", "p12"), 4.9),  # restricted area
        ("basketball", ("p17", "p18"), 3.6),  # centre circle, radius 1.80 m
        ("basketball", ("p19", "p20"), 3.6),
        ("basketball", ("p15", "p16"), 28 - 2 * (1.575 + 6.75)),  # between three-point arcs
        ("futsal", ("p01", "p04"), np.hypot(20, 40)),
        ("futsal", ("p07", "p08"), 6.0),  # centre circle, radius 3 m
        ("futsal", ("p13", "p14"), 3.16),  # between the arcs of the penalty area
        ("futsal", ("p09", "p10"), 3.16 + 2 * 6.0),
    ],
)
def test_lengths_agree_with_the_rule_books(name, pair, length_m):
    assert distance(court(name), *pair) == pytest.approx(length_m, abs=6e-4)


@pytest.mark.parametrize("name", [*NAMES, *ARCS])
def test_courts_are_symmetric_about_both_middles(name):
    found = court(name)
    places = {tuple(np.round(p, 6)) for p in found.xyz}
    for axis in (0, 1):
        mirrored = found.xyz.copy()
        mirrored[:, axis] = found.size_m[axis] - mirrored[:, axis]
        assert {tuple(np.round(p, 6)) for p in mirrored} == places
        lines = found.lines_m.copy()
        lines[:, [axis, axis + 2]] = found.size_m[axis] - lines[:, [axis + 2, axis]]
        assert {tuple(np.round(row, 6)) for row in lines} == {
            tuple(np.round(row, 6)) for row in found.lines_m
        }


@pytest.mark.parametrize("name", NAMES)
def test_lines_have_the_width_and_points_lie_on_paint(name):
    found = court(name)
    width = np.abs(found.lines_m[:, 2:] - found.lines_m[:, :2]).min(axis=1)
    np.testing.assert_allclose(width, found.line_width_m, atol=1e-9)
    assert len(found.edges) == len(found.points) == len(set(found.points))
    for point, edge, shift in zip(
        found.xyz, found.edges, court_files.to_line_centres(found), strict=True
    ):
        if point[2] > 0 or "post: its middle" in edge:
            assert not shift.any()
        elif "edge" in edge:
            assert np.abs(shift).max() == pytest.approx(found.line_width_m / 2)
        else:
            np.testing.assert_allclose(shift, 0, atol=1e-9)


def test_arcs_of_the_penalty_area_are_6_m_about_the_goal_posts():
    futsal = court("futsal")
    for post_x, corner, meets in ((8.42, "p13", "p09"), (11.58, "p14", "p10")):
        at = futsal.xyz[futsal.indices([corner, meets])]
        away = np.linalg.norm(at - [post_x, 0, 0], axis=1)
        np.testing.assert_allclose(away, 6.0, atol=1e-9)


def test_a_sports_hall_is_its_courts_centred_on_one_another():
    hall = court("sports-hall")
    places = dict(zip(hall.points, hall.xyz, strict=True))
    for sport in ("futsal", "basketball", "volleyball"):
        own = court(sport)
        shift = [*(hall.size_m - own.size_m) / 2, 0]
        for name, xyz in zip(own.points, own.xyz, strict=True):
            np.testing.assert_allclose(places.pop(name.replace("p", sport[0])), xyz + shift)
        for line in own.lines_m:
            moved = line + np.tile(shift[:2], 2)
            assert np.abs(hall.lines_m - moved).max(axis=1).min() < 1e-9
    assert not places


def test_places_become_a_court_without_lines():
    found = court_files.of_places("points", ["a", "b"], np.array([[1.0, 2, 0], [4, 9, 2.4]]))
    assert (found.points, found.size_m.tolist()) == (("a", "b"), [3, 7])
    assert found.sigma_m.tolist() == [0.005, 0.015]
    assert found.indices("all").tolist() == [0, 1] and len(found.lines_m) == 0


def test_a_floor_surveyed_to_some_millimetres_stays_floor():
    z = [0.002, -0.001, 0.0, 1.55]
    found = court_files.of_places(
        "points", list("abcd"), np.array([[k, 0, z[k]] for k in range(4)])
    )
    assert found.sigma_m.tolist() == [0.005, 0.005, 0.005, 0.015]


def test_the_badminton_court_is_the_papers():
    found = court()
    assert found.size_m.tolist() == [6.1, 13.4]
    assert found.sets["eight"] == ("p01", "p02", "p03", "p10", "p11", "p16", "p17", "p18")
    assert found.sets["all"] == found.points and len(found.points) == 18
    np.testing.assert_array_equal(
        found.xyz[found.indices("three")], [[0, 0, 0], [6.1, 0, 0], [0, 13.4, 0]]
    )
    assert found.sigma_m[found.indices(["p01", "p17", "p18"])].tolist() == [0.005, 0.015, 0.015]
    # Line centres of a court that is 40 mm smaller in both directions.
    moved = (found.xyz + court_files.to_line_centres(found))[found.indices(["p01", "p16"])]
    np.testing.assert_allclose(moved, [[0.02, 0.02, 0], [6.08, 13.38, 0]], atol=1e-12)


def change(content, keys, value):
    for key in keys[:-1]:
        content = content[key]
    if value is KeyError:
        del content[keys[-1]]
    else:
        content[keys[-1]] = value


@pytest.mark.parametrize(
    ("keys", "value", "named"),
    [
        (("net",), KeyError, ["'net'", "the key"]),
        (("colour",), "blue", ["colour"]),
        (("size_m",), [13.4, 6.1], ["short side", "exchange"]),
        (("size_m",), [6.1], ["size_m", "2"]),
        (("line_width_m",), "wide", ["line_width_m", "wide"]),
        (("line_width_m",), 0, ["line_width_m", "more than 0"]),
        (("sigma_m",), 0.005, ["sigma_m", "floor"]),
        (("sigma_m", "raised"), -1, ["sigma_m.raised", "more than 0"]),
        (("points",), {}, ["points"]),
        (("points", "p01", "xyz_m"), [0, 0], ["p01", "xyz_m", "3"]),
        (("points", "p01", "edges"), KeyError, ["p01", "edges"]),
        (("points", "P 1"), {"xyz_m": [1, 1, 0], "edges": "x"}, ["P 1"]),
        (("points", "p19"), {"xyz_m": [0, 0, 0], "edges": "x"}, ["p01", "p19", "0 m apart"]),
        (("sets",), [], ["sets"]),
        (("sets", "three"), KeyError, ["sets", "'three'"]),
        (("sets", "three"), ["p01", "p02"], ["sets.three", "at least 3", "end of x"]),
        (("sets", "three"), ["p01", "p02", "p03", "p16"], ["sets.three", "at most 3"]),
        (("sets", "eight"), ["p01", "p99"], ["eight", "p99"]),
        (("sets", "eight"), ["p01", "p01"], ["eight", "differ", "'p01' again"]),
        (("sets", "eight"), "p01", ["eight", "list"]),
        (("lines_m",), 3, ["lines_m"]),
        (("lines_m",), [[0, 0, 1]], ["lines_m.0", "at least 4", "x1"]),
        (
            ("lines_m",),
            [[0, 0, 6, 0.04], [0, 0, 7, 0.04], [-1, 0, 0, 1]],
            ["0, 0 to 6.1, 13.4 (size_m), found line 2 [0.0, 0.0, 7.0, 0.04] and 1 more beyond"],
        ),
        (("net", "y_m"), KeyError, ["net", "y_m"]),
        (("net", "x_m"), 3, ["net", "x_m"]),
    ],
)
def test_a_fault_is_one_line_that_names_it(tmp_path, keys, value, named):
    content = yaml.safe_load((FOLDER / "badminton.yaml").read_text())
    change(content, keys, value)
    path = tmp_path / "wrong.yaml"
    path.write_text(yaml.safe_dump(content))
    with pytest.raises(InputError) as caught:
        court_files.read(path)
    message = str(caught.value)
    assert "\n" not in message
    assert [word for word in [str(path), *named] if word not in message] == []


def test_a_place_may_have_no_lines(tmp_path):
    content = yaml.safe_load((FOLDER / "rectangle-10x5.yaml").read_text()) | {"lines_m": []}
    path = tmp_path / "bare.yaml"
    path.write_text(yaml.safe_dump(content))
    found = court_files.read(path)
    assert found.lines_m.shape == (0, 4) and not found.placed
    assert not court_files.to_line_centres(found).any()
    assert not line_edges.on_lines(found).any()
    line, ends = line_edges.stretches(found, 1.0)
    assert line.shape == (0,) and ends.shape == (0, 2, 3)


def test_floor_points_a_centimetre_high_are_floor_for_all_that_uses_them(tmp_path):
    content = yaml.safe_load((FOLDER / "badminton.yaml").read_text())
    for point in content["points"].values():
        point["xyz_m"][2] = point["xyz_m"][2] or 0.01
    path = tmp_path / "badminton.yaml"
    path.write_text(yaml.safe_dump(content))
    found, flat = court_files.read(path), court()
    assert found.on_floor.tolist() == (flat.xyz[:, 2] == 0).tolist()
    np.testing.assert_array_equal(
        court_files.to_line_centres(found), court_files.to_line_centres(flat)
    )
    assert np.isfinite(sfm_alignment.stretch(found, found.xyz)[1])
    both = (walk_and_lines.of_points(each) for each in (found, flat))
    for one, other in zip(*both, strict=True):
        np.testing.assert_array_equal(one, other)


def test_half_a_turn_gives_each_point_the_view_of_its_other_end():
    badminton = court()
    places = badminton.xyz[:, :2]
    np.testing.assert_allclose(badminton.turned(places), badminton.size_m - places, atol=1e-9)
    moved = badminton.xyz.copy()
    moved[4] += 0.5
    lost = np.isnan(replace(badminton, xyz=moved).turned(places)).any(axis=1)
    assert lost[4] and lost.sum() == 2  # and the point whose other end it was
