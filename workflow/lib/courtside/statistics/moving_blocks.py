"""Takes drawn again in blocks of frames: errors of neighbouring frames are alike."""

import numpy as np
from numpy.typing import NDArray

REPLICATES = 1000  # usual for percentile intervals (Davison & Hinkley 1997)


def frames(count: int, block: int, *, seed: int = 0) -> NDArray:
    """Return the frames (`REPLICATES`, count) of a take of `count` frames drawn again in blocks.

    Moving blocks of `block` frames, or of all where there are fewer, without wrap-around (Davison &
    Hinkley 1997, sec. 8.2.3).
    """
    block = min(block, count)
    rng = np.random.default_rng(seed)
    starts = rng.integers(count - block + 1, size=(REPLICATES, -(-count // block)))
    return (starts[..., None] + np.arange(block)).reshape(REPLICATES, -1)[:, :count]
