"""The table of joint angles: persons and sides taken together."""

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation.tables import angles

LABELS = {"session": "s", "take": "t", "calibration": "c", "model": "net", "fusion": "all-robust"}


def row(person, angle, n, bias, rmse, within, stage="pose3d"):
    about = {**LABELS, "stage": stage, "person": person, "angle": angle, "n": n}
    found = {"bias_deg": bias, "rmse_deg": rmse, "p95_deg": 2 * rmse, "sigma_deg": 3.0}
    return {**about, "missing_percent": 0.0, **found, "within_90_percent": within}


def test_persons_are_weighted_with_their_frames_and_single_sides_left_out():
    rows = pd.DataFrame(
        [
            row("p1", "knee_flexion", 300, -4.0, 5.0, 40.0),
            row("p2", "knee_flexion", 100, 0.0, 1.0, 80.0),
            row("p1", "left_knee_flexion", 150, 9.0, 9.0, 0.0),
        ]
    )
    (found,) = angles.table(rows).to_dict("records")
    assert (found["stage"], found["n_persons"], found["n"]) == ("raw", 2, 400)
    assert found["bias_deg"] == pytest.approx(-3)
    assert found["rmse_deg"] == pytest.approx(np.sqrt(0.75 * 25 + 0.25))
    assert found["within_90_percent"] == pytest.approx(50)
    assert found["p95_deg"] == 10


def test_a_person_without_angles_counts_nothing(tmp_path):
    path = tmp_path / "angles.csv"
    empty = row("p2", "trunk_lean", 0, np.nan, np.nan, np.nan)
    pd.DataFrame([row("p1", "trunk_lean", 9, 1.0, 2.0, 90.0), empty]).to_csv(path, index=False)
    (found,) = angles.table(angles.read([path])).to_dict("records")
    assert (found["n"], found["bias_deg"], found["n_persons"]) == (9, 1.0, 2)
