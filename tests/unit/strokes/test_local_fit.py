"""Local fits: exact on parabolas, robust to a wrong frame, honest about the slope."""

import numpy as np
import pytest

from courtside.strokes import local_fit

TIME_S = np.arange(60) / 30


def parabola():
    return np.stack([1 + 2 * TIME_S, 0.5 * TIME_S**2, -TIME_S], axis=1)


def test_a_parabola_is_fitted_exactly():
    found = local_fit.fit(parabola(), 30, 0.1)
    np.testing.assert_allclose(found.place, parabola(), atol=1e-6)
    np.testing.assert_allclose(found.velocity[:, 1], TIME_S, atol=1e-5)
    np.testing.assert_allclose(found.acceleration[:, 1], 1, atol=1e-4)
    assert found.velocity_sigma.max() < 1e-4


def test_a_wrong_frame_and_a_gap_do_not_move_the_fit():
    path = parabola()
    path[20] += 0.5
    path[40:42] = np.nan
    found = local_fit.fit(path, 30, 0.17)
    np.testing.assert_allclose(found.place, parabola(), atol=1e-3)


def test_where_too_few_frames_are_known_there_is_nothing():
    path = parabola()
    path[10:40] = np.nan
    found = local_fit.fit(path, 30, 0.1)
    assert np.isnan(found.place[20:30]).all()
    assert np.isnan(found.velocity_sigma[20:30]).all()
    assert np.isfinite(found.place[:8]).all()


@pytest.mark.parametrize("rate_hz", [30, 240])
def test_a_gap_has_no_place_and_its_edges_no_sure_speed(rate_hz):
    time_s = np.arange(2 * rate_hz) / rate_hz
    path = np.random.default_rng(0).normal(0, 0.003, (len(time_s), 3))
    lost = (time_s >= 0.8) & (time_s < 1.3)
    path[lost] = np.nan
    found = local_fit.fit(path, rate_hz, 0.17)
    assert np.isnan(found.place[lost]).all()
    assert np.isfinite(found.place[~lost]).all()
    beside = (np.abs(time_s - 0.8) < 1.5 / rate_hz) | (np.abs(time_s - 1.3) < 1.5 / rate_hz)
    assert np.isnan(found.sure_speed[lost | beside]).all()
    away = (time_s > 0.2) & (time_s < 1.8)  # the take itself ends there
    usual = found.speed[(time_s > 0.2) & (time_s < 0.5)]
    assert np.nanmax(found.sure_speed[away]) < 4 * usual.max()


def test_the_stated_sigma_of_the_slope_is_that_of_its_errors():
    noise = np.random.default_rng(0).normal(0, 0.02, (3000, 3))
    found = local_fit.fit(noise, 30, 0.17)
    actual = found.velocity[20:-20].std()
    assert found.velocity_sigma[20:-20].mean() == pytest.approx(actual, rel=0.35)
