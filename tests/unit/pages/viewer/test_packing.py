"""Packed arrays come back as what they were, within what the format promises."""

import numpy as np
import pytest

from courtside.pages.viewer import packing
from fixtures.study.unpacking import covariance_of, size_of, unpacked


def path(n_frames=300):
    """Return a person's walk (2, T, 4, 3) through a hall of 30 m, metres."""
    rng = np.random.default_rng(1)
    steps = rng.normal(0, 0.01, (2, n_frames, 4, 3))
    return np.cumsum(steps, axis=1) + rng.uniform(-15, 15, (2, 1, 4, 3))


def test_positions_come_back_within_half_a_millimetre():
    xyz, middle = path(), np.array([3.05, 6.7, 1.0])
    xyz[0, 40:60, 2] = np.nan
    text, known = packing.positions(xyz, middle)
    found = unpacked(text, (2, 4, 3, 300)) * 0.001 + middle[:, None]
    found = np.moveaxis(found, -1, 1)
    assert np.nanmax(np.abs(found - xyz)) <= 0.0005 + 1e-12
    np.testing.assert_array_equal(known, np.isfinite(xyz).all(axis=-1))
    # What is missing repeats what was there before: no large number is stored for it.
    np.testing.assert_array_equal(found[0, 40:60, 2], np.tile(found[0, 39, 2], (20, 1)))


def test_the_range_of_int16_is_kept_through_any_change():
    values = np.array([[-32768, 32767, -32768, 0, 32767, 32767]])
    np.testing.assert_array_equal(unpacked(packing.integers(values), values.shape), values)
    with pytest.raises(ValueError, match="int16"):
        packing.integers([40_000])


def test_joints_beyond_32_m_are_unknown():
    xyz = np.zeros((1, 3, 1, 3))
    xyz[0, 1, 0], xyz[0, 2, 0] = [0, 33, 0], [0, 31.9, 0]
    text, known = packing.positions(xyz, np.zeros(3))
    assert known[0, :, 0].tolist() == [True, False, True]
    assert unpacked(text, (1, 1, 3, 3))[0, 0, 1].tolist() == [0, 0, 31900]


def test_a_walk_takes_little_more_than_a_byte_per_number():
    text, _ = packing.positions(path(3000), np.zeros(3))
    assert len(text) < 1.7 * 2 * 3000 * 4 * 3


def test_sizes_are_within_three_per_cent():
    values = np.geomspace(1e-5, 10, 1000)
    assert np.abs(size_of(packing.sizes(values)) / values - 1).max() < 0.028
    ends = packing.sizes([np.nan, 0, 1e-9, 10, 1e3, np.inf])
    assert ends.tolist() == [0, 1, 1, 255, 255, 0]


@pytest.mark.parametrize("stretch", [[1, 1, 1], [1, 5, 1], [0.2, 1, 10]])
def test_ellipsoids_are_recovered_from_their_levels(stretch):
    rng = np.random.default_rng(2)
    for _ in range(50):
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        covariance = turn @ np.diag((0.01 * np.array(stretch)) ** 2) @ turn.T
        found = covariance_of(packing.ellipsoids(covariance))
        largest = np.linalg.eigvalsh(covariance)[-1]
        assert np.abs(found - covariance).max() < 0.08 * largest
        assert np.linalg.eigvalsh(found)[0] > -1e-9 * largest


def test_flat_and_unknown_ellipsoids():
    flat = np.outer([1.0, 2, 3], [1.0, 2, 3]) * 1e-4  # on a line
    found = covariance_of(packing.ellipsoids(flat))
    np.testing.assert_allclose(found, flat, rtol=0.07)
    levels = packing.ellipsoids(np.stack([flat, np.full((3, 3), np.nan)]))
    assert levels[1].tolist() == [0] * 6
