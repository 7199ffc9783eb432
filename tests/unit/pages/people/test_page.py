"""Content of the page on which persons are named (browser tests use it)."""

import json
import re
from dataclasses import replace
from types import SimpleNamespace

import cv2
import numpy as np
import pytest

from courtside.pages.people import page
from courtside.pages.people.strips import Shot
from fixtures import scripts
from fixtures.people import named_takes

WORDS = {"session": "hall", "take": "<walk>", "subjects": ["p1"], "target": "data/people.csv"}
PICTURE = cv2.imencode(".jpg", np.zeros((20, 10, 3), np.uint8))[1].tobytes()


def shot(person, column, camera="c0"):
    return Shot(person, column, camera, 1.2345, (10.0, 20.0), 120.0, PICTURE)


def built(**given):
    take = named_takes.take(3, gone=[(2, slice(1, None))])
    take.found.placed[:] = np.isfinite(take.found.path[..., 0]).mean(axis=1)
    columns = {k: [5, 30] for k in page.shown(take.found)}
    shots = [shot(0, 0), shot(0, 0, "c1"), shot(1, 1)]
    return page.build(WORDS, take.found, take.seen, columns, shots, **given)


def data(html):
    (held,) = re.findall(r'id="data-people">(.*?)</script>', html)
    return json.loads(held)


def test_persons_have_columns_of_pictures_and_a_path():
    held = data(built())
    assert [person["name"] for person in held["persons"]] == ["person-1", "person-2"]
    assert held["left_out"] == 1
    first = held["persons"][0]
    assert [column["time_s"] for column in first["columns"]] == [0.5, 3.0]
    assert [view["camera"] for view in first["columns"][0]["views"]] == ["c0", "c1"]
    assert first["columns"][0]["views"][0]["at_px"] == [10.0, 20.0]
    assert first["columns"][1]["views"] == []
    assert first["path"][0] == [0.0, 0.0, 0.0]
    assert held["clocks"] == {"c0": [0.0, 1.0], "c1": [0.5, 1.0]}
    assert held["court"] is None


def test_the_least_certain_times_of_a_doubtful_person_are_shown():
    take = named_takes.take(2)
    rows = [[0.0, at, at + 0.3, 1, kept] for at, kept in enumerate((0.95, 0.93, 0.96, 0.94))]
    found = replace(take.found, doubts=np.array(rows))
    first, second = data(page.build(WORDS, found, take.seen, {0: [5], 1: [5]}, []))["persons"]
    assert first["doubts"] == [[1.0, 1.3, 0.93], [3.0, 3.3, 0.94]]
    assert second["doubts"] == []


def test_the_page_holds_the_court_and_names_given_before():
    court = SimpleNamespace(size_m=np.array([6.1, 13.4]), lines_m=np.array([[0, 0, 1, 1.0]]))
    named = [{"person": 1, "subject": "p1", "time_s": 1.0, "from_s": None, "to_s": None}]
    rows = [["run", "p1", "c0", "1", "2", "3", "", ""]]
    held = data(built(court=court, named=named, rows=rows))
    assert held["court"] == {"size_m": [6.1, 13.4], "lines_m": [[0, 0, 1, 1.0]]}
    assert held["named"] == named and held["rows"] == rows
    assert held["stamp"] != data(built())["stamp"]


def test_names_of_takes_are_text():
    html = built()
    assert "<walk>" not in html.replace("&lt;walk&gt;", "")
    assert "hall, &lt;walk&gt;" in html


def mark(subject, time_s, from_s=None, to_s=None):
    return {"subject": subject, "time_s": time_s, "from_s": from_s, "to_s": to_s}


@pytest.mark.parametrize(
    ("named", "parts"),
    [
        ([], [(0, "")]),
        ([mark("a", 3), mark("a", 9)], [(0, "a")]),
        ([mark("a", 3), mark("b", 9)], [(0, "a"), (6, "b")]),
        ([mark("a", 12, 10, 20), mark("a", 17, 10, 20)], [(0, ""), (10, "a"), (20, "")]),
        ([mark("a", 2, 0, 10), mark("a", 22, 20, 30)], [(0, "a"), (10, ""), (20, "a")]),
        ([mark("a", 2, 0.0004, 10), mark("b", 22, 10.0004, 29.9996)], [(0, "a"), (10.0004, "b")]),
        ([mark("a", 2, None, 8), mark("b", 22, None, None)], [(0, "a"), (8, "b")]),
    ],
)
def test_names_given_before_keep_the_parts_that_nobody_named(named, parts):
    call = f"peopleTable.parts({json.dumps(named)}, {{start_s: 0, stop_s: 30}})"
    found = scripts.call("people_table.js", call)
    assert [(one["from"], one["subject"]) for one in found] == parts
