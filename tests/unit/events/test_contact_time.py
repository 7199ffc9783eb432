"""Corners of made hinges: found between frames, with an uncertainty that covers."""

import numpy as np
import pytest

from courtside.events import contact_time
from fixtures.cameras import sync_takes


def hinge(time_s, corner_s, *, floor=0.1, slope=2.6, bend=3.0, rise=0.0, sigma_s=0.0):
    """Return a distance with a corner, smoothed numerically, not by the library's formula."""

    def sharp(t):
        left = corner_s - t
        fall = slope * np.maximum(left, 0) + bend * np.maximum(left, 0) ** 2
        return floor + fall + rise * np.maximum(-left, 0)

    if not sigma_s:
        return sharp(time_s)
    steps = np.linspace(-5, 5, 2001)
    weight = np.exp(-0.5 * steps**2)
    return sharp(time_s[:, None] + sigma_s * steps) @ (weight / weight.sum())


@pytest.mark.parametrize("rate_hz", [30, 60])
@pytest.mark.parametrize("sigma_s", [0.0, 0.01, 0.025])
def test_the_corner_of_a_clean_hinge_is_found_between_frames(rate_hz, sigma_s):
    for phase in np.linspace(0, 1, 5, endpoint=False):
        time_s = 3.0 + np.arange(-0.15 * rate_hz, 0.22 * rate_hz) / rate_hz
        corner_s = 3.0 + phase / rate_hz
        values = hinge(time_s, corner_s, sigma_s=sigma_s)
        found = contact_time.fit(time_s, values, corner_s + 0.02, 0.08, usual_s=0.03)
        assert found.time_s == pytest.approx(corner_s, abs=0.0015)
        assert found.floor == pytest.approx(0.1, abs=0.002)
        assert found.slope == pytest.approx(2.6, rel=0.1)
        assert found.smoothing_s == pytest.approx(sigma_s, abs=0.008)
        assert not found.rises


def test_a_rebound_is_seen_and_its_corner_found():
    time_s = np.arange(-9, 8) / 60
    found = contact_time.fit(time_s, hinge(time_s, 0.004, rise=1.6), 0.02, 0.08)
    assert found.rises
    assert found.time_s == pytest.approx(0.004, abs=0.0015)
    flat = contact_time.fit(time_s, hinge(time_s, 0.004, rise=1.6), 0.02, 0.08, rebounds=False)
    assert not flat.rises


def test_seven_values_tell_a_rebound():
    time_s = np.arange(-3, 4) / 24
    for corner_s in (-0.015, 0.0, 0.015):
        values = hinge(time_s, corner_s, rise=1.6)
        found = contact_time.fit(time_s, values, 0.0, 0.08)
        assert found.rises
        assert abs(found.time_s - corner_s) < 1.645 * found.uncertainty_s


@pytest.mark.parametrize(("memory", "noise_m"), [(0.0, 0.01), (0.5, 0.015)])
def test_the_uncertainty_covers_noisy_corners(memory, noise_m):
    rng = np.random.default_rng(7)
    time_s = np.arange(-5, 7) / 30
    errors, stated = [], []
    for _ in range(120):
        corner_s = rng.uniform(0, 1 / 30)
        values = hinge(time_s, corner_s) + noise_m * sync_takes.memory_noise(
            rng, len(time_s), memory
        )
        noise = contact_time.Noise(noise_m, memory)
        found = contact_time.fit(time_s, values, corner_s, 0.08, noise=noise, rebounds=False)
        errors.append(found.time_s - corner_s)
        stated.append(found.uncertainty_s)
    errors, stated = np.array(errors), np.array(stated)
    covered = np.mean(np.abs(errors) <= 1.645 * stated)
    assert 0.83 <= covered <= 1.0
    assert np.sqrt(np.mean(stated**2)) < 1.6 * np.sqrt(np.mean(errors**2))
    assert abs(errors.mean()) < 0.004


def test_the_noise_of_a_body_that_holds_still():
    rng = np.random.default_rng(0)
    drift = 1.4 + 0.01 * np.linspace(0, 1, 400)
    for memory in (0.0, 0.6):
        noise = contact_time.Noise.of(drift + 0.02 * sync_takes.memory_noise(rng, 400, memory))
        assert noise.sd == pytest.approx(0.02, rel=0.15)
        assert noise.memory == pytest.approx(memory, abs=0.12)
    assert contact_time.Noise.of(np.ones(3)) == contact_time.Noise()


def test_too_few_or_nothing_that_falls():
    with pytest.raises(ValueError, match=r"seven|7"):
        contact_time.fit(np.arange(6) / 30, np.ones(6), 0.1, 0.05)
    time_s = np.arange(12) / 30
    with pytest.raises(ValueError, match="falls"):
        contact_time.fit(time_s, 0.1 + 2 * time_s, 0.2, 0.05, rebounds=False)
