"""Every point is drawn where it is, under its name, with its edges beside it."""

from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from courtside.figures.calibration import court_points

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
