"""Fewer views against more: known displacements, known gaps, coverage of the intervals."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.evaluation import camera_sets, joints
from courtside.statistics import moving_blocks
from fixtures.people import walker


def record(n_frames=40, n_persons=1):
    points = walker.points(n_frames, n_persons)
    return replace(points, xyz=np.nan_to_num(points.xyz, nan=1.0))


def moved(points, joint, offset_m, missing=()):
    xyz, at = points.xyz.copy(), points.joints.tolist().index(joint)
    xyz[:, :, at] += offset_m
    xyz[:, list(missing), at] = np.nan
    return replace(points, cameras=points.cameras[:2], xyz=xyz)


def test_the_table_states_a_known_displacement_and_gaps():
    base = record()
    two = moved(base, "left_knee", [0.03, 0.0, 0.04], missing=range(10))
    rows = camera_sets.compare({"two-robust": two, "all-robust": base}, "all-robust")
    assert set(rows["fusion"]) == {"two-robust"} and set(rows["reference"]) == {"all-robust"}
    assert rows["joint"].tolist()[:3] == ["limbs", "right half", "left half"]
    rows = rows.set_index("joint")
    knee = rows.loc["left_knee"]
    assert knee["median_mm"] == pytest.approx(50) and knee["p95_mm"] == pytest.approx(50)
    assert (knee["n"], knee["missing_percent"], knee["n_cameras"]) == (30, 25, 2)
    assert knee["cameras"] == "c0+c1"
    assert rows.loc["right half", "p95_mm"] == 0 and rows.loc["left half", "n"] == 230
    assert rows.loc["limbs", "missing_percent"] == pytest.approx(100 * 10 / 480)
    assert rows.loc["limbs", "exchanged_percent"] == 0


def test_joints_that_the_reference_lacks_do_not_count_as_missing():
    base = moved(record(), "left_knee", 0.0, missing=range(20))
    rows = camera_sets.compare(
        {"two-dlt": moved(record(), "left_knee", 0.0, missing=range(25)), "all-robust": base},
        "all-robust",
    ).set_index("joint")
    knee = rows.loc["left_knee"]
    assert (knee["reference_missing_percent"], knee["missing_percent"]) == (50, 25)


def test_exchanged_sides_are_counted_in_frames():
    base = record()
    xyz, mirror = base.xyz.copy(), np.array(walker.SKELETON.mirror())
    xyz[:, :10] = xyz[:, :10][:, :, mirror]
    rows = camera_sets.compare({"two": replace(base, xyz=xyz), "all": base}, "all")
    assert rows.set_index("joint").loc["limbs", "exchanged_percent"] == 25


def test_records_of_other_times_are_refused():
    base = record()
    with pytest.raises(ValueError, match="same time_s"):
        camera_sets.compare({"two": replace(base, time_s=base.time_s + 0.01), "all": base}, "all")


def test_a_gain_is_the_difference_over_places_that_both_have():
    rng = np.random.default_rng(0)
    other = rng.uniform(20, 60, (2, 300, 12))
    ours = other - 5.0
    # Ours leaves out all that is hard: over the places of both, it still gains 5 mm and no more.
    ours[other > 50] = np.nan
    row = camera_sets.gains({"r": ours, "d": other}, [("r", "d")], 30.0).iloc[0]
    for name in ("median", "p95"):
        assert row[f"{name}_mm"] == pytest.approx(-5)
        assert row[f"{name}_from_mm"] == pytest.approx(-5) == row[f"{name}_to_mm"]
    assert (row["n"], row["n_frames"]) == (np.isfinite(ours).sum(), 300)


def test_a_short_take_has_no_interval_and_an_empty_one_no_gain():
    one = np.ones((1, 100, 12))
    rows = camera_sets.gains(
        {"a": one, "b": 2 * one, "c": one * np.nan}, [("a", "b"), ("a", "c")], 30
    )
    assert rows["median_mm"].iloc[0] == -1 and np.isnan(rows["median_from_mm"].iloc[0])
    assert np.isnan(rows["median_mm"].iloc[1]) and rows["n"].iloc[1] == 0


def held(block_s, n_takes=60):
    """Return the share of intervals that hold the true median; errors last for half a second."""
    rng, inside = np.random.default_rng(2), 0
    for _ in range(n_takes):
        pieces = np.repeat(rng.normal(0, 10, 40), 15)[None, :, None]
        errors = {"a": pieces + rng.normal(0, 0.1, (1, 600, 1)), "b": np.zeros((1, 600, 1))}
        row = camera_sets.gains(errors, [("a", "b")], 30.0, block_s=block_s).iloc[0]
        inside += row["median_from_mm"] <= 0 <= row["median_to_mm"]
    return inside / n_takes


def test_intervals_are_as_wide_as_errors_that_last_make_them(monkeypatch):
    monkeypatch.setattr(moving_blocks, "REPLICATES", 200)
    # 20 blocks for a median: 90 % rather than 95 %. Resampling single frames would be far too
    # optimistic.
    assert 0.8 <= held(1.0) <= 1
    assert held(1 / 30) < 0.6


def test_limbs_are_those_of_the_evaluation():
    names = ["left_wrist", "right_wrist", "nose", "left_eye"]
    assert camera_sets._groups(names)["limbs"] == [0, 1]
    assert set(camera_sets.SETS) == set(joints.SETS)
