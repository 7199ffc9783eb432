"""Tables that benchmarks write: rows of the documents' numbers, and what these sum up."""

import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

sys.path.append(str(Path(__file__).parents[1] / "benchmarks"))  # last, as in `test_benchmarks.py`
import contacts
import reactions
import stated
import strokes
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


def rows(results, errors_ms, **others):
    """Return rows of a table of errors, each true time within its interval if off by 20 ms."""
    table = pd.DataFrame({"result": results, "error_ms": errors_ms, **others}, dtype=object)
    table["error_ms"] = table["error_ms"].astype(float)
    within = (table["error_ms"].abs() <= 20).astype(object)
    return table.assign(within_90_percent=within.where(table["result"] == "found"))


def test_hits_are_counted_and_their_errors_are_in_frames():
    results = ["found", "found", "found", "missed", "false", "cut"]
    found = strokes.summary_of_hits(rows(results, [100, -20, 10, *3 * [np.nan]]), 30.0)
    assert (found["hits"], found["found_percent"], found["false"]) == (4, 75, 1)
    assert found["median_frames"] == pytest.approx(0.6)
    assert found["p95_frames"] == pytest.approx(0.6 + 0.9 * (3 - 0.6))
    assert found["within_90_percent"] == pytest.approx(200 / 3)
    assert np.isnan(strokes.summary_of_hits(rows(["cut"], [np.nan]), 30.0)["found_percent"])


def test_answers_are_counted_by_what_is_compared():
    results = ["found", "found", "missed", "false", "cut", "missed"]
    table = rows(results, [-50, 20, *4 * [np.nan]], what=[*5 * ["split_step"], "to_step"])
    found = reactions.summary_of_answers(table, "split_step")
    assert found["found_percent"] == pytest.approx(200 / 3)
    assert (found["true"], found["false"]) == (3, 1)
    assert (found["bias_ms"], found["median_ms"]) == (-15, 35)
    assert (found["within_40_ms_percent"], found["within_90_percent"]) == (50, 50)
    none = reactions.summary_of_answers(table, "to_step")
    assert (none["true"], none["found_percent"]) == (1, 0)
    assert np.isnan(none["median_ms"]) and np.isnan(none["within_40_ms_percent"])
    assert np.isnan(reactions.summary_of_answers(table, "to_split")["found_percent"])


def test_errors_of_onsets_are_those_of_persons_whose_truth_is_known(monkeypatch):
    onset_s = {"left": 1.0, "right": 2.0}

    def true_contact(truth, person, foot):
        return None, {"onset": np.array([onset_s[foot]])}

    monkeypatch.setattr(contacts.contacts, "true_contact", true_contact)
    known = SimpleNamespace(
        person_id=np.array(["p1", "p2"]), foot=np.array(list(onset_s)), time_s=np.arange(5.0)
    )
    made = [
        (who, foot, at_s + 0.05, 0.01) for who in ("p1", "p2") for foot, at_s in onset_s.items()
    ]
    steps = pd.DataFrame(made, columns=["person", "foot", "onset_s", "onset_sigma_s"])
    truth = SimpleNamespace(person_id=np.array(["p1"]))
    found = contacts.errors_of_times(known, steps, truth, "onset")
    np.testing.assert_allclose(found, [[0.05, 0.01]] * 2)
    assert contacts.errors_of_times(known, steps[:0], truth, "onset").shape == (0, 2)
