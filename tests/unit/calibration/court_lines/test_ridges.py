"""Ridges in a drawn picture of a court, against where its lines are exactly."""

import numpy as np
import pytest

from courtside.calibration.court_lines import ridges, views
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures


@pytest.fixture(scope="module")
def camera():
    return court_pictures.pair()[0]


@pytest.fixture(scope="module")
def picture(camera, court):
    return court_pictures.draw(camera, court, noise=3)


def near(found, xy, reach=1):
    """Say of each px whether a ridge is at most some px away."""
    x, y = np.round(xy).astype(int).T
    steps = range(-reach, reach + 1)
    return np.any([found.on[y + j, x + i] for i in steps for j in steps], axis=0)


def test_lines_are_found_where_they_are_and_run_as_they_do(camera, court, picture):
    found = ridges.find(picture, "light")
    along = views.samples(court, 0.3)
    ends = [
        cameras.project(camera, np.column_stack([along.place + by * along.half, 0 * along.line]))
        for by in (-1, 0, 1)
    ]
    inside = ((ends[1] > 5) & (ends[1] < np.array(camera.size) - 6)).all(axis=1)
    assert near(found, ends[1][inside]).mean() > 0.9
    x, y = np.round(ends[1][inside]).astype(int).T
    on = found.on[y, x]
    way = (ends[2] - ends[0])[inside][on]
    off = found.angle[y, x][on] - np.arctan2(way[:, 1], way[:, 0])
    assert np.median(np.abs((off + np.pi / 2) % np.pi - np.pi / 2)) < np.deg2rad(4)


@pytest.mark.parametrize("lines", ["dark", "any"])
def test_light_lines_are_not_dark_but_differ(camera, court, picture, lines):
    found = ridges.find(picture, lines)
    along = views.samples(court, 0.3)
    middle = cameras.project(camera, np.column_stack([along.place, 0 * along.line]))
    inside = ((middle > 5) & (middle < np.array(camera.size) - 6)).all(axis=1)
    share = near(found, middle[inside], 0).mean()
    assert share < 0.2 if lines == "dark" else share > 0.4


def test_straight_pieces_are_as_drawn():
    on = np.zeros((200, 300), dtype=bool)
    on[50, 20:121] = on[30:181, 200] = True
    angle = np.where(np.indices(on.shape)[1] < 150, 0.0, np.pi / 2)
    ends = ridges.segments(ridges.Ridges(on, angle))
    np.testing.assert_allclose(ends[0, [0, 2]], 200, atol=0.1)
    np.testing.assert_allclose(sorted(ends[0, [1, 3]]), [30, 180], atol=0.1)
    assert {round(length) for length in np.hypot(*(ends[:, 2:] - ends[:, :2]).T)} == {100, 150}


def test_a_plain_picture_has_none():
    found = ridges.find(np.full((120, 160, 3), 90, np.uint8), "light")
    assert not found.on.any() and ridges.segments(found).shape == (0, 4)


def test_faint_lines_show_when_they_are_added_up():
    image = np.random.default_rng(3).normal(100, 4, (200, 300, 3))
    image[80, 20:280] += 5
    image = np.clip(np.round(image), 0, 255).astype(np.uint8)
    columns, tops = np.arange(40, 260), np.full(220, 80)
    faint = ridges.find_faint(image, "light")
    assert near(faint, np.column_stack([columns, tops])).mean() > 0.8
    assert near(ridges.find_faint(image, "dark"), np.column_stack([columns, tops])).mean() < 0.3
    assert near(ridges.find(image, "light"), np.column_stack([columns, tops])).mean() < 0.6


def test_contrast_does_not_depend_on_brightness_or_strong_things():
    image = np.random.default_rng(3).normal(100, 4, (200, 300, 3))
    plain = ridges.contrast(image.astype(np.uint8), "light")
    assert np.sqrt(np.mean(plain**2)) == pytest.approx(1, rel=1e-4)
    image[50:53, 50:250] = 250
    strong = ridges.contrast(image.astype(np.uint8), "light")
    assert strong.max() < 1.2 * plain.max()
