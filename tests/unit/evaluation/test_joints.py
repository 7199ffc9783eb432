"""Errors of joints against known truths: shifts, scatter, interpolation, gaps, left-out views."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import chi2

from courtside.evaluation import joints as pose_errors
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import derived_joints
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import keypoints_made, true_motion, walker


def record(n_frames=40, n_persons=1, **changes):
    points = walker.points(n_frames, n_persons)
    whole = np.nan_to_num(points.xyz, nan=1.0)
    return replace(points, xyz=whole, **changes)


def test_truth_is_interpolated_along_a_cubic_path():
    time_s = np.linspace(0, 2, 21)
    place = np.stack([time_s**3, 1 - time_s, 0 * time_s], axis=1)[None, :, None]
    found = pose_errors.at_times(time_s, place, np.array([0.333, 1.777, 2.1]))
    np.testing.assert_allclose(found[0, :2, 0, 0], [0.333**3, 1.777**3], atol=1e-9)
    assert np.isnan(found[0, 2]).all()


def test_the_table_states_a_known_displacement():
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


def test_large_errors_are_counted_by_themselves():
    points, sigma_m = record(100), 0.03
    spread = np.broadcast_to(sigma_m**2 * np.eye(3), (*points.xyz.shape, 3))
    true, at = points.xyz.copy(), points.joints.tolist().index("left_knee")
    true[0, :10, at, 0] += 0.05  # 1.7 standard deviations: inside, not large
    true[0, 10:30, at, 0] += 0.3  # outside
    network = np.zeros_like(spread)
    network[0, 25:30, at] = 0.2**2 * np.eye(3)  # said to be so: inside
    points = replace(points, covariance_2d=spread, covariance_network=network)
    rows = pose_errors.table(["p1"], *pose_errors.errors(points, points.joints.tolist(), true))
    row = rows.set_index("joint").loc["left_knee"]
    assert (row["n_large"], row["coverage_90_large_percent"]) == (20, 25)
    assert row["coverage_90_percent"] == 85


def test_bias_and_scatter_are_separated():
    rng = np.random.default_rng(1)
    points = record(4000)
    true = points.xyz - np.array([0.03, 0, -0.04]) - rng.normal(0, 0.02, points.xyz.shape)
    rows = pose_errors.table(["p1"], *pose_errors.errors(points, points.joints.tolist(), true))
    row = rows.set_index("joint").loc["left_knee"]
    assert row["bias_mm"] == pytest.approx(50, abs=2)
    assert row["sd_mm"] == pytest.approx(20 * np.sqrt(3), rel=0.03)
    lengths = 20 * np.sqrt(chi2.ppf([0.5, 0.95], df=3))
    assert row["unbiased_median_mm"] == pytest.approx(lengths[0], rel=0.05)
    assert row["unbiased_p95_mm"] == pytest.approx(lengths[1], rel=0.05)
    assert row["rms_mm"] ** 2 == pytest.approx(row["bias_mm"] ** 2 + row["sd_mm"] ** 2)


def test_without_a_covariance_coverage_is_empty():
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


DERIVED = derived_joints.read(Path(__file__).parents[3] / "config" / "derived_joints.yaml")


def moving(time_s, joints):
    """Return (T, J, 3): joints that move at constant speed, so that interpolation is exact."""
    base = np.arange(len(joints))[:, None] * [0.01, 0.02, 0.03]
    return base + np.array([0.5, -0.2, 0.1]) * np.asarray(time_s)[:, None, None]


def take(shift_m):
    points = walker.points(n_persons=2, n_frames=40)
    points.xyz[0] = moving(points.time_s, points.joints) + shift_m
    return points


def truth(points, first_s=-0.1, last_s=1.0):
    """Return a truth at 100 Hz of both persons, joints and persons in another order."""
    time_s = np.arange(first_s, last_s, 0.01)
    real = moving(time_s, points.joints)[:, ::-1]
    return true_motion.Truth(
        points.joints[::-1], points.person_id[::-1], time_s, np.stack([real + 7.0, real])
    )


def test_a_constant_shift_is_found_at_any_time():
    points = take([0.03, 0.0, 0.04])
    points.xyz[0, 20, 3] = np.nan
    error = pose_errors.distance_to_truth(points, truth(points))
    assert np.isnan(error[0, 20, 3])
    known = np.isfinite(points.xyz[0, ..., 0])
    assert known.sum() == known.size - 1
    np.testing.assert_allclose(error[0][known], 50.0, atol=1e-9)
    assert np.nanmin(error[1]) > 1000.0
    limbs = pose_errors.limb_distances(points, truth(points))
    names = points.joints.tolist()
    np.testing.assert_array_equal(limbs[..., 0], error[..., names.index("left_shoulder")])
    assert limbs.shape == (*error.shape[:2], 12)


def test_errors_are_empty_outside_the_truth_and_for_joints_it_lacks():
    points = take(0.0)
    real = truth(points, 0.2, 0.5)
    real = true_motion.Truth(real.joints[:-2], real.person_id, real.time_s, real.xyz[:, :, :-2])
    error = pose_errors.distance_to_truth(points, real)
    inside = (points.time_s >= 0.2) & (points.time_s <= real.time_s[-1])
    assert np.isfinite(error[0, inside, 2:]).all()
    assert np.isnan(error[:, ~inside]).all()
    assert np.isnan(error[:, :, :2]).all()


def test_a_truth_of_other_persons_is_refused():
    points = take(0.0)
    real = truth(points)
    real = true_motion.Truth(real.joints, np.array(["x", "y"]), real.time_s, real.xyz)
    with pytest.raises(InputError, match=r"found \['x', 'y'\]"):
        pose_errors.distance_to_truth(points, real)


def test_truth_is_derived_only_for_joints_with_the_same_definition():
    points = take(0.0)
    real = truth(points)
    longer = pose_errors.derive_truth(real, DERIVED, "blazepose33", ["neck", "head_centre"])
    shoulders = [list(real.joints).index(f"{side}_shoulder") for side in ("left", "right")]
    neck = longer.xyz[:, :, list(longer.joints).index("neck")]
    np.testing.assert_allclose(neck, real.xyz[:, :, shoulders].mean(axis=2))
    assert len(longer.joints) == len(real.joints) + 2
    assert pose_errors.derive_truth(real, DERIVED, "cpm14", ["neck", "head_centre"]) is real


def test_a_view_that_was_left_out_is_compared_person_by_person():
    """The second person is detected where the first one is: that is her error, not the first's."""
    points, cameras = walker.points(n_persons=2, n_frames=40), scene.ring(4)
    xy = np.stack(
        [
            scene.opencv_projection(cameras[3], xyz.reshape(-1, 3)).reshape(40, -1, 2)
            for xyz in points.xyz
        ]
    )
    seen = np.stack([xy[0] + [0.0, 3.0], xy[0]])
    seen[0, :10] = np.nan
    view = keypoints_made.view(cameras[3], points.joints, points.time_s + 0.25, seen)
    error = pose_errors.distance_to_unused_view(points, cameras[3], view, Clock(offset_s=0.25))
    assert np.isnan(error[0, :10]).all()
    known = np.isfinite(points.xyz[..., 0])
    np.testing.assert_allclose(error[0, 10:][known[0, 10:]], 3.0, atol=1e-6)
    between = np.linalg.norm(xy[1] - xy[0], axis=-1)
    np.testing.assert_allclose(error[1][known[1]], between[known[1]], atol=1e-6)
