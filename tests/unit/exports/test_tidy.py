"""The CSV against the record it was made from."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from courtside.exports import tidy
from courtside.records.keypoints import missing_reason
from fixtures.people import walker


def test_columns_and_values_are_the_records(tmp_path):
    record = walker.points(n_persons=2)
    tidy.write(tmp_path / "p2.csv", record, 1)
    rows = pd.read_csv(tmp_path / "p2.csv")
    assert list(rows.columns) == list(tidy.COLUMNS)
    assert len(rows) == 20 * 33
    assert set(rows.person) == {"p2"}
    at = rows[(rows.frame_idx == 6) & (rows.joint == "left_hip")].iloc[0]
    joint = record.joints.tolist().index("left_hip")
    np.testing.assert_allclose(
        at[["x_m", "y_m", "z_m"]].astype(float), record.xyz[1, 6, joint], atol=5e-6
    )
    np.testing.assert_allclose(at[["sd_x_mm", "sd_y_mm", "sd_z_mm"]].astype(float), [10, 20, 30])
    assert at.reproj_error_px == round(record.reproj_error_px[1, 6, joint].mean(), 2)
    assert (at.n_views, at.reason, at.time_s) == (3, "ok", 0.12)


def test_only_accepted_views_count_for_the_error():
    record = walker.points()
    rows = tidy.table(record, 0)
    error = rows[(rows.frame_idx == 5) & (rows.joint == record.joints[7])].reproj_error_px.item()
    assert error == round(record.reproj_error_px[0, 5, 7, [0, 2]].mean(), 2)


def test_missing_points_are_empty_and_say_why(tmp_path):
    record = walker.points()
    tidy.write(tmp_path / "p.csv", record, 0)
    line = (tmp_path / "p.csv").read_text().splitlines()[1 + 3 * 33 + 4]
    word = missing_reason.WORDS[missing_reason.REJECTED]
    assert line == f"3,0.06,p1,{record.joints[4]}" + 11 * "," + f"0,,{word}"


def test_every_column_is_explained_in_the_documentation():
    text = (Path(__file__).parents[3] / "docs" / "results.md").read_text()
    assert [name for name in tidy.COLUMNS if f"`{name}`" not in text] == []


def test_every_row_is_the_records(tmp_path):
    record = walker.points(n_persons=2)
    tidy.write(tmp_path / "p.csv", record, 1)
    with (tmp_path / "p.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    at = 0
    for frame in range(20):
        for joint, name in enumerate(record.joints):
            row, at = rows[at], at + 1
            assert (int(row["frame_idx"]), row["joint"]) == (frame, name)
            xyz = record.xyz[1, frame, joint]
            if np.isnan(xyz).any():
                assert [row[f"{axis}_m"] for axis in "xyz"] == ["", "", ""]
                continue
            assert [float(row[f"{axis}_m"]) for axis in "xyz"] == pytest.approx(xyz, abs=5.1e-6)
            assert int(row["n_views"]) == record.accepted[1, frame, joint].sum()
    assert at == len(rows)


def test_the_same_record_gives_the_same_bytes(tmp_path):
    for name in ("a.csv", "b.csv"):
        tidy.write(tmp_path / name, walker.points(), 0)
    content = (tmp_path / "a.csv").read_bytes()
    assert content == (tmp_path / "b.csv").read_bytes()
    assert b"\r" not in content
    assert [path.name for path in sorted(tmp_path.iterdir())] == ["a.csv", "b.csv"]


def test_every_reason_has_a_word():
    record = walker.points()
    reason = np.zeros_like(record.reason)
    reason[0, 0, : len(missing_reason.WORDS)] = list(missing_reason.WORDS)
    rows = tidy.table(replace(record, reason=reason), 0)
    assert rows.reason[: len(missing_reason.WORDS)].tolist() == list(missing_reason.WORDS.values())
    assert rows.reason.notna().all()
