"""people.csv: rows of one take, faults in one line."""

import pytest

from courtside.records.keypoints import sightings
from courtside.study.errors import InputError

TAKES = ["walk", "run"]
HEAD = "take,subject,camera,time_s,x_px,y_px"


def read(tmp_path, *lines, head=HEAD):
    path = tmp_path / "people.csv"
    path.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")
    return sightings.read(path, "walk", ["p1", "p2"], ["left", "right"])


def test_rows_of_the_take_are_read(tmp_path):
    head = f"{HEAD},from_s,to_s"
    first, second = read(
        tmp_path,
        "walk,p1,left,0.5,10,20.5,,",
        "run,p1,x,1,1,1,,",
        "walk,p2,right,2,0,0,1,",
        head=head,
    )
    assert (first.subject, first.camera, first.time_s, first.xy) == ("p1", "left", 0.5, (10, 20.5))
    assert (first.from_s, first.to_s) == (None, None)
    assert (second.from_s, second.to_s) == (1.0, None)
    assert second.where.endswith("people.csv: line 4")
    rows = sightings.every_row(tmp_path / "people.csv", TAKES)
    assert [row[0] for row in rows] == ["walk", "run", "walk"]
    assert rows[1] == ["run", "p1", "x", "1", "1", "1", "", ""]


def test_the_bounds_may_be_left_out(tmp_path):
    (one,) = read(tmp_path, "walk,p1,left,0.5,10,20")
    assert one.to_s is None
    assert read(tmp_path) == []


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("walk,p3,left,1,1,1", "line 2: expected a subject of p1, p2, found 'p3'"),
        ("walk,p1,top,1,1,1", "line 2: expected a camera of left, right, found 'top'"),
        ("walk,p1,left,soon,1,1", "line 2: expected time_s as a finite number, found 'soon'"),
        ("walk,p1,left,1,nan,1", "line 2: expected x_px as a finite number, found 'nan'"),
        ("walk,p1,left,1,1", "line 2: expected 6 cells, found 5"),
    ],
)
def test_faults_name_file_and_line(tmp_path, line, words):
    with pytest.raises(InputError, match=rf"people\.csv: {words}") as fault:
        read(tmp_path, line)
    assert "\n" not in str(fault.value)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("walk,p1,left,1,1,1,3,2", "expected from_s before to_s, found 3.0 and 2.0"),
        ("walk,p1,left,9,1,1,1,2", "expected time_s from from_s to to_s, found 9.0"),
        ("walk,p1,left,-1,1,1,0,2", "expected time_s from from_s to to_s, found -1.0"),
    ],
)
def test_bounds_hold_the_time(tmp_path, line, words):
    with pytest.raises(InputError, match=words):
        read(tmp_path, line, head=f"{HEAD},from_s,to_s")


@pytest.mark.parametrize("head", ["", "take,subject", f"{HEAD},more", f"{HEAD},take"])
def test_another_table_is_refused(tmp_path, head):
    with pytest.raises(InputError, match=r"people\.csv: expected the columns take,subject"):
        read(tmp_path, head=head)


def test_a_row_of_no_take_is_named(tmp_path):
    read(tmp_path, "walk,p1,left,1,1,1", "jump,p1,left,1,1,1")
    with pytest.raises(InputError, match=r"line 3: expected a take of walk, run, found 'jump'"):
        sightings.every_row(tmp_path / "people.csv", TAKES)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.csv: expected a readable CSV"):
        sightings.every_row(tmp_path / "none.csv", TAKES)


def test_an_entry_of_a_session_is_a_sighting():
    entry = {"camera": "left", "time_s": 1, "at_px": [3, 4]}
    one = sightings.stated("hall.yaml: subjects.p1.seen", "p1", entry)
    assert (one.camera, one.time_s, one.xy, one.from_s) == ("left", 1.0, (3, 4), None)
