"""Joints against a marker system: clock, motion and scale found as they are; errors as made."""

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

sys.path.append(str(Path(__file__).parents[1] / "benchmarks"))  # last, as in `test_benchmarks.py`
import marker_system
from courtside.study.errors import InputError

NAMES = list(marker_system.JOINTS)
RATE_HZ = 12.0
TURN = Rotation.from_euler("zyx", [70, 5, -3], degrees=True).as_matrix()
SHIFT = np.array([3.0, -2.0, 0.4])


def true_motion(seconds=6.0, rate_hz=100.0):
    """Return times (U,) from 79 s and ten joints (U, J, 3) m of somebody who walks and turns."""
    time_s = np.arange(0, seconds, 1 / rate_hz)
    rng = np.random.default_rng(3)
    body = rng.uniform([-0.3, -0.2, 0], [0.3, 0.2, 1.6], (len(NAMES), 3))
    phase, amount = rng.uniform(0, 6, (2, len(NAMES), 3)), 0.25
    swing = amount * np.sin(4 * time_s[:, None, None] + phase[0])
    path = np.stack([np.sin(time_s), np.cos(1.3 * time_s), 0 * time_s], axis=-1)
    return 79 + time_s, body + swing + path[:, None]


def measured(offset_s=0.21, scale=1.0, noise_m=0.0, seconds=4.0, seed=0):
    """Return the same joints at other times, in another frame, with errors."""
    time_s, xyz = true_motion(seconds=8.0)
    own_s = np.arange(0, seconds, 1 / RATE_HZ)
    at = np.stack(
        [np.interp(own_s + offset_s, time_s - 79, one) for one in xyz.reshape(len(xyz), -1).T],
        axis=-1,
    ).reshape(len(own_s), len(NAMES), 3)
    noise = np.random.default_rng(seed).normal(0, noise_m, at.shape)
    return own_s, (scale * at + noise) @ TURN.T + SHIFT


def test_clock_and_motion_are_found():
    found = marker_system.fit(*measured(), *true_motion())
    assert found.shift_s == pytest.approx(79.21, abs=2e-3)
    np.testing.assert_allclose(found.truth_from_world.rotation, TURN.T, atol=1e-3)
    assert found.truth_from_world.scale == 1 and found.scale == pytest.approx(1, abs=1e-3)
    assert np.nanmax(np.linalg.norm(found.error, axis=-1)) < 3e-3


def test_the_scale_is_stated_and_not_taken_away():
    found = marker_system.fit(*measured(scale=1.03), *true_motion())
    assert found.scale == pytest.approx(1.03, abs=2e-3)
    assert np.nanmedian(np.linalg.norm(found.error, axis=-1)) > 0.005


def test_a_joint_that_is_far_off_hardly_moves_the_others():
    time_s, xyz = measured()
    xyz[:, NAMES.index("left_wrist")] += [0.4, 0, 0]
    found = marker_system.fit(time_s, xyz, *true_motion())
    away = np.linalg.norm(found.error, axis=-1)
    assert np.median(away[:, NAMES.index("left_wrist")]) == pytest.approx(0.4, abs=0.01)
    assert np.median(np.delete(away, NAMES.index("left_wrist"), axis=1)) < 0.01


def test_frames_without_truth_are_no_missing_joints():
    found = marker_system.fit(*measured(offset_s=-0.3), *true_motion(seconds=3.0))
    assert found.shift_s == pytest.approx(79 - 0.3, abs=5e-3)
    assert not found.known[:3].any() and found.known[4:30].all()
    covariance = np.full((*found.error.shape, 3), np.nan)
    every = marker_system.table(NAMES, found, covariance, RATE_HZ).iloc[0]
    assert every["missing_percent"] == 0 and every["n"] == 10 * found.known.sum()


def test_times_that_never_meet_are_refused():
    time_s, xyz = measured()
    with pytest.raises(InputError, match="truth: expected joints at the take's times"):
        marker_system.fit(time_s, xyz, *true_motion(seconds=0.5))


def test_the_table_gives_errors_coverage_missing_and_intervals():
    sigma = 0.02
    time_s, xyz = measured(noise_m=sigma, seconds=6.0)
    xyz[5:11, 2] = np.nan
    found = marker_system.fit(time_s, xyz, *true_motion(seconds=8.0))
    covariance = np.broadcast_to(sigma**2 * np.eye(3), (*found.error.shape, 3))
    table = marker_system.table(NAMES, found, covariance, RATE_HZ, [NAMES[2]]).set_index("joint")
    sure = table.loc[f"all but {NAMES[2]}"]
    assert sure["missing_percent"] == 0 and sure["n"] == 9 * len(time_s)
    every = table.loc[marker_system.ALL]
    assert every["median_mm"] == pytest.approx(1000 * 1.538 * sigma, rel=0.05)
    assert every["coverage_90_percent"] == pytest.approx(90, abs=3)
    assert every["median_from_mm"] < every["median_mm"] < every["median_to_mm"]
    assert every["p90_from_mm"] < every["p90_mm"] < every["p90_to_mm"]
    assert table.loc[NAMES[2], "missing_percent"] == pytest.approx(100 * 6 / len(time_s))
    assert table.loc[NAMES[3], "missing_percent"] == 0


def test_intervals_are_wider_where_errors_last():
    time_s, xyz = measured(seconds=6.0)
    rng = np.random.default_rng(0)
    shape = (len(time_s), 10, 3)
    quick = rng.normal(0, 0.03, shape)
    lasting = np.repeat(rng.normal(0, 0.03, (len(time_s) // 6, 10, 3)), 6, axis=0)
    widths = []
    for error in (quick, lasting):
        found = marker_system.fit(time_s, xyz + error, *true_motion(seconds=8.0))
        row = marker_system.table(NAMES, found, np.full((*shape, 3), np.nan), RATE_HZ).iloc[0]
        widths.append(row["median_to_mm"] - row["median_from_mm"])
    assert widths[1] > widths[0]
