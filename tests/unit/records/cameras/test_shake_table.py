"""The table of a camera's shake: what is written is read, what is none is refused in one line."""

import numpy as np
import pandas as pd
import pytest

from courtside.records.cameras import shake_table
from courtside.study.errors import InputError


@pytest.fixture
def table():
    rng = np.random.default_rng(0)
    table = pd.DataFrame(rng.normal(0, 2, (5, 4)), columns=list(shake_table.MEASURED[:4]))
    table["sigma_px"] = 0.04
    table["n_matches"] = [200, 190, 3, 180, 185]
    table["frame_idx"] = np.arange(5) + 7
    table["time_s"] = table.frame_idx / 30
    table.loc[2, list(shake_table.MEASURED)] = np.nan
    return table


def test_what_is_written_is_read(tmp_path, table):
    shake_table.write(tmp_path / "t.csv", table)
    found = shake_table.read(tmp_path / "t.csv")
    assert list(found.columns) == list(shake_table.DECIMALS)
    np.testing.assert_allclose(found, table[found.columns], atol=6e-5)
    assert found.frame_idx.dtype == found.n_matches.dtype == int


def test_tables_of_a_take_are_named_by_their_cameras(tmp_path, table):
    for name, shift_px in (("back", 1.0), ("mirror", 2.0)):
        known = table[:2].assign(shift_x_px=shift_px)
        shake_table.write(tmp_path / f"{name}.csv", known)
    found = shake_table.read_all([tmp_path / "mirror.csv", tmp_path / "back.csv"])
    assert {name: t.shift_x_px[0] for name, t in found.items()} == {"mirror": 2.0, "back": 1.0}
    assert shake_table.read_all([]) == {}


def test_a_take_of_which_nothing_is_known_is_read(tmp_path, table):
    table[list(shake_table.MEASURED)] = np.nan
    shake_table.write(tmp_path / "t.csv", table)
    assert shake_table.read(tmp_path / "t.csv").shift_x_px.dtype == float


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda t: t.drop(columns="sigma_px"), "no column sigma_px"),
        (lambda t: t[:0], "no frame"),
        (lambda t: t[::-1], "not in order"),
        (lambda t: t.assign(time_s=1.0), "not in order"),
        (lambda t: t.assign(shift_x_px=1.0), "only in part"),
        (lambda t: t.assign(zoom_percent=np.inf), "only in part"),
        (lambda t: t.assign(sigma_px=-t.sigma_px), "below 0"),
        (lambda t: t.assign(rotation_deg="x"), "rotation_deg that is not a number"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path, table, change, words):
    changed = change(table)
    with pytest.raises(ValueError, match=words):
        shake_table.write(tmp_path / "t.csv", changed)
    changed.to_csv(tmp_path / "t.csv", index=False)
    with pytest.raises(InputError, match=words) as error:
        shake_table.read(tmp_path / "t.csv")
    assert "\n" not in str(error.value) and "t.csv" in str(error.value)


def test_a_missing_file_is_a_fault_in_one_line(tmp_path):
    with pytest.raises(InputError, match=r"t\.csv"):
        shake_table.read(tmp_path / "t.csv")
