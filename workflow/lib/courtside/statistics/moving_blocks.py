"""Takes drawn again in blocks of frames: errors of neighbouring frames are alike."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

REPLICATES = 1000  # usual for percentile intervals (Davison & Hinkley 1997)


def counts(lengths: Sequence[int], blocks: Sequence[int]) -> NDArray:
    """Return how often each frame (`REPLICATES`, T) of some takes is drawn, all frames alike.

    Moving blocks, of `blocks` frames in each take, or of all where there are fewer, are drawn from
    all takes together, with wrap-around within the take (Davison & Hinkley 1997, sec. 8.2.3): each
    take drawn by itself would hide how takes differ, and blocks that end with it would leave out
    its ends.
    """
    blocks = [min(pair) for pair in zip(blocks, lengths, strict=True)]
    share = np.repeat(1 / np.array(blocks), lengths)
    rng = np.random.default_rng(0)
    starts = rng.multinomial(round(share.sum()), share / share.sum(), size=REPLICATES)
    takes = np.split(starts, np.cumsum(lengths)[:-1], axis=1)
    drawn = [
        sum(np.roll(take, at, axis=1) for at in range(block))
        for take, block in zip(takes, blocks, strict=True)
    ]
    return np.concatenate(drawn, axis=1)
