"""Blocks lie within the take, each of following frames; all frames are drawn alike."""

import numpy as np

from courtside.statistics import moving_blocks


def test_the_standard_error_of_a_mean_of_alike_frames_is_that_of_its_blocks():
    values = np.repeat(np.random.default_rng(1).normal(size=80), 10)  # ten frames are one value
    means = moving_blocks.counts([800], [20]) @ values / 800
    np.testing.assert_allclose(means.std(), values.std() / np.sqrt(80), rtol=0.15)
    plain = moving_blocks.counts([800], [1]) @ values / 800
    assert plain.std() < 0.5 * means.std()


def test_blocks_of_several_takes_are_drawn_from_all_together():
    """All frames alike, also those at the ends of a take; takes of two rates."""
    counts = moving_blocks.counts([60, 60, 120, 8], [15, 15, 30, 30])
    assert counts.shape == (moving_blocks.REPLICATES, 248)
    np.testing.assert_allclose(counts.mean(axis=0), 1, atol=0.2)
    assert counts[:, :60].sum(axis=1).std() > 20  # takes have no fixed share
    assert (counts[:, 240:] == counts[:, 240:241]).all()  # a short take is one block
    alike = np.corrcoef(counts[:, :60].T)
    assert np.diag(alike, 1).min() > 0.85 and alike[0, 59] > 0.85  # wraps around within the take
    assert abs(alike[0, 30]) < 0.15 and abs(np.corrcoef(counts[:, 59], counts[:, 60])[0, 1]) < 0.15


def test_intervals_of_five_short_takes_hold_means_of_errors_that_grow_during_each():
    """Errors that last 0.1 s at 30 Hz, and grow by two of their standard deviations."""
    rng, kept = np.random.default_rng(5), np.exp(-1 / 3)
    values = rng.normal(size=(600, 5, 90))
    for at in range(1, 90):
        fresh = np.sqrt(1 - kept**2) * values[..., at]
        values[..., at] = kept * values[..., at - 1] + fresh
    values = (values[..., 30:] + np.linspace(0, 2, 60)).reshape(600, 300)
    drawn = values @ moving_blocks.counts([60] * 5, [15] * 5).T / 300
    low, high = np.quantile(drawn, [0.025, 0.975], axis=1)
    assert np.mean((low < 1) & (high > 1)) > 0.88
