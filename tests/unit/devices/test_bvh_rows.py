"""Rows of a BVH file: numbers, counts, widths."""

import numpy as np
import pytest

from courtside.devices import bvh
from courtside.study.errors import InputError


def test_rows_are_numbers_whatever_their_padding():
    text = "head\n\n 1\t2.5e-1  -3. \n   \n+.5 6 7E2\n\n"
    found = bvh.read_rows("a.bvh", text, len("head\n"), 2, 3)
    np.testing.assert_array_equal(found, [[1, 0.25, -3], [0.5, 6, 700]])
    assert bvh.read_rows("a.bvh", "head\n \n", 5, 0, 3).shape == (0, 3)


@pytest.mark.parametrize(
    ("rows", "line", "told"),
    [
        ("1 2 3\n4 5\n", 3, "expected 3 numbers, one for each channel, found 2"),
        ("1 2 3 4\n1 2 3 4\n", 2, "found 4"),
        ("1 2 3\n\n4 nan 6\n", 4, "'nan'"),
        ("1 2 3\n4 -Infinity 6\n", 3, "'-Infinity'"),
        ("1 2 3\n4 1e999 6\n", 3, "'1e999'"),
        ("1 2 3\n4 2e9 6\n", 3, "at most 1e\\+09, found '2e9'"),
        ("1 2 3\n4 0,5 6\n", 3, "'0,5'"),
        ("1 2 3\n4 0x10 6\n", 3, "'0x10'"),
        ("1 2 3\n4 1_0 6\n", 3, "'1_0'"),
        ("1 2 3\n4 # 6\n", 3, "'#'"),
        (f"1 2 3\n4 {'1' * 50} 6\n", 3, "1111..."),
        ("1 2 3\n" + "5 " * 5000 + "\n", 3, "a line of 10000 characters"),
    ],
)
def test_a_bad_row_is_named(rows, line, told):
    with pytest.raises(InputError, match=told) as caught:
        bvh.read_rows("a.bvh", "head\n" + rows, 5, 2, 3)
    assert str(caught.value).startswith(f"a.bvh: line {line}: ")
    assert "\n" not in str(caught.value)


def test_more_or_fewer_rows_are_refused():
    with pytest.raises(InputError, match="expected 4 rows of motion as `Frames:` says, found 2"):
        bvh.read_rows("a.bvh", "1 2\n3 4\n", 0, 4, 2)
    with pytest.raises(InputError, match=r"expected 1 rows .*, found 2"):
        bvh.read_rows("a.bvh", "1 2\n3 4\n", 0, 1, 2)
    with pytest.raises(InputError, match="expected a channel in some joint"):
        bvh.read_rows("a.bvh", "1\n", 0, 1, 0)


def test_words_are_numbers_between_bounds():
    assert bvh.is_number("-9.23872e-007")
    assert bvh.is_number("0", least=0.0)
    assert not bvh.is_number("-1e-9", least=0.0)
    assert not bvh.is_number("٣")  # a digit, but not one of BVH's
    assert bvh.shown("") == "nothing"
    assert bvh.shown("a\nb") == "'a\\nb'"
