"""Edges named by points, against the words in the court files and against projection."""

from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from courtside.calibration.court import line_edges
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures
from fixtures.cameras.scene import look_at, opencv_projection

FOLDER = Path(__file__).parents[4] / "config" / "courts"
COURTS = sorted(FOLDER.glob("*.yaml"))


@pytest.mark.parametrize("path", COURTS, ids=lambda path: path.stem)
def test_sides_are_as_the_words_say(path):
    """ "outer", "inner", "nearest the net", "nearest the back", "middle" each name one side."""
    court = court_files.read(path)
    named = line_edges.named(court)
    middle = court.size_m / 2
    for at, edges in enumerate(named):
        words = court.edges[at]
        if court.xyz[at, 2] > 0:
            assert edges == ()
            continue
        # A point on an arc or a mark lies on one straight edge at most.
        single = any(word in words for word in ("foot", "arc", "circle", "mark"))
        assert len(edges) == (min(len(edges), 1) if single else 2), court.points[at]
        inner = {0: "inner edge" in words and "side line" in words}
        inner[1] = "inner edge" in words and "end line" in words
        inwards = "nearest the net", "nearest the centre", "where the arc meets"
        assert words.count("middle") >= sum(edge.side == 0 for edge in edges)
        for edge in edges:
            outwards = np.sign(edge.at_m - middle[edge.axis])
            if edge.side == 0:
                assert "middle" in words
            elif inner[edge.axis] or (edge.axis == 1 and any(word in words for word in inwards)):
                assert edge.side == -outwards
            else:
                assert edge.side == outwards


def test_the_badminton_court_by_hand():
    court = court_pictures.badminton()
    named = dict(zip(court.points, line_edges.named(court), strict=True))
    assert [(e.axis, e.at_m, e.side) for e in named["p05"]] == [(0, 6.1, 1), (1, 4.72, 1)]
    assert [(e.axis, e.at_m, e.side) for e in named["p14"]] == [(0, 3.05, 0), (1, 0.76, -1)]
    assert [(e.axis, e.side) for e in named["p10"]] == [(0, -1)]
    for edges in named.values():
        for edge in edges:
            low, high = np.sort(court.lines_m[edge.line].reshape(2, 2), axis=0)
            assert (high - low)[edge.axis] == pytest.approx(0.04)


def test_a_click_scatters_as_its_two_edges_cross():
    """Two straight edges, each off across itself by a normal error, meet at the click."""
    court, rng = court_pictures.badminton(), np.random.default_rng(3)
    floor = court.xyz[court.xyz[:, 2] == 0]
    matrix = np.array([[1120.0, 0, 639.5], [0, 1120, 359.5], [0, 0, 1]])
    for place in ((-18, 6.7, 1.9), (3.05, -14.3, 2.1), (3.05, 6.7, 15.0)):
        camera = cameras.Camera("c", (1280, 720), matrix, np.zeros(5), look_at(place, (3, 6, 0)))
        found = line_edges.crossings(camera, floor)
        for xyz, covariance in zip(floor, found, strict=True):
            ends = opencv_projection(camera, xyz + 0.01 * np.vstack([np.zeros(3), np.eye(3)[:2]]))
            along = ends[1:] - ends[0]
            normals = along[:, ::-1] * [1, -1] / np.linalg.norm(along, axis=1, keepdims=True)
            drawn = np.linalg.solve(normals, rng.normal(size=(2, 4000))).T
            extent, axes = np.linalg.eigh(np.cov(drawn.T))
            expected = (axes * np.minimum(extent, line_edges.LONGEST**2)) @ axes.T
            np.testing.assert_allclose(covariance, expected, atol=0.12 * extent.max())
            assert np.linalg.eigvalsh(covariance)[0] == pytest.approx(extent[0], rel=0.1)
        assert np.isfinite(found).all()


def test_points_without_lines_scatter_alike():
    court = court_pictures.badminton()
    matrix = np.array([[1120.0, 0, 639.5], [0, 1120, 359.5], [0, 0, 1]])
    pose = look_at((-18, 6.7, 1.9), (3.05, 6.7, 1.3))
    camera = cameras.Camera("c", (1280, 720), matrix, np.zeros(5), pose)
    variances = line_edges.click_variances(camera, court)
    raised = court.xyz[:, 2] > 0
    assert (variances[raised] == 1).all()
    assert variances[~raised].max() > 4 and variances.min() > 0.4
    places = court_files.of_places("p", court.points, court.xyz)
    assert (line_edges.click_variances(camera, places) == 1).all()


def test_points_on_posts():
    court = court_pictures.badminton()
    found = {name: line_edges.post(court, at) for at, name in enumerate(court.points)}
    assert {name: post for name, post in found.items() if post is not None} == {
        "p10": 0, "p17": 0, "p11": 1, "p18": 1,
    }  # fmt: skip
    rectangle = court_files.read(FOLDER / "rectangle-10x5.yaml")
    assert line_edges.post(rectangle, 0) is None


def test_stretches_cover_each_line_once():
    court = court_pictures.badminton()
    line, ends = line_edges.stretches(court, 1.6)
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert length.max() < 2.4 and length.min() > 1.0
    for number in range(len(court.lines_m)):
        middle, half = line_edges.middle_line(court, number)
        mine = ends[line == number]
        np.testing.assert_allclose(mine[0, 0], middle[0])
        np.testing.assert_allclose(mine[-1, 1], middle[1])
        np.testing.assert_allclose(mine[1:, 0], mine[:-1, 1])
        assert np.linalg.norm(half) == pytest.approx(0.02)


def test_paint_is_where_the_picture_shows_it():
    court = court_pictures.badminton()
    camera = court_pictures.pair()[0]
    paint = line_edges.paint(camera, court)
    rng = np.random.default_rng(0)
    floor = np.column_stack([rng.uniform([-1, -1], [7, 14], (4000, 2)), np.zeros(4000)])
    xy = cameras.project(camera, floor)
    places = paint.place(xy)
    np.testing.assert_allclose(places, floor[:, :2], atol=1e-6)
    inside = [
        (floor[:, :2] >= line[:2]).all(axis=1) & (floor[:, :2] <= line[2:]).all(axis=1)
        for line in court.lines_m
    ]
    np.testing.assert_array_equal(paint.shows(floor[:, :2]), np.any(inside, axis=0))
    assert np.isnan(paint.place(np.array([480.0, 10.0]))).all()  # above the horizon
    assert not paint.shows(paint.place(np.array([480.0, 10.0])))
