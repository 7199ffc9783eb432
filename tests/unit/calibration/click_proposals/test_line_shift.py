"""Shifts of lines that were drawn by hand a known way off, in noise and partly hidden."""

import numpy as np
import pytest
from scipy.special import erf

from courtside.calibration.click_proposals import line_profiles, line_shift

BLUR_PX, FLOOR, PAINT = 0.8, 90.0, 60.0


def bar(t, low, high, blur_px=BLUR_PX):
    """Return the blurred share of paint of a bar from `low` to `high`."""
    edges = [erf((t - edge) / blur_px / np.sqrt(2)) for edge in (low, high)]
    return (edges[0] - edges[1]) / 2


def stretch(width=1.5, off=(0.0, 0.0), slope=0.0, noise=1.0, n=60, seed=0, sign=1.0, hidden=()):
    """Return a stretch whose line is `off` px off at its origin, by edge, and rotated."""
    rng = np.random.default_rng(seed)
    along = np.linspace(0, 59, n)
    half = int(np.ceil((width / 2 + line_profiles.MARGIN_PX) / line_profiles.STEP_PX))
    wide = half + int(6 / line_profiles.STEP_PX)
    t = np.arange(-wide, wide + 1) * line_profiles.STEP_PX
    middle = slope * along[:, None]
    there = bar(t, middle - width / 2 + off[0], middle + width / 2 + off[1])
    there[list(hidden)] = 0
    shade = 1 + 0.2 * np.sin(along / 20)[:, None]
    coarse = rng.normal(0, noise, (n, len(t) // 4 + 2))  # as pixels are: noise common to four steps
    seen = FLOOR * shade + 0.5 * t + sign * PAINT * there + np.repeat(coarse, 4, 1)[:, : len(t)]
    expected = np.repeat(bar(t[wide - half : wide + half + 1], -width / 2, width / 2)[None], n, 0)
    return line_profiles.Stretch(np.zeros((n, 2)), np.zeros((n, 2)), along, width, seen, expected)


@pytest.mark.parametrize("width", [0.3, 1.0, 2.5])
@pytest.mark.parametrize("off", [-3.7, -0.33, 0.0, 1.6])
def test_a_line_is_found_to_a_tenth_of_a_pixel(width, off):
    found = line_shift.shift(stretch(width, (off, off), slope=0.02))
    assert found.low_px == found.high_px == pytest.approx(off, abs=0.1)
    assert found.slope == pytest.approx(0.02, abs=3e-3)
    assert found.share > 0.9 and found.near_share == 1
    assert found.score > 0.5


def test_wide_lines_have_two_edges():
    found = line_shift.shift(stretch(8.0, (-0.6, 0.9)))
    assert found.low_px == pytest.approx(-0.6, abs=0.1)
    assert found.high_px == pytest.approx(0.9, abs=0.1)


def test_sigma_is_what_repetition_shows():
    off = [line_shift.shift(stretch(1.0, (0.4, 0.4), noise=6.0, seed=seed)) for seed in range(200)]
    spread = np.std([found.low_px for found in off])
    claimed = np.median([found.sigma_px for found in off])
    assert 0.75 < claimed / spread < 1.33


def test_hidden_parts_are_left_out_and_counted():
    found = line_shift.shift(stretch(1.5, (1.0, 1.0), hidden=range(20)))
    assert found.low_px == pytest.approx(1.0, abs=0.15)
    assert found.share == pytest.approx(2 / 3, abs=0.07)
    assert found.near_share == 0


def test_dark_lines_and_lines_of_any_contrast():
    dark = stretch(1.5, (1.0, 1.0), sign=-1.0)
    assert line_shift.shift(dark, polarity=-1).low_px == pytest.approx(1.0, abs=0.1)
    assert line_shift.shift(dark, polarity=0).low_px == pytest.approx(1.0, abs=0.1)
    light = line_shift.shift(dark, polarity=1)
    assert light is None or light.rival > 0.9  # it is as much at one side as at the other


def test_an_empty_floor_is_no_line():
    found = line_shift.shift(stretch(1.5, noise=3.0, hidden=range(60)))
    assert found is None or found.score < 0.25


def test_two_lines_alike_are_rivals():
    one, other = stretch(1.0, (-2.0, -2.0)), stretch(1.0, (3.0, 3.0), noise=0.0)
    both = line_profiles.Stretch(
        one.xy, one.normal, one.along_px, 1.0, one.seen + other.seen - FLOOR, one.paint
    )
    assert line_shift.shift(both).rival > 0.85
    assert line_shift.shift(one).rival < 0.5
