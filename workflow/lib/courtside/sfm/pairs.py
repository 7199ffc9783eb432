"""Which pairs of a walk's frames are matched, whatever images are taken later.

Places in the grid are counted from 0 to G - 1. Nothing here knows where the camera was.
"""

import numpy as np
from numpy.typing import NDArray

STRIDES = 8  # longest stride within a level of the pairs; the widest gap of images, in multiples


def pair_list(n_grid: int) -> NDArray:
    """List the pairs of grid frames to match, for any number of bridging images.

    About 12 pairs (M, 2) int for each frame: places i < j in the grid, sorted, each once. Level l
    holds the frames whose place is a multiple of q = 2**l, and their pairs up to 8 q apart. Those
    up to 4 q apart are in the levels below already.
    """
    pairs, level = [], 1
    while level < n_grid:
        first = 1 if level == 1 else STRIDES // 2 + 1
        for stride in range(first * level, (STRIDES + 1) * level, level):
            start = np.arange(0, n_grid - stride, level)
            pairs.append(np.column_stack([start, start + stride]))
        level *= 2
    found = np.concatenate(pairs) if pairs else np.empty((0, 2), dtype=int)
    return found[np.lexsort((found[:, 1], found[:, 0]))]
