"""Blocks lie within the take, each of following frames; all frames are drawn alike but the ends."""

import numpy as np

from courtside.statistics import moving_blocks


def test_takes_are_made_of_blocks_of_following_frames():
    drawn = moving_blocks.frames(20, 6)
    assert drawn.shape == (moving_blocks.REPLICATES, 20)
    assert drawn.min() == 0 and drawn.max() == 19
    inside = np.arange(1, 20) % 6 > 0
    assert (np.diff(drawn)[:, inside] == 1).all()
    assert not (np.diff(drawn)[:, ~inside] == 1).all()


def test_a_take_shorter_than_a_block_is_itself():
    assert (moving_blocks.frames(4, 9) == np.arange(4)).all()


def test_the_standard_error_of_a_mean_of_alike_frames_is_that_of_its_blocks():
    values = np.repeat(np.random.default_rng(1).normal(size=80), 10)  # ten frames are one value
    means = values[moving_blocks.frames(800, 20)].mean(axis=1)
    np.testing.assert_allclose(means.std(), values.std() / np.sqrt(80), rtol=0.15)
    plain = values[moving_blocks.frames(800, 1)].mean(axis=1)
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
