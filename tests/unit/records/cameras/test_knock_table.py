"""Knocks are written as they are found; those taken are read by take and camera."""

import numpy as np
import pytest

from courtside.records.cameras import knock_table
from courtside.study.errors import InputError

ROW = {
    "take": "rally",
    "camera": "c1",
    "time_s": 2.5,
    "turn_x_deg": 0.3,
    "turn_y_deg": -0.2,
    "turn_z_deg": 0.1,
    **dict.fromkeys(knock_table.SIGMA, 0.02),
    "joints_percent": -31.0,
    "joints": "better",
    "taken": 1,
    "after": "",
}


def test_what_was_taken_is_read_of_its_take_and_camera(tmp_path):
    rows = [ROW, ROW | {"taken": 0, "time_s": 3.0}, ROW | {"take": "shot"}, ROW | {"camera": "c2"}]
    knock_table.write(tmp_path / "knocks.csv", rows)
    ((time_s, turn),) = knock_table.read(tmp_path / "knocks.csv", "rally", "c1")
    assert time_s == 2.5
    np.testing.assert_allclose(turn, np.radians([0.3, -0.2, 0.1]), atol=1e-8)


def test_no_knock_is_an_empty_table_and_another_table_is_refused(tmp_path):
    knock_table.write(tmp_path / "knocks.csv", [])
    assert knock_table.read(tmp_path / "knocks.csv", "rally", "c1") == []
    (tmp_path / "other.csv").write_text("take,camera\nrally,c1\n", encoding="utf-8")
    with pytest.raises(InputError, match="a table of knocks, found no column time_s"):
        knock_table.read(tmp_path / "other.csv", "rally", "c1")


def test_takes_and_cameras_may_be_called_by_digits(tmp_path):
    knock_table.write(tmp_path / "knocks.csv", [ROW | {"take": "01", "camera": "1"}])
    assert len(knock_table.read(tmp_path / "knocks.csv", "01", "1")) == 1
