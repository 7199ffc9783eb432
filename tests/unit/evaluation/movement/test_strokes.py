"""Strokes against true hits: found, missed, false, cut."""

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation.movement import strokes
from courtside.records.strokes import STROKE_COLUMNS
from fixtures.people import strokes_made


@pytest.fixture(scope="module")
def perfect():
    """Return a drill and strokes at its true hits."""
    points, truth = strokes_made.take(seed=1)
    true_s = [hit for hit in strokes.hits(truth, "p1") if hit < points.time_s[-1]]
    rows = pd.DataFrame({"time_s": true_s, "person": "p1", "sigma_s": 0.02, "hand": "right"})
    return points, truth, rows.reindex(columns=STROKE_COLUMNS).assign(overhead=True)


def test_hits_are_read_in_order_and_their_windows_are_not(perfect):
    _, truth, _ = perfect
    names = [name for name in truth.events["p1"] if name.endswith("_start")]
    assert len(strokes.hits(truth, "p1")) == len(names)
    assert strokes.hits(truth, "p2") == []


def test_the_error_is_found_less_true_and_its_interval_is_judged(perfect):
    points, truth, rows = perfect
    moved = rows.assign(time_s=rows.time_s + np.where(rows.index == 0, 0.05, 0.01))
    found = strokes.table(moved, points, truth)
    found = found[found.result == "found"]
    np.testing.assert_allclose(found.error_ms.iloc[:2], [50, 10], atol=1e-6)
    assert found.within_90_percent.tolist()[:2] == [False, True]


def test_missed_false_and_cut_ones_are_told_apart(perfect):
    points, truth, rows = perfect
    first = rows.time_s[0]
    other = rows.assign(time_s=np.where(rows.index == 0, first + 0.6, rows.time_s))
    found = strokes.table(other, points, truth)
    assert found.result.value_counts().loc[["missed", "false"]].tolist() == [1, 1]
    short = points.between(first - 0.1, points.time_s[-1])
    assert strokes.table(rows, short, truth).result.iloc[0] == "cut"
