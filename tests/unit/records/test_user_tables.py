"""Tables that people write: columns in any order, and a line for every fault."""

import pytest

from courtside.records import user_tables
from courtside.study.errors import InputError


def written(tmp_path, text):
    path = tmp_path / "own.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_rows_have_their_lines_and_cells_without_blanks(tmp_path):
    path = written(tmp_path, "b , a\n\n 1,x y \n,\n2,z\n")
    rows = user_tables.table(path, ("a", "b"), ("c",))
    assert rows == [(3, {"b": "1", "a": "x y"}), (5, {"b": "2", "a": "z"})]


def test_empty_cells_beyond_the_columns_are_left_out_as_spreadsheets_write_them(tmp_path):
    path = written(tmp_path, "a,b,,\n1,2,,\n3,,,\n4,5\n,,,\n")
    rows = user_tables.table(path, ("a", "b"))
    assert rows == [(2, {"a": "1", "b": "2"}), (3, {"a": "3", "b": ""}), (4, {"a": "4", "b": "5"})]
    with pytest.raises(InputError, match="line 2: expected 2 cells, found 4; correct it"):
        user_tables.table(written(tmp_path, "a,b,,\n1,2,,left\n"), ("a", "b"))
    with pytest.raises(InputError, match="with commas between, found a,,b; correct the first"):
        user_tables.table(written(tmp_path, "a,,b,\n1,2,3,\n"), ("a", "b"))


def test_lines_have_their_numbers_empty_ones_too(tmp_path):
    path = written(tmp_path, "a, b\n\n,\n1\n")
    assert user_tables.lines(path, "do") == [(1, ["a", "b"]), (2, []), (3, ["", ""]), (4, ["1"])]


@pytest.mark.parametrize("header", ["a", "a,a,b", "a,b,d", ""])
def test_other_columns_are_refused_with_those_that_may_be_there(tmp_path, header):
    with pytest.raises(InputError, match=r"own.csv: expected the columns a,b and perhaps c with"):
        user_tables.table(written(tmp_path, f"{header}\n"), ("a", "b"), ("c",))


@pytest.mark.parametrize("header", ["a;b", "a\tb", "b;a;c"])
def test_other_characters_between_the_cells_are_told(tmp_path, header):
    with pytest.raises(InputError, match="save it with commas between the cells, and points in"):
        user_tables.table(written(tmp_path, f"{header}\n1;2,5\n"), ("a", "b"), ("c",))


def test_a_short_line_is_refused(tmp_path):
    with pytest.raises(InputError, match="line 2: expected 2 cells, found 1; correct it"):
        user_tables.table(written(tmp_path, "a,b\n1\n"), ("a", "b"))


def test_names_and_numbers_are_told_with_what_was_expected():
    assert user_tables.known("x", "camera", "a", ["a", "b"]) == "a"
    with pytest.raises(InputError, match="x: expected a camera of a, b, found 'c'; correct it or"):
        user_tables.known("x", "camera", "c", ["a", "b"])
    assert user_tables.number("x", "y_px", "-1.5") == -1.5
    for text in ("nan", "inf", "one", ""):
        with pytest.raises(InputError, match="x: expected y_px as a finite number, found"):
            user_tables.number("x", "y_px", text)
    with pytest.raises(InputError, match="expected frame_idx as 0, the first, found '1'"):
        user_tables.number("x", "frame_idx", "1", 0, "0, the first")
