"""Linear interpolation, against NumPy's."""

import numpy as np
import pytest

from courtside.geometry import interpolation

TIME_S = np.array([0.0, 0.1, 0.3, 0.4])
VALUES = np.random.default_rng(0).normal(size=(4, 2, 3))


def test_interpolated_values_are_numpys_and_stay_at_the_ends():
    wanted_s = np.linspace(-0.2, 0.6, 33)
    found = interpolation.linear(TIME_S, VALUES, wanted_s)
    for place in np.ndindex(2, 3):
        expected = np.interp(wanted_s, TIME_S, VALUES[(slice(None), *place)])
        np.testing.assert_allclose(found[(slice(None), *place)], expected, atol=1e-14)


def test_samples_are_met_and_the_last_is_reached_from_its_neighbour():
    before, share = interpolation.shares(TIME_S, TIME_S)
    assert before.tolist() == [0, 1, 2, 2]
    np.testing.assert_allclose(share, [0, 0, 0, 1], atol=1e-12)


@pytest.mark.parametrize(("seconds", "rate_hz", "n"), [(0.3, 25, 8), (0.15, 30, 5), (0.3, 30, 9)])
def test_the_start_of_the_times_does_not_decide_a_window(seconds, rate_hz, n):
    for start_s in np.random.default_rng(0).uniform(0, 1000, 40):
        step_s = interpolation.frame_step_s(start_s + np.arange(50) / rate_hz)
        assert interpolation.window(seconds, 1 / step_s) == n


def test_the_nearest_sample_is_found_within_and_beyond_the_samples():
    wanted_s = np.array([-1.0, 0.04, 0.06, 0.19, 0.3, 0.36, 9.0])
    assert interpolation.nearest(TIME_S, wanted_s).tolist() == [0, 0, 1, 1, 2, 3, 3]
    assert interpolation.nearest(np.array([0.0, 1.0]), np.array([0.5])).tolist() == [1]
    assert interpolation.nearest(np.array([0.0, 1.0]), np.array([0.5]), "left").tolist() == [0]
    assert interpolation.nearest(np.array([2.0]), np.array([0.0, 5.0])).tolist() == [0, 0]


def test_interpolation_is_a_cubic_and_bridges_no_gap():
    time_s = np.arange(0, 2, 0.05)
    cubic = np.stack([time_s**2, time_s**3 - time_s, 2 * time_s], axis=1)[:, None]
    wanted = np.array([0.33, 1.011, 1.5, 0.02, -0.1, 2.5])
    found = interpolation.between(time_s, cubic, wanted, 0.1)[:, 0]
    np.testing.assert_allclose(
        found[:3, [0, 2]], np.stack([wanted[:3] ** 2, 2 * wanted[:3]], axis=1)
    )
    np.testing.assert_allclose(found[:3, 1], (wanted**3 - wanted)[:3], atol=2e-4)
    np.testing.assert_allclose(
        found[3], [0.02 * 0.05, 0.02 * (0.05**2 - 1), 0.04]
    )  # a line at the end
    assert np.isnan(found[4:]).all()
    cubic[20:24] = np.nan
    assert np.isnan(interpolation.between(time_s, cubic, [0.97, 1.1, 1.17], 0.1)).all()
    holed, left = (np.delete(one, [20, 21, 22], axis=0) for one in (time_s, cubic))
    assert np.isnan(interpolation.between(holed, left, [1.05], 0.1)).all()


@pytest.mark.parametrize("rate_hz", [30, 60, 120, 240])
@pytest.mark.parametrize("missing", [[], [50, 51, 200]])
def test_the_step_of_times_in_milliseconds_is_that_of_the_frames(rate_hz, missing):
    time_s = np.delete(np.round(np.arange(600) / rate_hz, 3), missing)
    assert interpolation.frame_step_s(time_s) == pytest.approx(1 / rate_hz, rel=1e-4)


@pytest.mark.parametrize("rate_hz", [30, 60, 30000 / 1001])
def test_the_step_of_times_that_are_not_rounded_is_their_median_to_the_bit(rate_hz):
    time_s = np.delete(12.3 + np.arange(40000) / rate_hz, [7, 8])
    assert interpolation.frame_step_s(time_s) == np.median(np.diff(time_s))
    assert interpolation.frame_step_s(time_s[:1]) == 1.0
