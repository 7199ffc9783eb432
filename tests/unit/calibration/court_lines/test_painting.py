"""The paint of a whole court, expected and seen: drawn pictures with known cameras."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from courtside.calibration.court_lines import painting, ridges
from courtside.calibration.court_lines.painting import Pattern
from fixtures.cameras import court_pictures

CAMERA = court_pictures.pair()[1]
VIEW = court_pictures.view_of(CAMERA)


@pytest.fixture(scope="module")
def pattern(court):
    return Pattern.of(court)


def picture_of(court, **options):
    return ridges.contrast(court_pictures.draw(CAMERA, court, noise=3, **options), "light")


def moved(view, metres):
    return replace(view, centre=view.centre + np.array([metres, 0, 0]))


def test_pieces_cover_the_court_s_lines(court, pattern):
    low, high = court.line_corners()
    assert set(pattern.line) == set(range(len(low)))
    for row in range(len(low)):
        corners = pattern.corners[pattern.line == row]
        np.testing.assert_allclose(corners.min(axis=(0, 1)), low[row])
        np.testing.assert_allclose(corners.max(axis=(0, 1)), high[row])
        sides = corners[:, 2] - corners[:, 0]
        np.testing.assert_allclose(np.prod(sides, axis=1).sum(), np.prod(high[row] - low[row]))


def test_the_true_camera_matches_best(court, pattern):
    seen = picture_of(court)
    own = painting.match(pattern, seen, VIEW)
    others = [painting.match(pattern, seen, moved(VIEW, step)) for step in (-0.3, -0.1, 0.1, 0.3)]
    assert own > 60 and max(others) < 0.8 * own
    noise = np.random.default_rng(0).normal(0, 1, seen.shape).astype(np.float32)
    assert abs(painting.match(pattern, noise, VIEW)) < 5


def test_a_missing_line_is_the_one_without_contrast(court, pattern):
    whole = painting.of_lines(pattern, picture_of(court), VIEW)
    assert np.nanmin(whole) > 0.5 and np.isfinite(whole).sum() >= 10
    without = replace(court, lines_m=np.delete(court.lines_m, 9, axis=0))
    lines = painting.of_lines(pattern, picture_of(without), VIEW)
    assert abs(lines[9]) < 0.2 and np.nanmin(np.delete(lines, 9)) > 0.5


def test_a_court_out_of_the_picture_says_nothing(court, pattern):
    away = replace(VIEW, rotation=VIEW.rotation * np.array([-1, 1, -1])[:, None])
    seen = picture_of(court)
    assert painting.area(pattern, away, CAMERA.size) is None
    assert painting.match(pattern, seen, away) == 0
    assert np.isnan(painting.of_lines(pattern, seen, away)).all()


def test_lines_thinner_than_a_pixel_are_expected_as_drawn(court, pattern):
    camera = court_pictures.looking("far", (-17.0, -11.3, 1.9), (3.05, 6.7, 1.3), f=840)
    view = court_pictures.view_of(camera)
    where = painting.area(pattern, view, camera.size)
    bare = replace(court, lines_m=np.zeros((0, 4)))
    with_lines, without = (
        court_pictures.draw(camera, one).astype(np.float32)[..., 0] for one in (court, bare)
    )
    drawn = (with_lines - without) / (court_pictures.PAINT[0] - court_pictures.FLOOR[0])
    assert np.median(drawn[drawn > 0.02]) < 0.3
    drawn -= cv2.GaussianBlur(drawn, (0, 0), ridges.FLOOR_PX)
    drawn = painting.SATURATION * np.tanh(drawn / painting.SATURATION)
    paint = painting.expected(pattern, view, where)
    assert np.corrcoef(paint.ravel(), where.of(drawn).ravel())[0, 1] > 0.9
