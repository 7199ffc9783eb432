"""Boxes around what moved before an empty room."""

import numpy as np

from courtside.pose import foreground


def room(rng):
    return rng.integers(60, 180, (240, 320, 3), dtype=np.uint8)


def with_person(image, x):
    image = image.copy()
    image[80:200, x : x + 40] = (250, 20, 250)
    return image


def test_the_largest_change_comes_first():
    empty = room(np.random.default_rng(1))
    image = with_person(empty, 100)
    image[10:30, 280:300] = 255
    boxes = foreground.Foreground(empty, 30).boxes(image)
    x, y, width, height = boxes[0]
    assert abs(x - 100) <= 8
    assert abs(y - 80) <= 8
    assert abs(width - 40) <= 12
    assert abs(height - 120) <= 12


def test_an_empty_room_has_no_boxes():
    empty = room(np.random.default_rng(2))
    assert foreground.Foreground(empty, 30).boxes(empty) == []
