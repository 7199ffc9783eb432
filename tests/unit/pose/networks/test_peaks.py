"""Peaks of heat maps and lines with known centres, and what shifts or hides them."""

import numpy as np
import pytest

from courtside.pose.networks import peaks


def gaussian(x, y, sigma=2.0, size=(96, 96)):
    rows, columns = np.mgrid[: size[1], : size[0]]
    return np.exp(-((columns - x) ** 2 + (rows - y) ** 2) / (2 * sigma**2))[..., None]


@pytest.mark.parametrize("find", [peaks.parabola, peaks.dark])
@pytest.mark.parametrize(("x", "y"), [(40.0, 20.0), (40.3, 20.4), (10.5, 60.25)])
def test_the_peak_of_a_gaussian_is_found_to_a_twentieth_of_a_cell(find, x, y):
    maps = gaussian(x, y)
    np.testing.assert_allclose(find(maps)[0], [x, y], atol=0.05)
    assert peaks.values(maps)[0] == pytest.approx(maps.max())


def test_dark_is_exact_for_a_gaussian_where_a_parabola_is_not():
    maps = np.concatenate([gaussian(30.37, 41.22), gaussian(52.45, 20.31)], axis=2)
    truth = [[30.37, 41.22], [52.45, 20.31]]
    np.testing.assert_allclose(peaks.dark(maps), truth, atol=2e-3)
    assert np.abs(peaks.parabola(maps) - truth).max() > 4e-3


@pytest.mark.parametrize("find", [peaks.parabola, peaks.dark])
def test_a_peak_at_the_border_stays_inside(find):
    maps = np.zeros((96, 96, 1))
    maps[0, 95] = 1
    np.testing.assert_allclose(find(maps)[0], [95, 0])


@pytest.mark.parametrize("find", [peaks.parabola, peaks.dark])
def test_a_flat_map_moves_nothing(find):
    maps = np.zeros((9, 9, 1))
    np.testing.assert_array_equal(find(maps)[0], [0, 0])
    maps[:, 4] = 1e-12  # a ridge below what `dark` takes the logarithm of
    maps[4, 4] = 2e-12
    np.testing.assert_array_equal(find(maps)[0], [4, 4])


def test_peaks_of_lines_lie_between_bins():
    bins = np.arange(384)
    truth = np.array([100.3, 17.75, 383.0])
    lines = np.exp(-((bins - truth[:, None]) ** 2) / (2 * 6.0**2)) * [[0.9], [0.5], [0.2]]
    places, value = peaks.lines(lines)
    np.testing.assert_allclose(places, truth, atol=0.01)
    np.testing.assert_allclose(value, [0.9, 0.5, 0.2], rtol=0.01)


def test_values_stay_between_0_and_1():
    np.testing.assert_array_equal(peaks.values(np.array([[[2.5, -1.0, 0.5]]])), [1, 0, 0.5])
