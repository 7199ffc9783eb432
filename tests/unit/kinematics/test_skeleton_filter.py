"""The filter of a whole take: what it keeps, what it removes, and the noise that it leaves."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.kinematics import filtering, skeleton_filter
from courtside.records.keypoints import missing_reason
from fixtures.people import footwork
from fixtures.people.waves import RATE_HZ, record, wave


@pytest.mark.parametrize("cutoff_hz", [4.0, 6.0, 10.0])
@pytest.mark.parametrize("order", [2, 4, 8])
def test_the_gain_at_the_cutoff_is_half_the_power(cutoff_hz, order):
    smoothed = skeleton_filter.smooth(record(wave(cutoff_hz)), [cutoff_hz], order)
    middle = smoothed.xyz[0, 200:400, 0, 0]
    assert np.sqrt(2 * np.mean(middle**2)) == pytest.approx(np.sqrt(0.5), abs=0.01)


def test_the_filter_has_no_delay():
    smoothed = skeleton_filter.smooth(record(wave(2.0)), [6.0], 4)
    ours, truth = smoothed.xyz[0, 120:480, 0, 0], wave(2.0)[120:480, 0, 0]
    lags = [np.dot(ours, np.roll(truth, lag)) for lag in (-1, 0, 1)]
    assert np.argmax(lags) == 1


def test_a_parabola_is_kept():
    t = np.arange(300) / RATE_HZ
    xyz = np.stack([t**2, 2 * t, 1 + 0 * t], axis=-1)[:, None]
    smoothed = skeleton_filter.smooth(record(xyz), [6.0], 4)
    np.testing.assert_allclose(smoothed.xyz[0, 60:-60], xyz[60:-60], atol=2e-3)


def test_runs_are_filtered_apart():
    xyz = wave(1.0)
    xyz[300] = np.nan
    xyz[301:] += 5
    smoothed = skeleton_filter.smooth(record(xyz), [6.0], 4)
    assert np.isnan(smoothed.xyz[0, 300]).all()
    assert np.abs(smoothed.xyz[0, :300] - xyz[:300]).max() < 0.1
    assert np.abs(smoothed.xyz[0, 301:] - xyz[301:]).max() < 0.1


def test_the_raw_record_is_not_touched():
    raw = record(wave(1.0))
    before = raw.xyz.copy()
    skeleton_filter.smooth(filtering.fill_gaps(raw, 0.1), [6.0], 4)
    np.testing.assert_array_equal(raw.xyz, before)


def slow_noise(n_frames, sigma_m, memory_s, seed):
    rng = np.random.default_rng(seed)
    return footwork.noise(n_frames, RATE_HZ, sigma_m, memory_s, rng)[:, None]


@pytest.mark.parametrize("cutoff_hz", [4.0, 10.0])
@pytest.mark.parametrize("memory_s", [0.0, 0.03, 0.1])
def test_the_covariance_is_the_spread_of_filtered_noise_that_is_correlated(memory_s, cutoff_hz):
    raw = record(slow_noise(20000, 0.01, memory_s, seed=0))
    smoothed = skeleton_filter.smooth(raw, [cutoff_hz], 4)
    promised = np.sqrt(smoothed.covariance_2d[0, 10000, 0, 0, 0])
    assert smoothed.xyz[0, 200:-200].std() == pytest.approx(promised, rel=0.06)


def test_the_covariance_grows_towards_the_ends_of_a_run():
    n_frames, draws = 300, []
    for seed in range(400):
        raw = record(slow_noise(n_frames, 0.01, 0.0, seed))
        draws.append(skeleton_filter.smooth(raw, [6.0], 4))
    found = np.std([one.xyz[0, :, 0] for one in draws], axis=(0, 2))
    promised = np.sqrt(np.mean([one.covariance_2d[0, :, 0, 0, 0] for one in draws], axis=0))
    assert found[0] > 1.5 * found[n_frames // 2]
    assert promised[0] == pytest.approx(found[0], rel=0.1)
    assert promised.mean() == pytest.approx(found.mean(), rel=0.1)


def test_a_filled_gap_has_a_place_and_no_covariance():
    raw = record(wave(1.0))
    raw.xyz[0, 100:105], raw.covariance_2d[0, 100:105] = np.nan, np.nan
    raw.reason[0, 100:105] = missing_reason.ONE_VIEW
    smoothed = skeleton_filter.smooth(skeleton_filter.prepare(raw, 0.1), [6.0], 4)
    assert np.isfinite(smoothed.xyz).all()
    assert (smoothed.reason[0, 100:105] == missing_reason.INTERPOLATED).all()
    assert np.isnan(smoothed.covariance_2d[0, 100:105]).all()
    assert np.isfinite(np.delete(smoothed.covariance_2d[0], np.arange(100, 105), axis=0)).all()


def test_uncertain_frames_do_not_reach_their_neighbours():
    raw = record(wave(1.0))
    raw.covariance_2d[0, 300:330] *= 100
    clean = skeleton_filter.smooth(skeleton_filter.prepare(raw, 0.1), [6.0], 4)
    raw.xyz[0, 300:330] += 5.0
    smoothed = skeleton_filter.smooth(skeleton_filter.prepare(raw, 0.1), [6.0], 4)
    assert (smoothed.reason[0, 300:330] == missing_reason.UNCERTAIN).all()
    assert np.isnan(smoothed.xyz[0, 300:330]).all()
    np.testing.assert_array_equal(smoothed.xyz, clean.xyz)


def test_skeletons_without_a_covariance_are_filtered_too():
    raw = record(wave(1.0))
    unknown = replace(raw, covariance_2d=np.full_like(raw.covariance_2d, np.nan))
    smoothed = skeleton_filter.smooth(unknown, [6.0], 4)
    np.testing.assert_array_equal(smoothed.xyz, skeleton_filter.smooth(raw, [6.0], 4).xyz)
    assert np.isnan(smoothed.covariance_2d).all()


@pytest.mark.parametrize("n_frames", [1, 2, 3])
def test_a_take_of_a_few_frames_has_a_skeleton(n_frames):
    raw = record(wave(1.0, n_frames))
    smoothed = skeleton_filter.smooth(skeleton_filter.prepare(raw, 0.1), [6.0], 4)
    assert np.isfinite(smoothed.xyz).all()


def test_a_large_error_of_the_network_is_stated_as_far_as_the_filter_spreads_it():
    still = record(np.zeros((121, 1, 3)))
    network = np.broadcast_to(1e-4 * np.eye(3), still.covariance_network.shape).copy()
    network[0, 60] = np.eye(3)
    still = replace(still, covariance_network=network)
    moved = still.xyz.copy()
    moved[0, 60, 0] = 1.0  # by as much as is stated there
    found = skeleton_filter.smooth(replace(still, xyz=moved), 6.0, 4)
    stated = np.sqrt(found.covariance_network[0, :, 0, 0, 0])
    assert (stated >= np.sqrt(network[0, :, 0, 0, 0]) - 1e-12).all() and stated[60] == 1
    # The filter's weights have both signs: the sum of their sizes is 1.2, not 1.
    assert (np.abs(found.xyz[0, :, 0, 0]) <= 1.2 * stated).all()
    np.testing.assert_allclose(stated[:30], 0.01, rtol=1e-2)
    unknown = skeleton_filter.smooth(record(np.zeros((30, 1, 3))), 6.0, 4)
    assert np.isnan(unknown.covariance_network).all()
