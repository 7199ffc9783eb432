"""Tables that benchmarks write: rows of the documents' numbers."""

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[1] / "benchmarks"))  # last, as in `test_benchmarks.py`
import stated
from courtside.evaluation.numbers import register
from courtside.evaluation.numbers import stated as read

KEPT = ["halls", "one, hall", "found", "1.5", "cm", "one", "8", "0", "benchmark", "run.py"]


@pytest.fixture
def table(tmp_path):
    path = tmp_path / stated.FOLDER / "halls.csv"
    path.parent.mkdir(parents=True)
    stated.write(path, [KEPT])
    return path


def test_parts_of_one_cell_are_joined():
    rows = [["ways", "walk", "alone", 1.2, "cm"], ["ways", "walk", "alone_shape", 0.5, "cm"]]
    found = stated.joined([*rows, ["ways", "walk", "refined", 1.1, "cm"]])
    assert found == [
        ["ways", "walk", "alone", "1.2; 0.5", "cm"],
        ["ways", "walk", "refined", 1.1, "cm"],
    ]


def test_a_new_run_keeps_the_rows_of_sessions_that_it_did_not_measure(table):
    assert stated.of_other_sessions(table, {"two"}) == [KEPT]
    assert stated.of_other_sessions(table, {"one"}) == []
    assert stated.of_other_sessions(table.with_name("none.csv"), {"one"}) == []


def test_what_is_written_is_read_as_numbers_of_the_documents(table):
    (found,) = read.numbers(register.Source(table.parents[2]))
    assert (found.row, found.value, found.n, found.command) == ("one, hall", 1.5, 8, "run.py")
