"""SPARC against its definition integrated on closed-form spectra, and what must not change it."""

import numpy as np
import pytest
from scipy.integrate import quad

from courtside.kinematics import smoothness

RATE_HZ = 200.0


def reach(seconds=1.0, rate_hz=RATE_HZ):
    """Return the speed of a minimum-jerk reach (Flash & Hogan 1985) of length 1."""
    s = np.arange(0, seconds + 0.5 / rate_hz, 1 / rate_hz) / seconds
    return 30 * (s**2 - 2 * s**3 + s**4) / seconds


def arc_length(spectrum, stop_hz):
    """Return minus the length of a curve over frequencies scaled to 0..1, by integration."""

    def step(share, d=1e-6):
        slope = (spectrum((share + d) * stop_hz) - spectrum((share - d) * stop_hz)) / (2 * d)
        return np.sqrt(1 + slope**2)

    return -quad(step, 0, 1, limit=500)[0]


def last_above(spectrum, threshold, most_hz):
    hz = np.linspace(0, most_hz, 20001)
    return hz[np.flatnonzero(np.array([spectrum(f) for f in hz]) >= threshold)[-1]]


def test_a_half_sine_has_the_arc_length_of_its_spectrum():
    """The spectrum of sin(pi t), 0 < t < 1, is |cos(pi f) / (1 - 4 f^2)|."""

    def spectrum(hz):
        return abs(np.cos(np.pi * hz) / (1 - 4 * hz**2)) if abs(abs(hz) - 0.5) > 1e-9 else np.pi / 4

    speed = np.sin(np.pi * np.arange(0, 1, 1 / RATE_HZ))
    expected = arc_length(spectrum, last_above(spectrum, 0.05, 10.0))
    assert smoothness.sparc(speed, RATE_HZ) == pytest.approx(expected, abs=0.01)


def test_a_gaussian_has_the_arc_length_of_its_spectrum():
    sigma_s = 0.1
    time_s = np.arange(-1, 1, 1 / RATE_HZ)

    def spectrum(hz):
        return np.exp(-2 * (np.pi * hz * sigma_s) ** 2)

    expected = arc_length(spectrum, last_above(spectrum, 0.05, 10.0))
    found = smoothness.sparc(np.exp(-0.5 * (time_s / sigma_s) ** 2), RATE_HZ)
    assert found == pytest.approx(expected, abs=0.005)


def test_a_minimum_jerk_reach_has_the_published_value():
    assert smoothness.sparc(reach(), RATE_HZ) == pytest.approx(-1.41, abs=0.01)


@pytest.mark.parametrize("seconds", [0.5, 0.8, 2.0, 4.0])
@pytest.mark.parametrize("size", [0.1, 1.0, 40.0])
def test_size_and_duration_do_not_matter(seconds, size):
    found = smoothness.sparc(size * reach(seconds), RATE_HZ)
    assert found == pytest.approx(smoothness.sparc(reach(), RATE_HZ), abs=0.02)


def test_parts_and_noise_are_less_smooth():
    one = smoothness.sparc(reach(), RATE_HZ)
    pause = np.zeros(60)
    parts = np.concatenate([reach(0.5), pause, reach(0.5)])
    more = np.concatenate([parts, pause, reach(0.5)])
    assert smoothness.sparc(more, RATE_HZ) < smoothness.sparc(parts, RATE_HZ) < one - 0.2
    rng = np.random.default_rng(0)
    noisy = np.abs(reach() + rng.normal(0, 0.5, len(reach())))
    assert smoothness.sparc(noisy, RATE_HZ) < one - 0.05


def test_a_path_is_measured_between_two_times_at_one_rate():
    for rate_hz in (30.0, 60.0):
        time_s = np.arange(0, 3, 1 / rate_hz)
        s = np.clip(time_s - 1, 0, 1)
        along = 10 * s**3 - 15 * s**4 + 6 * s**5
        xyz = along[:, None] * [0.3, -0.2, 0.5]
        xyz[5] = np.nan
        found = smoothness.of_path(time_s, xyz, 60.0, start_s=0.9, stop_s=2.1)
        assert found == pytest.approx(-1.41, abs=0.06)
    assert np.isnan(smoothness.of_path(time_s, xyz * np.nan, 60.0, start_s=0.9, stop_s=2.1))


@pytest.mark.parametrize("speed", [np.zeros(50), np.array([1.0, np.nan, 1.0, 2.0]), np.ones(3)])
def test_nothing_that_moves_is_refused(speed):
    with pytest.raises(ValueError, match="speeds"):
        smoothness.sparc(speed, RATE_HZ)
