"""Smooth courses of one number."""

import numpy as np
import pytest

from virtualgym.movement import easing

X = np.linspace(-0.2, 1.2, 14001)


@pytest.mark.parametrize("ramp", [0.1, 0.35, 0.5])
def test_a_move_goes_from_0_to_1_at_a_limited_speed(ramp):
    y = easing.ease(X, ramp)
    assert (y[0], y[-1]) == (0, pytest.approx(1))
    np.testing.assert_allclose(y + y[::-1], 1, atol=1e-12)  # as it starts, so it stops
    slope = np.gradient(y, X)
    assert slope.min() > -1e-9
    assert slope.max() == pytest.approx(1 / (1 - ramp), abs=1e-3)
    assert np.abs(np.gradient(slope, X)).max() < 1.6 / ramp / (1 - ramp)


def test_step_and_bump_are_smooth():
    for curve, ends, middle in ((easing.step, (0, 1), 0.5), (easing.bump, (0, 0), 1)):
        y = curve(X)
        assert (y[0], y[-1]) == ends
        assert curve(0.5) == middle
        assert np.abs(np.diff(np.gradient(y, X))).max() < 0.01  # no kink


def test_an_arc_is_what_is_thrown_up_and_lands_as_fast():
    y = easing.arc(X)
    assert (y[0], y[-1], easing.arc(0.5)) == (0, 0, 1)
    np.testing.assert_allclose(np.diff(y[(X > 0.01) & (X < 0.99)], 2), -8e-8, atol=1e-12)
    assert easing.flight_m(0.2) == pytest.approx(9.81 * 0.1**2 / 2)  # falls for half of the time


def test_a_glide_is_the_integral_of_its_speeds():
    knots, speeds = [1.0, 2.0, 2.5, 4.0], [0.0, 3.0, -1.0, 0.0]
    glide = easing.Glide(knots, speeds, start=0.5)
    times = np.linspace(0, 5, 50001)
    rates = np.interp(times, knots, speeds)
    integral = 0.5 + np.append(0, np.cumsum((rates[1:] + rates[:-1]) / 2 * np.diff(times)))
    found = [glide.at(t) for t in times[::500]]
    np.testing.assert_allclose(found, integral[::500], atol=1e-6)


@pytest.mark.parametrize(("times", "speeds"), [([0, 0], [0, 0]), ([0, 1], [0, 1])])
def test_a_glide_without_rest_or_time_is_refused(times, speeds):
    with pytest.raises(ValueError, match="increasing times and rest"):
        easing.Glide(times, speeds)
