"""Every point is drawn where it is, under its name, with its edges beside it."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from courtside.calibration.court import court as court_files
from courtside.figures.calibration import court_points
from fixtures import drawings

COURTS = Path(__file__).parents[4] / "config" / "courts"


@pytest.fixture(params=["badminton", "tennis", "rectangle-10x5"])
def court(request):
    return court_files.read(COURTS / f"{request.param}.yaml")


def test_the_table_holds_the_courts_points(court):
    rows = court_points.table(court)
    assert tuple(rows["point"]) == court.points
    np.testing.assert_array_equal(rows[["x_m", "y_m", "z_m"]], court.xyz)
    np.testing.assert_array_equal(rows["sigma_m"], court.sigma_m)
    assert tuple(rows["edges"]) == court.edges
    assert "three" in rows["sets"][0].split()


def test_all_points_are_numbered_in_place(court):
    plan = court_points.draw(court).axes[0]
    named = {name: text.xy for text in plan.texts for name in text.get_text().split(", ")}
    assert set(named) == set(court.points)
    for name, place in zip(court.points, court.xyz, strict=True):
        np.testing.assert_array_equal(named[name], place[:2])


def test_the_list_holds_every_point_and_all_edges(court):
    drawing = court_points.draw(court)
    words = " ".join(text.get_text() for text in drawing.axes[1].texts).split()
    assert set(court.points) <= set(words)
    for edges in court.edges:
        assert " ".join(edges.split()) in " ".join(words)


def test_details_are_centred_on_points_where_lines_meet():
    court = court_files.read(COURTS / "badminton.yaml")
    details = {axis.get_title(): axis for axis in court_points.draw(court).axes[2:]}
    for name in ("p01", "p04", "p08", "p12", "p14"):
        middle = [np.mean(details[name].get_xlim()), np.mean(details[name].get_ylim())]
        np.testing.assert_allclose(middle, court.xyz[court.points.index(name), :2], atol=1e-12)


def test_the_net_is_drawn_where_there_is_one():
    with_net = court_points.draw(court_files.read(COURTS / "badminton.yaml")).axes[-1]
    assert {text.get_text() for text in with_net.texts} >= {"p10", "p11", "p17", "p18"}
    without = court_points.draw(court_files.read(COURTS / "rectangle-10x5.yaml")).axes
    assert not any("Net" in axis.get_title() for axis in without)


@pytest.fixture
def wall(tmp_path):
    """Points on a wall, most of them beside the court's rectangle, none on the floor."""
    places = [(-0.36, 0.06, 0.3), (1.59, -0.77, 6.4), (-1.85, -0.59, 4.2), (0.09, 0.89, 4.0)]
    places += [(2.34, -1.3, 0.4), (-0.81, -0.71, 6.4), (-1.35, -0.23, 2.2)]
    content = {
        "description": "a wall",
        "size_m": [4.2, 6.4],
        "line_width_m": 0.04,
        "sigma_m": {"floor": 0.005, "raised": 0.005},
        "points": {f"p{at}": {"xyz_m": list(p), "edges": "a"} for at, p in enumerate(places)},
        "sets": {"three": ["p0", "p4", "p6"]},
        "lines_m": [[0, 0, 1, 0.04]],
        "net": None,
    }
    path = tmp_path / "wall.yaml"
    path.write_text(yaml.safe_dump(content))
    return court_files.read(path)


def test_points_beside_a_court_are_drawn_whole(wall):
    drawing = court_points.draw(wall)
    assert drawings.cut(drawing) == []
    plan = drawing.axes[0]
    inside = plan.get_window_extent()
    marks = [line for line in plan.lines if len(line.get_xdata())]
    assert len(marks) == len(wall.points)
    for text in plan.texts:
        box = text.get_window_extent()
        assert inside.y0 < box.y0 and box.y1 < inside.y1, text.get_text()
        assert text.get_zorder() < min(mark.get_zorder() for mark in marks)
    legend, label = plan.get_legend(), plan.xaxis.label
    assert legend.get_window_extent().y1 < label.get_window_extent().y0


def test_the_legend_says_what_is_there(wall):
    def words(court):
        return [text.get_text() for text in court_points.draw(court).axes[0].get_legend().texts]

    frame = "origin, end of x, end of y"
    assert words(wall) == ["above the floor", frame]
    court = court_files.read(COURTS / "badminton.yaml")
    assert words(court) == ["on the floor", "on the floor, and one above it", frame]
