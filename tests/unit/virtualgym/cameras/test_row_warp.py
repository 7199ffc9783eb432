"""Rows that a stabiliser moves: by hand."""

import numpy as np

from virtualgym.cameras import row_warp


def test_terms_are_the_shift_at_the_lowest_row_and_its_square():
    height, rows = 100, np.array([-0.5, 49.5, 99.5])  # upper edge, middle, lower edge
    warp_px = np.array([[3.0, 0.0], [0.0, 6.0]])
    across, down = row_warp.shifts(warp_px, rows, height)
    np.testing.assert_allclose(across, [-3, 0, 3], atol=1e-12)
    np.testing.assert_allclose(down, [4, -2, 4], atol=1e-12)


def test_the_mean_shift_of_a_picture_is_nothing():
    rows = np.arange(720)
    shift_px = row_warp.shifts(np.array([[1.0, 2.0], [-3.0, 0.5]]), rows, 720)
    np.testing.assert_allclose(shift_px.mean(axis=1), 0, atol=1e-5)
