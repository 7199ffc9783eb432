"""Tables of measures keep labels and values, and joints are measured as geometry says."""

import numpy as np
import pandas as pd
import pytest

from courtside.statistics import longitudinal
from courtside.study.errors import InputError
from fixtures.people import walker

LABEL = {"session": "s", "take": "t1", "model": "net", "calibration": "file"}


def summary(path, value=2.0):
    table = pd.DataFrame(
        {
            "person": ["p1", "p1"],
            "measure": ["neck_distance", "knee_max"],
            "value": [value, 90.0],
            "sigma": [0.1, np.nan],
            "unit": ["m", "degrees"],
            "n": [9, 9],
            "definition": ["mid-shoulders", np.nan],
        }
    )
    table.to_csv(path, index=False)
    return path


def test_rows_carry_their_labels(tmp_path):
    paths = [summary(tmp_path / "a.csv"), summary(tmp_path / "b.csv", 3.0)]
    labels = [LABEL, LABEL | {"take": "t2", "date": "2024-05-01"}]
    rows = longitudinal.read(paths, labels)
    assert list(rows.columns) == longitudinal.COLUMNS
    assert rows["take"].tolist() == ["t1", "t1", "t2", "t2"]
    assert rows["date"].tolist() == ["", "", "2024-05-01", "2024-05-01"]
    assert rows["value"].tolist() == [2.0, 90.0, 3.0, 90.0]
    assert rows["subject"].unique().tolist() == ["p1"]
    assert rows["definition"].tolist()[:2] == ["mid-shoulders", ""]


def test_a_take_named_twice_and_a_table_without_units_are_refused(tmp_path):
    path = summary(tmp_path / "a.csv")
    with pytest.raises(InputError, match="found two of session s, take t1"):
        longitudinal.read([path, path], [LABEL, LABEL])
    pd.read_csv(path).drop(columns="unit").to_csv(path, index=False)
    with pytest.raises(InputError, match=r"a\.csv: expected the columns .* missing: \['unit'\]"):
        longitudinal.read([path], [LABEL])


def test_joints_are_measured_wherever_somebody_stands():
    points = walker.points(n_persons=1)
    left, wrist = (list(points.joints).index(f"left_{what}") for what in ("hip", "wrist"))
    right = list(points.joints).index("right_hip")
    time_s = points.time_s
    points.xyz[0, :, [left, right]] = np.stack(
        [0.3 * time_s, 0 * time_s, 0 * time_s + 0.9], axis=-1
    )
    points.xyz[0, :, wrist] = points.xyz[0, :, left] + [0.3, 0.0, 0.4]
    points.xyz[0, 7, wrist] = np.nan
    rows = longitudinal.of_joints(points, {"session": "s", "take": "t", "calibration": "file"})
    found = rows.set_index("measure")["value"]
    assert found["left_wrist_height_mean"] == pytest.approx(1300.0)
    assert found["left_wrist_reach_mean"] == pytest.approx(500.0)
    assert found["left_wrist_speed_mean"] == pytest.approx(0.3)
    assert set(rows["model"]) == {"blazepose-full"}
    turned = points.xyz @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]) + [5.0, -3.0, 0.0]
    points.xyz[:] = turned
    again = longitudinal.of_joints(points, {"session": "s", "take": "t", "calibration": "file"})
    np.testing.assert_allclose(again["value"], rows["value"])
