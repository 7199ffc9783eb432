"""A face is gone after blurring, and nothing else has changed."""

import numpy as np
import pytest

from courtside.figures import faces

FACE = np.array([[150.0, 100.0], [170.0, 100.0], [160.0, 115.0], [np.nan, np.nan]])


def noise():
    return np.random.default_rng(0).integers(0, 255, (240, 320, 3), dtype=np.uint8)


def detail(image):
    """Return the mean difference of neighbouring pixels."""
    return np.abs(np.diff(image.astype(float), axis=1)).mean()


def test_detail_is_gone_inside_and_kept_outside():
    image = noise()
    before = image.copy()
    blurred = faces.blur(image, FACE)
    np.testing.assert_array_equal(image, before)
    assert detail(blurred[101:114, 154:167]) < 0.25 * detail(before)
    changed = (blurred != before).any(axis=2)
    rows, columns = np.nonzero(changed)
    assert np.hypot(rows - 107.5, columns - 160).max() < 40
    for x, y in FACE[:3].astype(int):
        assert changed[y - 2 : y + 3, x - 2 : x + 3].all()


@pytest.mark.parametrize("place", [(0, 0), (319, 239), (-500, -500), (160, -3)])
def test_faces_at_and_beyond_the_border(place):
    image = noise()
    blurred = faces.blur(image, np.array([place, np.add(place, 9)], float))
    assert blurred.shape == image.shape
    assert (blurred != image).any() == (place != (-500, -500))


def test_one_point_is_enough_and_none_changes_nothing():
    image = noise()
    assert (faces.blur(image, np.array([[100.0, 100.0]])) != image).any()
    np.testing.assert_array_equal(faces.blur(image, np.full((3, 2), np.nan)), image)
