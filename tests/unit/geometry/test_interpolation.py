"""Linear interpolation, against NumPy's."""

import numpy as np

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


def test_the_nearest_sample_is_found_within_and_beyond_the_samples():
    wanted_s = np.array([-1.0, 0.04, 0.06, 0.19, 0.3, 0.36, 9.0])
    assert interpolation.nearest(TIME_S, wanted_s).tolist() == [0, 0, 1, 1, 2, 3, 3]
    assert interpolation.nearest(np.array([0.0, 1.0]), np.array([0.5])).tolist() == [1]
    assert interpolation.nearest(np.array([0.0, 1.0]), np.array([0.5]), "left").tolist() == [0]
    assert interpolation.nearest(np.array([2.0]), np.array([0.0, 5.0])).tolist() == [0, 0]
