"""Gaps and filters against functions whose answer is known."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.kinematics import filtering
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.study.errors import InputError

RATE_HZ = 60.0


def record(xyz):
    """Return a Keypoints3D of one person from (T, J, 3), all values good."""
    n_frames, n_joints, _ = xyz.shape
    shape = (1, n_frames, n_joints)
    return Keypoints3D(
        cameras=np.array(["a", "b"]),
        model="m",
        joints=np.array([f"j{at}" for at in range(n_joints)]),
        person_id=np.array(["p1"]),
        time_s=np.arange(n_frames) / RATE_HZ,
        xyz=xyz[None].copy(),
        covariance_2d=np.broadcast_to(np.eye(3) * 1e-4, (*shape, 3, 3)).copy(),
        covariance_camera=np.full((*shape, 3, 3), np.nan),
        n_views=np.full(shape, 2),
        reproj_error_px=np.zeros((*shape, 2)),
        accepted=np.ones((*shape, 2), dtype=bool),
        swapped=np.zeros((*shape, 2), dtype=bool),
        reason=np.where(
            np.isnan(xyz[None, ..., 0]), missing_reason.REJECTED, missing_reason.OK
        ).astype(np.uint8),
    )


def wave(frequency_hz, n_frames=600):
    t = np.arange(n_frames) / RATE_HZ
    return np.stack([np.sin(2 * np.pi * frequency_hz * t)] * 3, axis=-1)[:, None, :]


@pytest.mark.parametrize("cutoff_hz", [4.0, 6.0, 10.0])
@pytest.mark.parametrize("order", [2, 4, 8])
def test_the_gain_at_the_cutoff_is_half_the_power(cutoff_hz, order):
    smoothed = filtering.smooth(record(wave(cutoff_hz)), [cutoff_hz], order)
    middle = smoothed.xyz[0, 200:400, 0, 0]
    assert np.sqrt(2 * np.mean(middle**2)) == pytest.approx(np.sqrt(0.5), abs=0.01)


def test_the_filter_has_no_delay():
    smoothed = filtering.smooth(record(wave(2.0)), [6.0], 4)
    ours, truth = smoothed.xyz[0, 120:480, 0, 0], wave(2.0)[120:480, 0, 0]
    lags = [np.dot(ours, np.roll(truth, lag)) for lag in (-1, 0, 1)]
    assert np.argmax(lags) == 1


def test_the_covariance_is_the_spread_of_filtered_noise():
    noise = np.random.default_rng(0).normal(0, 0.01, (20000, 1, 3))
    smoothed = filtering.smooth(record(noise), [6.0], 4)
    promised = np.sqrt(smoothed.covariance_2d[0, 0, 0, 0, 0])
    assert smoothed.xyz[0, 100:-100].std() == pytest.approx(promised, rel=0.05)


def test_a_parabola_is_kept():
    t = np.arange(300) / RATE_HZ
    xyz = np.stack([t**2, 2 * t, 1 + 0 * t], axis=-1)[:, None]
    smoothed = filtering.smooth(record(xyz), [6.0], 4)
    np.testing.assert_allclose(smoothed.xyz[0, 60:-60], xyz[60:-60], atol=2e-3)


def test_short_gaps_are_filled_and_marked_long_ones_left():
    xyz = wave(1.0)
    holed = xyz.copy()
    holed[100:106], holed[200:230], holed[:4] = np.nan, np.nan, np.nan
    filled = filtering.fill_gaps(record(holed), max_gap_s=0.1)
    np.testing.assert_allclose(filled.xyz[0, 100:106], xyz[100:106], atol=0.03)
    assert (filled.reason[0, 100:106] == missing_reason.INTERPOLATED).all()
    assert np.isnan(filled.xyz[0, 200:230]).all()
    assert np.isnan(filled.xyz[0, :4]).all()
    np.testing.assert_array_equal(filled.xyz[0, 6:100], xyz[6:100])


def test_runs_are_filtered_apart():
    xyz = wave(1.0)
    xyz[300] = np.nan
    xyz[301:] += 5
    smoothed = filtering.smooth(record(xyz), [6.0], 4)
    assert np.isnan(smoothed.xyz[0, 300]).all()
    assert np.abs(smoothed.xyz[0, :300] - xyz[:300]).max() < 0.1
    assert np.abs(smoothed.xyz[0, 301:] - xyz[301:]).max() < 0.1


def test_a_cutoff_above_half_the_rate_is_one_line():
    with pytest.raises(InputError, match=r"60 Hz.*found 40 Hz"):
        filtering.smooth(record(wave(1.0)), [40.0], 4)
    with pytest.raises(InputError, match="even number"):
        filtering.smooth(record(wave(1.0)), [6.0], 3)


def test_the_raw_record_is_not_touched():
    raw = record(wave(1.0))
    before = raw.xyz.copy()
    filtering.smooth(filtering.fill_gaps(raw, 0.1), [6.0], 4)
    np.testing.assert_array_equal(raw.xyz, before)


def test_frames_that_are_known_far_worse_than_the_rest_are_left_out():
    points = record(np.zeros((40, 3, 3)))
    points.covariance_2d[0, :5] *= 100  # two cameras from nearly one side: ten times the deviation
    points.covariance_2d[0, 20, 0] *= 10000  # one joint alone is no reason
    points.xyz[0, 2, 1] = np.nan
    found = filtering.leave_out_uncertain(points)
    assert np.isnan(found.xyz[0, :5]).all()
    assert np.isfinite(found.xyz[0, 5:]).all()
    assert (found.reason[0, :2] == missing_reason.UNCERTAIN).all()
    assert found.reason[0, 2, 1] == points.reason[0, 2, 1]  # missing for a reason of its own
    unknown = replace(points, covariance_2d=np.full_like(points.covariance_2d, np.nan))
    np.testing.assert_array_equal(filtering.leave_out_uncertain(unknown).xyz, points.xyz)
