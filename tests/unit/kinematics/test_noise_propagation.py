"""Gains of filters and derivatives against made-up noise, and the noise found in made-up paths."""

import tracemalloc

import numpy as np
import pytest

from courtside.kinematics import filtering, noise_propagation
from courtside.kinematics.noise_propagation import Noise
from fixtures.people import footwork

WHITE = Noise(0.0)
N_LINES = 400


def lines(n_frames, rate_hz, noise):
    """Return (T, 400) lines of noise of variance 1."""
    rng = np.random.default_rng(0)
    root = np.linalg.cholesky(noise_propagation.correlation(n_frames, rate_hz, noise))
    return root @ rng.normal(size=(n_frames, N_LINES))


def test_noise_forgets_as_stated():
    made = footwork.noise(200_000, 50, 1.0, 0.1, np.random.default_rng(0))
    stated = noise_propagation.correlation(30, 50, Noise(0.1))[0]
    for lag in (0, 5, 20):
        found = np.mean(made[: len(made) - lag] * made[lag:])
        assert found == pytest.approx(stated[lag], abs=0.02)


@pytest.mark.parametrize(
    "noise", [WHITE, Noise(0.1), Noise(0.3, 0.5)], ids=["white", "slow", "mixed"]
)
@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_the_gain_is_the_variance_of_what_is_left_ends_included(noise, derivative):
    rate_hz, n_frames = 30.0, 60
    left = filtering.zero_lag(lines(n_frames, rate_hz, noise), rate_hz, 6.0, 4)
    for _ in range(derivative):
        left = noise_propagation.differentiate(left, rate_hz)
    stated = noise_propagation.gains(n_frames, rate_hz, 6.0, 4, noise, derivative)
    found = np.mean(left**2, axis=1)
    assert np.mean(found / stated) == pytest.approx(1.0, abs=0.03)
    np.testing.assert_allclose(found, stated, rtol=0.35)


def test_the_correlation_of_filtered_noise():
    noise = Noise(0.1)
    left = filtering.zero_lag(lines(400, 30.0, noise), 30.0, 6.0, 4)[20:-20]
    left = noise_propagation.differentiate(left, 30.0)[5:-5]
    stated = noise_propagation.autocorrelation(12, 30.0, 6.0, 4, noise, 1)
    found = [np.mean(left[: len(left) - lag] * left[lag:]) for lag in range(12)]
    np.testing.assert_allclose(found / found[0], stated, atol=0.02)


def test_slow_noise_passes_the_filter_and_white_noise_does_not():
    white, slow = (
        noise_propagation.gains(200, 60.0, 6.0, 4, n, 0)[100] for n in (WHITE, Noise(1.0))
    )
    assert white == pytest.approx(2 * 6 / 60, rel=0.15)  # the share of the band, about
    assert slow > 0.95


def test_runs_too_short_for_the_filter_have_their_own_gain():
    for n_frames in (3, 4, 7, 12):
        stated = noise_propagation.gains(n_frames, 30.0, 2.0, 4, WHITE, 1)
        left = filtering.zero_lag(lines(n_frames, 30.0, WHITE), 30.0, 2.0, 4)
        found = np.mean(noise_propagation.differentiate(left, 30.0) ** 2, axis=1)
        assert len(stated) == n_frames
        np.testing.assert_allclose(found, stated, rtol=0.35)


def test_the_derivative_of_a_wave_is_exact_where_bodies_move():
    rate_hz = 60.0
    t = np.arange(600) / rate_hz
    for share, error in ((0.1, 0.001), (0.2, 0.02)):
        omega = 2 * np.pi * share * rate_hz
        found = noise_propagation.differentiate(np.sin(omega * t)[:, None], rate_hz)[100:-100, 0]
        assert np.abs(found - omega * np.cos(omega * t)[100:-100]).max() < error * omega
    assert np.isnan(noise_propagation.differentiate(np.zeros((2, 3)), rate_hz)).all()


def test_many_series_have_the_derivatives_of_each_and_need_little_memory():
    lines = np.random.default_rng(0).normal(size=(2000, 150)).cumsum(axis=0)
    lines[700:720] = np.nan
    noise_propagation.differentiate(lines[:, :1], 60.0)  # imports
    tracemalloc.start()
    found = noise_propagation.differentiate(lines, 60.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 3 * lines.nbytes  # a spline of all has eight times as much
    for at in (0, 15, 16, 149):
        alone = noise_propagation.differentiate(lines[:, at : at + 1], 60.0)[:, 0]
        np.testing.assert_array_equal(found[:, at], alone)


def test_a_covariance_that_changes_is_averaged_over_the_reach_of_the_filter():
    rate_hz, n_frames = 30.0, 120
    rng = np.random.default_rng(3)
    sigma = 1 + 0.8 * np.sin(2 * np.pi * np.arange(n_frames) / 30)
    left = filtering.zero_lag(rng.normal(size=(n_frames, 3000)) * sigma[:, None], rate_hz, 6.0, 4)
    covariance = np.eye(3) * (sigma**2)[:, None, None]
    stated = noise_propagation.filtered_covariance(
        covariance, np.ones(n_frames, bool), WHITE, rate_hz, 6.0, 4
    )[:, 0, 0]
    np.testing.assert_allclose(left.var(axis=1)[10:-10], stated[10:-10], rtol=0.15)


def test_frames_without_a_covariance_take_that_of_their_neighbours_and_gaps_have_none():
    covariance = np.broadcast_to(np.eye(3) * 4.0, (100, 3, 3)).copy()
    covariance[40:43] = np.nan
    known = np.ones(100, bool)
    known[70:80] = False
    found = noise_propagation.filtered_covariance(covariance, known, WHITE, 30.0, 6.0, 4)[:, 0, 0]
    middle = 4.0 * noise_propagation.gains(100, 30.0, 6.0, 4, WHITE, 0)[50]
    np.testing.assert_allclose(found[30:50], middle, rtol=1e-6)
    assert np.isnan(found[70:80]).all()
    assert found[69] > 1.5 * middle  # an end of a run
    covariance[:] = np.nan
    assert np.isnan(
        noise_propagation.filtered_covariance(covariance, known, WHITE, 30.0, 6.0, 4)
    ).all()


@pytest.mark.parametrize("rate_hz", [30.0, 60.0])
@pytest.mark.parametrize("memory_s", [0.0, 0.03, 0.1, 0.3])
def test_the_noise_of_a_player_is_found_again_as_far_as_it_matters(rate_hz, memory_s):
    _, path = footwork.neck(rate_hz, 24, seed=4)
    sigma = np.array([0.012, 0.025, 0.018])
    xyz = path + footwork.noise(len(path), rate_hz, sigma, memory_s, np.random.default_rng(7))
    covariance = np.broadcast_to(np.diag(sigma**2), (len(path), 3, 3))
    found = noise_propagation.estimate(xyz, covariance, rate_hz)
    speeds = [
        noise_propagation.gains(300, rate_hz, 6.0, 4, noise, 1)[150]
        for noise in (found, Noise(memory_s))
    ]
    assert speeds[0] == pytest.approx(speeds[1], rel=0.25)


def test_noise_that_is_stated_too_small_has_a_scale():
    rng = np.random.default_rng(0)
    covariance = np.broadcast_to(np.eye(3) * 1e-4, (900, 3, 3))
    found = noise_propagation.estimate(rng.normal(0, 0.02, (900, 3)), covariance, 30.0)
    assert found.memory_s == 0
    assert found.scale == pytest.approx(4.0, rel=0.15)


def test_single_outliers_do_not_make_all_of_it_noise():
    rng = np.random.default_rng(0)
    xyz = rng.normal(0, 0.01, (900, 3))
    xyz[::90] += 0.3
    found = noise_propagation.estimate(xyz, np.broadcast_to(np.eye(3) * 1e-4, (900, 3, 3)), 30.0)
    assert found.scale < 2  # the mean of their squares is ten times the noise's


def test_too_few_frames_are_taken_as_white():
    covariance = np.broadcast_to(np.eye(3), (20, 3, 3))
    assert noise_propagation.estimate(np.zeros((20, 3)), covariance, 30.0) == WHITE
    unknown = np.full((100, 3, 3), np.nan)
    assert noise_propagation.estimate(np.zeros((100, 3)), unknown, 30.0) == WHITE
