"""Contact of the feet between rules."""

import numpy as np
import pandas as pd
import pytest

from courtside.records import footwork
from courtside.study.errors import InputError

STEPS = pd.DataFrame(
    [
        ("m1", "left", "stand", np.nan, np.nan, 0.52, 0.01, 0.0, 2.0, 0.1, -2.0, 0.01, 0.99),
        ("m1", "right", "lunge", 0.8, 0.012, np.nan, np.nan, 0.0, 2.0, 0.9, -2.5, 0.02, 0.9),
    ],
    columns=list(footwork.STEP_COLUMNS),
)
EVENTS = pd.DataFrame(
    [("m1", "split_step", "both", 0.5, 0.01, 0.62, 0.02, 0.0, -2.0, 0.8)],
    columns=list(footwork.EVENT_COLUMNS),
)


def test_what_is_written_is_read(tmp_path):
    made = footwork.Contacts(
        np.array(["m1"]),
        np.array(footwork.FEET),
        np.arange(3) / 30,
        np.array([[[1.0, 0.5], [0.9, np.nan], [0.0, 1.0]]]),
        np.full((1, 3, 2, 2), 0.5),
        np.full((1, 2, 2), 0.05),
    )
    footwork.write_contacts(tmp_path / "c.npz", made)
    found = footwork.read_contacts(tmp_path / "c.npz")
    assert all(np.array_equal(a, b, a.dtype.kind == "f") for a, b in _pairs(made, found))
    footwork.write_steps(tmp_path / "s.csv", STEPS)
    pd.testing.assert_frame_equal(footwork.read_steps(tmp_path / "s.csv"), STEPS, check_dtype=False)
    footwork.write_events(tmp_path / "e.csv", EVENTS)
    pd.testing.assert_frame_equal(
        footwork.read_events(tmp_path / "e.csv"), EVENTS, check_dtype=False
    )


def _pairs(one, other):
    return zip(vars(one).values(), vars(other).values(), strict=True)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"kind": "hop"}, "found kind hop"),
        ({"onset_s": "late"}, "found onset_s that is not a number"),
    ],
)
def test_a_damaged_table_of_steps_is_refused(tmp_path, change, words):
    STEPS.assign(**change).to_csv(tmp_path / "s.csv", index=False)
    with pytest.raises(InputError, match=rf"s\.csv: expected a table of steps, {words}"):
        footwork.read_steps(tmp_path / "s.csv")


def test_tables_without_rows_and_of_another_kind(tmp_path):
    footwork.write_events(tmp_path / "e.csv", EVENTS[:0])
    assert footwork.read_events(tmp_path / "e.csv").empty
    with pytest.raises(InputError, match="found no column"):
        footwork.read_steps(tmp_path / "e.csv")


def test_persons_called_by_digits_keep_their_names(tmp_path):
    footwork.write_steps(tmp_path / "s.csv", STEPS.assign(person="01"))
    footwork.write_events(tmp_path / "e.csv", EVENTS.assign(person="1"))
    assert footwork.read_steps(tmp_path / "s.csv")["person"].tolist() == ["01", "01"]
    assert footwork.read_events(tmp_path / "e.csv")["person"].tolist() == ["1"]
