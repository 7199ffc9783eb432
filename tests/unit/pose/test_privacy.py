"""A face is gone after blurring, and nothing else has changed; nobody else can be recognised."""

import numpy as np
import pytest

from courtside.pose import privacy

FACE = np.array([[150.0, 100.0], [170.0, 100.0], [160.0, 115.0], [np.nan, np.nan]])


def noise():
    return np.random.default_rng(0).integers(0, 255, (240, 320, 3), dtype=np.uint8)


def detail(image):
    """Return the mean difference of neighbouring pixels."""
    return np.abs(np.diff(image.astype(float), axis=1)).mean()


def test_detail_is_gone_inside_and_kept_outside():
    image = noise()
    before = image.copy()
    blurred = privacy.blur_face(image, FACE)
    np.testing.assert_array_equal(image, before)
    assert detail(blurred[101:114, 154:167]) < 0.25 * detail(before)
    changed = (blurred != before).any(axis=2)
    rows, columns = np.nonzero(changed)
    assert np.hypot(rows - 107.5, columns - 160).max() < 40
    for x, y in FACE[:3].astype(int):
        assert changed[y - 2 : y + 3, x - 2 : x + 3].all()


@pytest.mark.parametrize("place", [(0, 0), (319, 239), (-500, -500), (160, -3)])
def test_faces_at_and_beyond_the_border_raise_nothing(place):
    image = noise()
    blurred = privacy.blur_face(image, np.array([place, np.add(place, 9)], float))
    assert blurred.shape == image.shape
    assert (blurred != image).any() == (place != (-500, -500))


def test_one_point_is_enough_and_none_changes_nothing():
    image = noise()
    assert (privacy.blur_face(image, np.array([[100.0, 100.0]])) != image).any()
    np.testing.assert_array_equal(privacy.blur_face(image, np.full((3, 2), np.nan)), image)


def test_faces_are_hidden_where_they_are():
    image = np.random.default_rng(0).integers(0, 255, (200, 300, 3)).astype(np.uint8)
    person = np.array([[100.0, 100.0], [110.0, 104.0], [100.0, 190.0]])
    hidden = privacy.hide_faces(image, np.stack([person, np.full((3, 2), np.nan)]), (0, 1))
    assert (hidden[98:106, 98:106] != image[98:106, 98:106]).any()
    np.testing.assert_array_equal(hidden[:60], image[:60])


@pytest.mark.parametrize("height_px", [100, 400])
def test_one_joint_hides_a_whole_face(height_px):
    """A nose alone, as of networks that see no ears: a head is as large as the body says."""
    image = np.random.default_rng(0).integers(0, 255, (480, 640, 3), dtype=np.uint8)
    nose, neck, ankle = [320.0, 40.0], [320.0, 40 + 0.1 * height_px], [320.0, 40 + height_px]
    person = np.array([nose, neck, ankle])
    sharp = privacy.only_persons(image, person[None], [(0, 1), (1, 2)])
    hidden = privacy.hide(image, person[None], [(0, 1), (1, 2)], person[None], [0])
    rows, columns = np.mgrid[:480, :640]
    apart = np.hypot(columns - 320, rows - 40)
    head = apart <= 0.09 * height_px
    assert (hidden[head] != image[head]).any(axis=1).mean() > 0.95
    away = apart > 0.09 * height_px + 2
    np.testing.assert_array_equal(hidden[away], sharp[away])


def test_without_a_person_all_is_coarse():
    rng = np.random.default_rng(0)
    noise = rng.integers(0, 255, (240, 320, 3), dtype=np.uint8)
    for persons in (np.empty((0, 3, 2)), np.full((2, 3, 2), np.nan)):
        assert detail(privacy.only_persons(noise, persons, [(0, 1)])) < 0.35 * detail(noise)


def test_a_person_stays_sharp_without_a_face():
    image = noise()
    person = np.array([[160.0, 100.0], [160.0, 200.0]])
    everybody = np.concatenate([FACE, person])[None]
    hidden = privacy.hide(image, person[None], [(0, 1)], everybody, range(len(FACE)))
    np.testing.assert_array_equal(hidden[150:190, 158:163], image[150:190, 158:163])
    assert detail(hidden[101:114, 154:167]) < 0.25 * detail(image)
    assert detail(hidden[:, 220:]) < 0.35 * detail(image)


@pytest.mark.parametrize("height", [60, 240, 500, 1080])
def test_a_mosaic_is_of_8_cells_across_at_most(height, monkeypatch):
    cells = []
    resize = privacy.cv2.resize

    def counted(image, size, **options):
        cells.extend(size)
        return resize(image, size, **options)

    monkeypatch.setattr(privacy.cv2, "resize", counted)
    image = np.zeros((height, height, 3), np.uint8)
    privacy.blur_face(image, np.array([[height / 2, height / 2]]))
    assert max(cells[:2]) <= privacy.GRAIN
