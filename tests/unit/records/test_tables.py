"""CSV tables of the study."""

import csv

import numpy as np
import pandas as pd
import pytest

from courtside.records import tables
from courtside.study.errors import InputError


def test_labels_come_first_and_numbers_have_six_digits(tmp_path):
    path = tmp_path / "made" / "rows.csv"
    rows = pd.DataFrame({"joint": ["left_hip", "a, b"], "error_mm": [1 / 3, float("nan")]})
    tables.write(path, rows, {"session": "north", "n": 3})
    with path.open(newline="") as stream:
        found = list(csv.reader(stream))
    assert found[0] == ["session", "n", "joint", "error_mm"]
    assert found[1] == ["north", "3", "left_hip", "0.333333"]
    assert found[2] == ["north", "3", "a, b", ""]
    assert b"\r" not in path.read_bytes()


def test_times_of_long_takes_keep_a_tenth_of_a_millisecond_and_speeds_six_digits(tmp_path):
    time_s = 1200 + np.arange(4) / 120
    rows = pd.DataFrame({"time_s": time_s, "hand_m_s": time_s, "lag_s": [100, 1 / 3, np.nan, -2]})
    tables.write(tmp_path / "rows.csv", rows)
    assert (tmp_path / "rows.csv").read_text().splitlines()[1:] == [
        "1200,1200,100",
        "1200.0083,1200.01,0.333333",
        "1200.0167,1200.02,",
        "1200.025,1200.03,-2",
    ]


@pytest.mark.parametrize("number", [0.0, 1 / 3, -2 / 3e5, 99.99994, 99.99996, 1e-300, np.inf])
def test_times_below_100_s_are_written_as_other_numbers(tmp_path, number):
    tables.write(tmp_path / "rows.csv", pd.DataFrame({"time_s": [500.25, number]}))
    assert (tmp_path / "rows.csv").read_text().split()[2] == f"{number:.6g}"


def test_places_in_coordinates_of_a_survey_keep_a_tenth_of_a_millimetre(tmp_path):
    far = {"x_m": 691234.623456, "neck_y_m": 5336123.523456, "height_m": 520.12346}
    near = {"z_m": 1.2345678, "centre_x_m": 99.123456, "max_m": 1234.56789, "sd_mm": 1234.56789}
    tables.write(tmp_path / "rows.csv", pd.DataFrame([far | near]))
    assert (tmp_path / "rows.csv").read_text().splitlines()[1].split(",") == [
        *("691234.6235", "5336123.5235", "520.1235"),
        *("1.23457", "99.1235", "1234.57", "1234.57"),
    ]


def test_a_label_replaces_a_column_of_its_name(tmp_path):
    tables.write(tmp_path / "rows.csv", pd.DataFrame({"n": [1], "take": ["old"]}), {"take": "new"})
    assert (tmp_path / "rows.csv").read_text() == "take,n\nnew,1\n"


def test_labels_that_differ_by_row_come_first_too():
    rows = pd.DataFrame({"n": [1, 2], "take": ["a", "b"], "error_mm": [0.5, 1.0]})
    found = tables.labels_first(rows, {"take": "a"})
    assert list(found) == ["take", "n", "error_mm"] and found["take"].tolist() == ["a", "b"]


def test_parts_are_joined_each_with_its_own_labels():
    parts = [pd.DataFrame({"n": [1, 2]}), pd.DataFrame({"n": [3]})]
    found = tables.joined(parts, [{"stage": "raw"}, {"stage": "filtered"}])
    assert found.columns.tolist() == ["stage", "n"] and found.index.tolist() == [0, 1, 2]
    assert found.to_numpy().tolist() == [["raw", 1], ["raw", 2], ["filtered", 3]]
    with pytest.raises(ValueError, match="shorter"):
        tables.joined(parts, [{"stage": "raw"}])


def test_nothing_is_left_of_a_table_that_cannot_be_written(tmp_path):
    with pytest.raises(ValueError, match="float_format"):
        tables.write(tmp_path / "rows.csv", pd.DataFrame({"n": [0.5]}), float_format=3)
    assert list(tmp_path.iterdir()) == []


def test_what_was_written_is_read(tmp_path):
    tables.write(tmp_path / "rows.csv", pd.DataFrame({"n": [1, 2]}))
    found = tables.read(tmp_path / "rows.csv", "rows", lambda table: "")
    assert found["n"].tolist() == [1, 2]


@pytest.mark.parametrize("content", [None, b"", b"\xff\xfe\x00", b"n\n1\n"])
def test_what_is_no_such_table_is_named_in_one_line(tmp_path, content):
    path = tmp_path / "rows.csv"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(
        InputError, match=r"rows.csv: expected a table of rows, .*; delete it"
    ) as caught:
        tables.read(path, "a table of rows", lambda table: "found one row only")
    assert "\n" not in str(caught.value)


def test_labels_are_texts_and_numbers_are_not(tmp_path):
    rows = pd.DataFrame({"person": ["01", None], "foot": ["1", "2"], "n": [1, 2]})
    tables.write(tmp_path / "rows.csv", rows)
    found = tables.read(tmp_path / "rows.csv", "rows", lambda table: "")
    assert found["person"][0] == "01" and pd.isna(found["person"][1])
    assert found["foot"].tolist() == ["1", "2"] and found["n"].tolist() == [1, 2]
