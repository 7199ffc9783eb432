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
