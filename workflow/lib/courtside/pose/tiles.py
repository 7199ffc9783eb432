"""Square tiles of some sizes over a picture, in which a detector finds people of any size."""

import math
from collections.abc import Iterable

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.pose.detector import PersonDetector, Region

SIDE_PX = 224  # tiles are shrunk to this, the input of BlazePose's detector
# Of the smallest people: in px, and in shares of the picture's shorter side where that is less.
MIN_HEIGHT_PX, MIN_HEIGHT = 160, 1 / 8
# Height of a person in shares of a tile's side. BlazePose's detector finds 96 % of people of 0.3,
# 90 % of 0.25, 54 % of 0.2, all of 0.4 to 0.6, 98 % of 0.75 and 82 % of 0.95 (players-dev,
# 84 pictures of four cameras, a tile at a random place around the whole person).
SMALLEST, LARGEST = 0.28, 0.7
WORTH = 1.5  # ratio of sizes from which smaller tiles are worth their time
STEP = 2 / 3  # of a tile's side, between tiles: one of them holds all of a person of LARGEST / 2
SAME = 0.08  # regions with centres this close, in shares of the smaller one's side, are one person
BEST = 0.6  # share of a tile's side that the region of a person fills where detection is best


def tiles(width: int, height: int) -> list[Region]:
    """Return square tiles (px) over a picture of a size, largest first.

    The first is the whole picture. The others lie inside it and overlap; people from 160 px, or an
    eighth of the picture's shorter side, to its full height fill 0.28 to 0.7 of a tile of some
    size.
    """
    short = min(width, height)
    smallest = max(SIDE_PX, min(MIN_HEIGHT_PX, MIN_HEIGHT * short) / SMALLEST)
    smallest = smallest if short > WORTH * smallest else short
    steps = math.ceil(math.log(short / smallest) / math.log(LARGEST / SMALLEST))
    found = [Region(width / 2, height / 2, max(width, height))]
    for side in np.geomspace(short, smallest, steps + 1):
        for y in _middles(height, side):
            found += [Region(x, y, float(side)) for x in _middles(width, side)]
    return found


def _middles(length: int, side: float) -> list[float]:
    n = math.ceil((length - side) / (STEP * side)) + 1
    return np.linspace(side / 2, length - side / 2, n).tolist() if n > 1 else [length / 2]


def look(image: NDArray, tile: Region, detector: PersonDetector) -> list[Region]:
    """Return the regions of all persons that the detector finds in one tile, best first.

    The tile may reach over the edge of the picture (H, W, 3) uint8.
    """
    half = tile.side / 2
    left, top = max(0, round(tile.x - half)), max(0, round(tile.y - half))
    cut = image[top : max(0, round(tile.y + half)), left : max(0, round(tile.x + half))]
    if not cut.size:
        return []
    scale = max(cut.shape[:2]) / SIDE_PX
    if scale > 1:
        size = (max(1, round(cut.shape[1] / scale)), max(1, round(cut.shape[0] / scale)))
        cut = cv2.resize(cut, size, interpolation=cv2.INTER_AREA)
    scale = max(1.0, scale)
    return [
        Region(left + one.x * scale, top + one.y * scale, one.side * scale, one.angle_rad)
        for one in detector.detect(cut)
    ]


def search(image: NDArray, among: Iterable[Region], detector: PersonDetector) -> list[Region]:
    """Return the regions of all persons in some tiles, each person once, largest first.

    Of regions that show one person, the one is kept that fills its tile best.
    """
    found = [(one, tile.side) for tile in among for one in look(image, tile, detector)]
    found.sort(key=lambda pair: abs(math.log(pair[0].side / (BEST * pair[1]))))
    kept: list[Region] = []
    for one, _ in found:
        if not any(_same(one, other) for other in kept):
            kept.append(one)
    return sorted(kept, key=lambda one: -one.side)


def _same(one: Region, other: Region) -> bool:
    apart = math.hypot(one.x - other.x, one.y - other.y)
    return apart < SAME * min(one.side, other.side)
