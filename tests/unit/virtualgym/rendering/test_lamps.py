"""Light of rows and frames, readout times: sizes as stated."""

import numpy as np
import pytest

from virtualgym.rendering import lamps


def made(strength, seed=0):
    return lamps.light(strength, np.random.default_rng(seed))


def test_without_strength_nothing_changes():
    assert made(0.0) is None
    assert lamps.readout(0.02, 0.0, np.random.default_rng(0)) == 0.02


def test_rows_brighten_and_darken_with_the_lamps():
    # One period of the lamps during the readout, exposures too short to blur it.
    rows = made(1.0).rows(0.7, 600, 1 / lamps.LAMP_HZ, 0.0)
    relative = rows / rows.mean()
    assert relative.max() == pytest.approx(1 + lamps.DEPTH, abs=1e-3)
    assert relative.min() == pytest.approx(1 - lamps.DEPTH, abs=1e-3)
    whole = made(2.0).rows(0.7, 600, 1 / lamps.LAMP_HZ, 1 / lamps.LAMP_HZ)
    assert np.ptp(whole / whole.mean()) < 1e-6, "an exposure of a whole period shows no flicker"


@pytest.mark.parametrize("strength", [1.0, 2.0])
def test_exposure_changes_by_the_stated_stops(strength):
    light = made(strength)
    times_s = np.linspace(0, 2000, 20001)
    stops = [np.log2(light.rows(t, 2, 0.0, 1 / lamps.LAMP_HZ)[0]) for t in times_s]
    assert np.std(stops) == pytest.approx(strength * lamps.STOPS, rel=0.02)


def test_pictures_are_lit_row_by_row_and_limited():
    picture = np.full((2, 3, 3), 200, np.uint8)
    lit = lamps.lit(picture, np.array([0.5, 2.0], np.float32))
    assert (lit[0] == 100).all() and (lit[1] == 255).all() and lit.dtype == np.uint8


def test_readout_times_lie_within_a_factor_of_two():
    rng = np.random.default_rng(1)
    times = np.array([lamps.readout(0.02, 1.0, rng) for _ in range(500)])
    assert 0.01 <= times.min() < 0.0105 and 0.039 < times.max() <= 0.04
