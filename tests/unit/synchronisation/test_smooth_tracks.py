"""Smoothed tracks: straight motion, the Gaussian's gain, gaps, even noise at all fractions."""

import numpy as np
import pytest

from courtside.synchronisation import smooth_tracks

TIME_S = np.arange(300) / 30


def track(values, time_s=TIME_S, sigma_s=0.85 / 30):
    return smooth_tracks.build(time_s, np.reshape(values, (1, len(time_s), 1, -1)), sigma_s)


def test_straight_motion_is_kept_with_its_velocity():
    found = track(3.0 + 2.0 * TIME_S)
    at = np.linspace(0.2, 9.7, 333)
    value, velocity, acceleration = smooth_tracks.sample(found, at)
    np.testing.assert_allclose(value[0, :, 0, 0], 3 + 2 * at, atol=2e-4)
    np.testing.assert_allclose(velocity[0, :, 0, 0], 2.0, atol=0.03)
    np.testing.assert_allclose(acceleration[0, :, 0, 0], 0.0, atol=2.0)


def test_a_sinusoid_keeps_its_phase_and_loses_what_a_gaussian_takes():
    omega, sigma_s = 2 * np.pi * 1.5, 0.85 / 30
    found = track(np.sin(omega * TIME_S))
    at = np.linspace(0.5, 9.5, 501)
    gain = np.exp(-0.5 * (omega * sigma_s) ** 2)
    value, velocity, _ = smooth_tracks.sample(found, at)
    np.testing.assert_allclose(value[0, :, 0, 0], gain * np.sin(omega * at), atol=5e-3)
    np.testing.assert_allclose(velocity[0, :, 0, 0] / omega, gain * np.cos(omega * at), atol=0.02)


@pytest.mark.parametrize("share", [0.0, 0.13, 0.25, 0.4, 0.5])
def test_noise_is_even_between_frames(share):
    rng = np.random.default_rng(0)
    time_s = np.arange(60000) / 30
    found = track(rng.normal(0, 1, len(time_s)), time_s)
    value, _, _ = smooth_tracks.sample(found, time_s[10:-10] + share / 30)
    # The variance of a Gaussian mean of white noise is 1 / (2 sqrt(pi) sigma), sigma in frames.
    assert np.var(value) == pytest.approx(1 / (2 * np.sqrt(np.pi) * 0.85), rel=0.02)


def test_short_gaps_are_bridged_and_long_ones_are_not():
    values = 1.0 * TIME_S
    values[100:103] = np.nan
    values[200:210] = np.nan
    found = track(values)
    value, _, _ = smooth_tracks.sample(found, TIME_S)
    value = value[0, :, 0, 0]
    np.testing.assert_allclose(value[95:110], TIME_S[95:110], atol=1e-3)
    assert np.isnan(value[200:210]).all()
    np.testing.assert_allclose(value[214:220], TIME_S[214:220], atol=1e-3)


def test_dropped_frames_keep_the_others_times():
    kept = np.delete(TIME_S, [50, 51, 120])
    value, _, _ = smooth_tracks.sample(track(kept, kept), TIME_S[10:-10])
    np.testing.assert_allclose(value[0, :, 0, 0], TIME_S[10:-10], atol=1e-3)


def test_outside_the_take_nothing_is_known():
    value, velocity, _ = smooth_tracks.sample(track(TIME_S), np.array([-1.0, 0.01, 9.99, 12.0]))
    assert np.isnan(value).all()
    assert np.isnan(velocity).all()


def test_counterparts_are_the_nearest_values_by_both_clocks():
    first = smooth_tracks.Track(10.0, 0.02, np.zeros((1, 6, 1, 2)))
    second = smooth_tracks.Track(12.01, 0.01, np.zeros((1, 4, 1, 2)))
    index, inside = smooth_tracks.counterparts(
        first, np.array([0, 2]), second, np.array([2.0, 1.994])
    )
    # 12.00 and 12.04 s, 11.994 and 12.034 s on the second clock, whose values end at 12.04 s.
    assert index.tolist() == [[-1, -2], [3, 2]]
    assert inside.tolist() == [[False, False], [True, True]]


def test_product_terms_are_derivatives_by_the_offset():
    """Two sines, split over both clocks: the product's derivatives by finite differences."""
    at_s, lag_s, step_s = np.linspace(0, 1, 7), 0.03, 1e-4

    def signals(lag):
        times = at_s - lag / 2, at_s + lag / 2
        return [(np.sin(w * t), w * np.cos(w * t), -(w**2) * np.sin(w * t))
                for w, t in zip((3.0, 5.0), times, strict=True)]  # fmt: skip

    def loss(lag):
        (a, *_), (b, *_) = signals(lag)
        return -a * b

    slope, curvature, steep = smooth_tracks.product_terms(*signals(lag_s))
    before, here, after = (loss(lag_s + k * step_s) for k in (-1, 0, 1))
    np.testing.assert_allclose(slope, (after - before) / (2 * step_s), atol=1e-6)
    np.testing.assert_allclose(curvature, (after - 2 * here + before) / step_s**2, atol=1e-4)
    assert (steep >= 0).all()


def test_tracks_are_compared_where_the_one_that_shows_little_shows_somebody():
    whole = smooth_tracks.Track(0.0, 0.05, np.zeros((1, 1000, 2, 2)))
    glance = smooth_tracks.Track(0.0, 0.05, np.full((1, 1000, 2, 2), np.nan))
    glance.values[0, 300:360] = 0.0
    at, of_second = smooth_tracks.compared(whole, glance, 20)
    assert of_second and at.tolist() == list(range(300, 360, 3))
    at, of_second = smooth_tracks.compared(glance, whole, 20)
    assert not of_second and at.tolist() == list(range(300, 360, 3))
    glance.values[0, :600] = 0.0  # enough: as if nothing were missing
    at, of_second = smooth_tracks.compared(whole, glance, 20)
    assert not of_second and at.tolist() == list(range(0, 1000, 50))
