"""Where a fixed camera sees something other than the empty room: boxes for the person detector."""

from collections.abc import Iterable

import cv2
import numpy as np
from numpy.typing import NDArray

SHRINK = 4  # the search runs on pictures a quarter the size
# ASSUME: sizes at that scale that remove specks and join the parts of one body.
OPEN_PX, CLOSE_PX = 3, 25
MIN_SHARE = 5e-4  # of the picture's area. ASSUME: smaller changes are noise
Box = tuple[int, ...]  # x, y, width, height, px


class Foreground:
    """Changed regions against the background of one fixed camera, (H, W, 3) uint8.

    A pixel has changed if one channel differs by more than `min_difference`, of 255.
    """

    def __init__(self, background: NDArray, min_difference: float) -> None:
        self.background = _shrink(background)
        self.min_difference = min_difference

    def boxes(self, image: NDArray, without: Iterable[tuple[float, ...]] = ()) -> list[Box]:
        """Return boxes around what changed, outside the boxes `without`, largest area first."""
        blue, green, red = cv2.split(cv2.absdiff(_shrink(image), self.background))
        difference = cv2.max(cv2.max(blue, green), red)
        mask = (difference > self.min_difference).astype(np.uint8)
        for box in without:
            x, y, width, height = (round(v / SHRINK) for v in box)
            mask[max(0, y) : max(0, y + height), max(0, x) : max(0, x + width)] = 0
        mask = cv2.morphologyEx(mask, cv2.MORPH_OPEN, np.ones((OPEN_PX, OPEN_PX), np.uint8))
        # Without a margin, closing would stretch what lies near the picture's edge up to the edge.
        mask = np.pad(mask, CLOSE_PX)
        mask = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, np.ones((CLOSE_PX, CLOSE_PX), np.uint8))
        mask = np.ascontiguousarray(mask[CLOSE_PX:-CLOSE_PX, CLOSE_PX:-CLOSE_PX])
        _, _, stats, _ = cv2.connectedComponentsWithStats(mask)
        order = np.argsort(-stats[1:, cv2.CC_STAT_AREA], kind="stable") + 1
        large = [at for at in order if stats[at, cv2.CC_STAT_AREA] >= MIN_SHARE * mask.size]
        return [tuple(int(v) * SHRINK for v in stats[at, :4]) for at in large]


def _shrink(image: NDArray) -> NDArray:
    size = (image.shape[1] // SHRINK, image.shape[0] // SHRINK)
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA)
