"""Square tiles of some sizes over a picture, in which a detector finds people of any size."""

import math
from collections.abc import Iterable, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.pose.detector import PersonDetector, Region

LEAST_SIDE_PX = 224  # of the smallest tiles: the input of BlazePose's detector
# Of the smallest people that such an input shows well: in px, and in shares of the picture's
# shorter side where that is less. A larger input shows smaller people well in the same tiles.
MIN_HEIGHT_PX, MIN_HEIGHT = 160, 1 / 8
# Height of a person in shares of a tile's side. BlazePose's detector finds 96 % of people of 0.3,
# 90 % of 0.25, 54 % of 0.2, all of 0.4 to 0.6, 98 % of 0.75 and 82 % of 0.95 (players-dev,
# 84 pictures of four cameras, a tile at a random place around the whole person).
SMALLEST, LARGEST = 0.28, 0.7
WORTH = 1.5  # ratio of sizes from which smaller tiles are worth their time
STEP = 2 / 3  # of a tile's side, between tiles: one of them holds all of a person of LARGEST / 2
SAME = 0.08  # regions with centres this close, in shares of the smaller one's side, are one person
COVERED = 0.8  # ASSUME: a box of which one of another tile covers this share is of that person
CUT = 0.02  # of a tile's side: a box that ends closer to its edge goes on outside
BEST = 0.6  # share of a tile's side that the region of a person fills where detection is best


def tiles(width: int, height: int) -> list[Region]:
    """Return square tiles (px) over a picture of a size, largest first.

    The first is the whole picture. The others lie inside it and overlap; people from 160 px, or an
    eighth of the picture's shorter side, to its full height fill 0.28 to 0.7 of a tile of some
    size.
    """
    short = min(width, height)
    smallest = max(LEAST_SIDE_PX, min(MIN_HEIGHT_PX, MIN_HEIGHT * short) / SMALLEST)
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

    The tile may reach over the edge of the picture (H, W, 3) uint8. It is shrunk to the detector's
    input.
    """
    half = tile.side / 2
    left, top = max(0, round(tile.x - half)), max(0, round(tile.y - half))
    cut = image[top : max(0, round(tile.y + half)), left : max(0, round(tile.x + half))]
    if not cut.size:
        return []
    scale = max(cut.shape[:2]) / detector.side_px
    if scale > 1:
        size = (max(1, round(cut.shape[1] / scale)), max(1, round(cut.shape[0] / scale)))
        cut = cv2.resize(cut, size, interpolation=cv2.INTER_AREA)
    scale = max(1.0, scale)
    return [one.placed(left, top, scale) for one in detector.detect(cut)]


def search(image: NDArray, among: Iterable[Region], detector: PersonDetector) -> list[Region]:
    """Return the regions of all persons in some tiles, each person once, largest first.

    Of regions that show one person, the one is kept that fills its tile best. A box that ends at
    the edge of its tile shows a part of a person: another tile holds all of it. Boxes of one tile
    are of different people, however much they overlap.
    """
    found = [
        (one, tile)
        for tile in among
        for one in look(image, tile, detector)
        if not _is_cut(one, tile, image.shape)
    ]
    found.sort(key=lambda pair: abs(math.log(pair[0].side / (BEST * pair[1].side))))
    kept: list[tuple[Region, Region]] = []
    for one, tile in found:
        if not any(_same(one, other, tile is its) for other, its in kept):
            kept.append((one, tile))
    return sorted((one for one, _ in kept), key=lambda one: -one.side)


def _same(one: Region, other: Region, together: bool) -> bool:
    """Return whether two regions, perhaps found `together` in one tile, show one person."""
    if one.box is None or other.box is None:
        apart = math.hypot(one.x - other.x, one.y - other.y)
        return apart < SAME * min(one.side, other.side)
    if together:
        return False
    high = np.minimum(_corners(one)[2:], _corners(other)[2:])
    shared = np.prod(np.clip(high - np.maximum(_corners(one)[:2], _corners(other)[:2]), 0, None))
    return bool(shared > COVERED * min(np.prod(one.box), np.prod(other.box)))


def _is_cut(region: Region, tile: Region, shape: Sequence[int]) -> bool:
    """Return whether a region's box ends at an edge of its tile, where the picture goes on."""
    if region.box is None:
        return False
    corners, half = _corners(region), tile.side / 2
    edges = np.array([tile.x - half, tile.y - half, tile.x + half, tile.y + half])
    goes_on = [edges[0] > 1, edges[1] > 1, edges[2] < shape[1] - 1, edges[3] < shape[0] - 1]
    return bool((goes_on & (np.abs(corners - edges) < CUT * tile.side)).any())


def _corners(region: Region) -> NDArray:
    """Return left, top, right and bottom of a region's box."""
    width, height = region.box or (region.side, region.side)
    x, y = region.x, region.y
    return np.array([x - width / 2, y - height / 2, x + width / 2, y + height / 2])
