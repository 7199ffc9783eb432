"""Tiles: every person lies in one of a fitting size; a stand-in detector that sees squares."""

import cv2
import numpy as np
import pytest

from courtside.pose import blazepose, tiles
from courtside.pose.detector import Region
from fixtures.recordings import networks
from fixtures.recordings.real_data import REAL, needs_real


class Finder:
    """Finds whole white squares that fill 0.2 to 0.8 of its picture's longer side."""

    side_px = 224

    def detect(self, image):
        longer = max(image.shape[:2])
        count, _, stats, centres = cv2.connectedComponentsWithStats(
            (image[..., 0] > 128).astype(np.uint8)
        )
        return [
            Region(*(centres[at] + 0.5), float(stats[at, cv2.CC_STAT_HEIGHT]))
            for at in range(1, count)
            if 0.2 * longer < stats[at, cv2.CC_STAT_HEIGHT] < 0.8 * longer
            and abs(stats[at, cv2.CC_STAT_HEIGHT] - stats[at, cv2.CC_STAT_WIDTH]) <= 2
        ]


@pytest.mark.parametrize("size", [(1280, 720), (1920, 1080), (1080, 1920), (3840, 2160)])
def test_a_person_of_any_size_lies_whole_in_a_fitting_tile(size):
    found = tiles.tiles(*size)
    rng = np.random.default_rng(1)
    least = min(tiles.MIN_HEIGHT_PX, tiles.MIN_HEIGHT * min(size))
    for height in np.geomspace(least, min(1600, min(size)), 8):
        width = 0.4 * height
        for _ in range(40):
            x, y = rng.uniform(0, 1, 2) * (np.array(size) - (width, height))
            fits = [
                tile
                for tile in found
                if tiles.SMALLEST * 0.9 <= height / tile.side <= 1
                and tile.x - tile.side / 2 - 1 <= x
                and x + width <= tile.x + tile.side / 2 + 1
                and tile.y - tile.side / 2 - 1 <= y + 0.4 * height  # head to hips
                and y + 0.4 * height <= tile.y + tile.side / 2 + 1
            ]
            assert fits, (height, x, y)


def test_tiles_are_few():
    assert len(tiles.tiles(1920, 1080)) <= 24
    assert len(tiles.tiles(3840, 2160)) <= 90
    assert [tile.side for tile in tiles.tiles(200, 100)] == [200, 100, 100, 100]
    assert {tile.side for tile in tiles.tiles(640, 240)} == {640, 240}
    assert min(tile.side for tile in tiles.tiles(640, 480)) == 224


@pytest.mark.parametrize("side", [160, 330, 620])
def test_a_tile_gives_places_in_the_picture(side):
    image = np.zeros((1080, 1920, 3), np.uint8)
    image[300 : 300 + side, 900 : 900 + side] = 255
    found = tiles.search(image, tiles.tiles(1920, 1080), Finder())
    assert len(found) == 1
    assert (found[0].x, found[0].y) == pytest.approx((900 + side / 2, 300 + side / 2), abs=4)
    assert found[0].side == pytest.approx(side, rel=0.06)


def test_a_tile_outside_the_picture_shows_nobody():
    image = np.full((100, 100, 3), 255, np.uint8)
    assert tiles.look(image, Region(500, 50, 80), Finder()) == []


@needs_real
@pytest.mark.parametrize("height_px", [170, 420, 900])
def test_blazepose_finds_a_real_person_of_any_size_in_a_large_picture(height_px, run_folder):
    stream = cv2.VideoCapture(str(REAL / "walk-4cams" / "videos" / "cam03.mp4"))
    found, person = stream.read()
    assert found
    detector = blazepose.BlazePoseDetector(networks.detector_onnx(run_folder))
    known = detector.detect(person)[0]
    scale = height_px / (known.side / 1.4)  # the region's side is about 1.4 times the height
    small = cv2.resize(person, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    small = small[:1080, :1920]
    image = np.full((1080, 1920, 3), 110, np.uint8)
    left = (1920 - small.shape[1]) // 3
    image[: small.shape[0], left : left + small.shape[1]] = small
    regions = tiles.search(image, tiles.tiles(1920, 1080), detector)
    away = [np.hypot(r.x - left - known.x * scale, r.y - known.y * scale) for r in regions]
    assert min(away) < 0.15 * height_px
