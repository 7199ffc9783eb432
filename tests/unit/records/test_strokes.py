"""Strokes and reactions are read as they were written; other tables are refused."""

import pandas as pd
import pytest

from courtside.records import strokes, tables
from courtside.study.errors import InputError

WORDS = {"person": "p1", "opponent": "p2", "hand": "left", "hand_from": "found"}
FORMS = [
    ("strokes", strokes.STROKE_COLUMNS, strokes.read),
    ("reactions", strokes.REACTION_COLUMNS, strokes.read_reactions),
]


@pytest.mark.parametrize(("what", "columns", "read"), FORMS)
def test_a_written_table_is_read_again(tmp_path, what, columns, read):
    row = {name: WORDS.get(name, name == "overhead" or 0.25) for name in columns}
    rows = pd.DataFrame([row], columns=columns)
    tables.write(tmp_path / f"{what}.csv", rows)
    pd.testing.assert_frame_equal(read(tmp_path / f"{what}.csv"), rows)


@pytest.mark.parametrize(("what", "columns", "read"), FORMS)
def test_another_table_is_refused_in_one_line(tmp_path, what, columns, read):
    path = tmp_path / f"{what}.csv"
    row = {name: WORDS.get(name, 0.25) for name in columns}
    for name in (one for one in columns if one.endswith(("_s", "_m")) or one == "quality"):
        tables.write(path, pd.DataFrame([row]).drop(columns=name))
        with pytest.raises(InputError, match=rf"a table of {what}, found no column {name}\b"):
            read(path)
        tables.write(path, pd.DataFrame([{**row, name: "late"}]))
        with pytest.raises(InputError, match=f"a table of {what}, found {name} that is not a num"):
            read(path)
