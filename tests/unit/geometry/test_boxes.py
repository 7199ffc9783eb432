"""Boxes around points, against boxes that are known."""

import numpy as np

from courtside.geometry import boxes


def test_the_longer_side_of_most_frames_counts():
    frames = np.full((5, 3, 2), np.nan)
    frames[0, :2] = [[10, 10], [14, 40]]  # 30 px high
    frames[1, :2] = [[10, 10], [60, 12]]  # 50 px wide
    frames[2] = [[0, 0], [3, 90], [50, 5]]  # 90 px high
    frames[3, 0] = [7, 7]  # one point has no box
    assert boxes.usual_side(frames) == 50
    both = boxes.usual_side(np.stack([frames, np.full_like(frames, np.nan)]))
    np.testing.assert_array_equal(both, [50, 0])
