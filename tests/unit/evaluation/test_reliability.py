"""How often ellipsoids hold: known scatter, known groups, known flags."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation import reliability
from fixtures.people import walker

SIGMA_M = 0.02


def made(scale=1.0, n_frames=500):
    """Return a record whose errors have a standard deviation of `scale` times the stated one."""
    points = walker.points(n_frames)
    xyz = np.nan_to_num(points.xyz, nan=1.0)
    covariance = np.broadcast_to(SIGMA_M**2 * np.eye(3), (*xyz.shape, 3)).copy()
    points = replace(points, xyz=xyz, covariance_2d=covariance)
    error = scale * SIGMA_M * np.random.default_rng(0).normal(size=xyz.shape)
    return points, xyz - error


def row(rows, by, group):
    return rows[(rows["by"] == by) & (rows["group"] == group)].iloc[0]


def test_held_shares_are_nominal_where_the_scatter_is_stated():
    points, true = made()
    rows = reliability.pooled(reliability.counts(points, points.joints.tolist(), true), [])
    whole = row(rows, "all", "limbs")
    assert whole["n"] == 12 * 500
    for level in reliability.LEVELS:
        assert whole[f"held_{level}_percent"] == pytest.approx(level, abs=2)
    assert set(rows[rows["by"] == "joint"]["group"]) == {
        *("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
    }
    assert row(rows, "joint", "elbow")["n"] == 1000


def test_groups_by_size_and_views_add_up():
    points, true = made(scale=3.0)
    points.n_views[:, :250] = 2
    points.n_views[:, 250:] = 7
    rows = reliability.counts(points, points.joints.tolist(), true)
    for by in ("joint", "error", "views"):
        part = rows[rows["by"] == by]
        for name in ("n", "held_90", "n_large"):
            assert part[name].sum() == row(rows, "all", "limbs")[name]
    assert set(rows[rows["by"] == "views"]["group"]) == {"2", "4"}
    distance_mm = 1000 * np.linalg.norm(points.xyz - true, axis=-1)
    limbs = [name in reliability.skeleton.JOINTS for name in points.joints]
    large = (distance_mm[..., limbs] > 100).sum()
    assert row(rows, "all", "limbs")["n_large"] == large > 0
    assert row(rows, "error", "100")["n"] + rows.query("group == '300'")["n"].sum() == large


def test_precision_and_recall_of_the_flag():
    points, true = made(n_frames=10)
    left = points.joints.tolist().index("left_wrist")
    true[:, :4, left, 0] += 0.5  # 4 large errors
    outlier = np.zeros(points.xyz.shape[:-1])
    outlier[:, 1:7, left] = 0.9  # 6 flagged, 3 of them large
    points = replace(points, outlier=outlier)
    rows = reliability.counts(points, points.joints.tolist(), true)
    whole = row(reliability.pooled(rows, []), "all", "limbs")
    assert whole["precision_percent"] == pytest.approx(50)
    assert whole["recall_percent"] == pytest.approx(75)
    ankle = row(reliability.pooled(rows, []), "joint", "ankle")
    assert np.isnan(ankle["precision_percent"]) and np.isnan(ankle["recall_percent"])


def test_tables_of_takes_add_up():
    points, true = made(n_frames=20)
    one = reliability.counts(points, points.joints.tolist(), true)
    rows = pd.concat([one.assign(stage="pose3d"), one.assign(stage="pose3d")])
    found = reliability.pooled(rows, ["stage"])
    assert row(found, "all", "limbs")["n"] == 2 * row(one, "all", "limbs")["n"]
    assert row(found, "all", "limbs")["held_90_percent"] == pytest.approx(
        100 * row(one, "all", "limbs")["held_90"] / row(one, "all", "limbs")["n"]
    )


def test_intervals_of_measures_hold_what_normal_errors_of_their_sigma_do():
    rng = np.random.default_rng(0)
    error, sigma = rng.normal(size=4000), np.ones(4000)
    error[:10], sigma[10:20] = np.nan, np.nan
    found = reliability.of_measures({"speed": (error, sigma), "angle": (2 * error, sigma)})
    rows = reliability.pooled(found, [])
    assert row(rows, "measure", "speed")["n"] == 3980
    for level in reliability.LEVELS:
        held = row(rows, "measure", "speed")[f"held_{level}_percent"]
        assert held == pytest.approx(level, abs=2)
    assert row(rows, "measure", "angle")["held_90_percent"] == pytest.approx(59, abs=2)
    points, true = made(n_frames=10)
    counted = reliability.counts(points, points.joints.tolist(), true)
    assert found.columns.tolist() == counted.columns.tolist()
