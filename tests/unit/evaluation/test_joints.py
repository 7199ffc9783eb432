"""Errors against truth: of known displacements, with known covariances."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.evaluation import joints as pose_errors
from fixtures.people import walker


def record(n_frames=40, n_persons=1, **changes):
    points = walker.points(n_frames, n_persons)
    whole = np.nan_to_num(points.xyz, nan=1.0)
    return replace(points, xyz=whole, **changes)


def test_truth_between_its_times_is_that_of_a_cubic_path():
    time_s = np.linspace(0, 2, 21)
    place = np.stack([time_s**3, 1 - time_s, 0 * time_s], axis=1)[None, :, None]
    found = pose_errors.at_times(time_s, place, np.array([0.333, 1.777, 2.1]))
    np.testing.assert_allclose(found[0, :2, 0, 0], [0.333**3, 1.777**3], atol=1e-9)
    assert np.isnan(found[0, 2]).all()


def test_a_displacement_is_what_the_table_says():
    points = record()
    joints = ["left_wrist", "right_wrist", "nose", "tail"]
    at = [points.joints.tolist().index(name) for name in joints[:3]]
    true = np.concatenate([points.xyz[:, :, at], np.zeros((1, 40, 1, 3))], axis=2)
    true[:, :, 0] -= [0.03, 0, 0.04]
    true[:, :10, 1] = np.nan
    names, error, covariance = pose_errors.errors(points, joints, true)
    assert names == ["nose", "left_wrist", "right_wrist"]
    rows = pose_errors.table(["p1"], names, error, covariance).set_index("joint")
    wrist = rows.loc["left_wrist"]
    assert wrist["median_mm"] == pytest.approx(50) and wrist["p95_mm"] == pytest.approx(50)
    assert (wrist["bias_x_mm"], wrist["bias_z_mm"]) == (pytest.approx(30), pytest.approx(40))
    assert rows.loc["right_wrist", ["n", "missing_percent"]].tolist() == [30, 25]
    assert rows.loc["limbs", "n"] == 70 and rows.loc["limbs", "missing_percent"] == 12.5
    assert rows.loc["left half", "mean_mm"] == pytest.approx(50)
    assert rows.loc["right half", "median_mm"] == pytest.approx(0)


def test_coverage_is_that_of_the_covariance_the_errors_are_drawn_from():
    rng = np.random.default_rng(0)
    points = record(4000)
    spread = np.array([[4, 1, 0], [1, 9, 2], [0, 2, 16]]) * 1e-4
    camera = np.diag([1, 2, 3.0]) * 1e-4
    shape = (*points.xyz.shape, 3)
    points = replace(
        points,
        covariance_2d=np.broadcast_to(spread, shape),
        covariance_camera=np.broadcast_to(camera, shape),
    )
    true = points.xyz - rng.multivariate_normal(np.zeros(3), spread + camera, points.xyz.shape[:3])
    rows = pose_errors.table(
        ["p1"], *pose_errors.errors(points, points.joints.tolist(), true)
    ).set_index("joint")
    found = rows.loc["left_knee"]
    assert found["coverage_50_percent"] == pytest.approx(50, abs=3)
    assert found["coverage_90_percent"] == pytest.approx(90, abs=2)
    assert found["coverage_95_percent"] == pytest.approx(95, abs=1.5)
    assert found["sigma_mm"] == pytest.approx(1000 * np.sqrt(35e-4), rel=1e-6)
    assert found["rms_mm"] == pytest.approx(found["sigma_mm"], rel=0.05)


def test_bias_and_scatter_are_told_apart():
    rng = np.random.default_rng(1)
    points = record(4000)
    true = points.xyz - np.array([0.03, 0, -0.04]) - rng.normal(0, 0.02, points.xyz.shape)
    rows = pose_errors.table(["p1"], *pose_errors.errors(points, points.joints.tolist(), true))
    row = rows.set_index("joint").loc["left_knee"]
    assert row["bias_mm"] == pytest.approx(50, abs=2)
    assert row["sd_mm"] == pytest.approx(20 * np.sqrt(3), rel=0.03)
    assert row["rms_mm"] ** 2 == pytest.approx(row["bias_mm"] ** 2 + row["sd_mm"] ** 2)


def test_without_a_covariance_nothing_is_said_of_coverage():
    points = record()
    points = replace(points, covariance_2d=np.full((*points.xyz.shape, 3), np.nan))
    names, error, covariance = pose_errors.errors(points, ["nose"], points.xyz[:, :, :1])
    row = pose_errors.table(["p1"], names, error, covariance).iloc[0]
    assert np.isnan(row["coverage_90_percent"]) and row["median_mm"] == 0


def test_exchanged_persons_are_counted():
    points = record(40, n_persons=2)
    true = points.xyz.copy()
    swapped = points.xyz.copy()
    swapped[:, :10] = swapped[::-1, :10]
    assert pose_errors.identity_percent(points, points.joints.tolist(), true).tolist() == [100, 100]
    mixed = replace(points, xyz=swapped)
    assert pose_errors.identity_percent(mixed, points.joints.tolist(), true).tolist() == [75, 75]
    lost = replace(points, xyz=np.where(np.arange(2)[:, None, None, None] == 1, np.nan, swapped))
    percent = pose_errors.identity_percent(lost, points.joints.tolist(), true)
    assert percent[0] == 75 and np.isnan(percent[1])
    rows = pose_errors.table(["p1", "p2"], *pose_errors.errors(mixed, points.joints.tolist(), true))
    assert set(rows["person"]) == {"p1", "p2", "all"}
