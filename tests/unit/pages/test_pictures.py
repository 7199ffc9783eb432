"""Pictures for pages: scaled, smaller, and still the same picture."""

import cv2
import numpy as np

from courtside.pages import pictures


def encoded(picture):
    return cv2.imencode(".png", picture)[1].tobytes()


def decoded(png):
    return cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)


def drawing(width, height=300):
    made = np.full((height, width, 3), 255, np.uint8)
    cv2.circle(made, (width // 2, height // 2), 100, (200, 60, 20), -1)
    return made


def photograph(width=900, height=600):
    rng = np.random.default_rng(0)
    coarse = rng.integers(0, 255, (12, 18, 3), dtype=np.uint8)
    return cv2.resize(coarse, (width, height), interpolation=cv2.INTER_CUBIC)


def test_a_wide_picture_is_scaled():
    png, size = pictures.shrunk(encoded(drawing(2400)), max_width_px=1200)
    assert size == (1200, 150)
    assert decoded(png).shape == (150, 1200, 3)


def test_a_drawing_shrinks_and_stays():
    before = encoded(drawing(900))
    after, size = pictures.shrunk(before)
    assert size == (900, 300)
    assert len(after) < len(before)
    assert np.abs(decoded(after).astype(int) - drawing(900)).mean() < 0.5


def test_a_photograph_keeps_its_colours():
    made = photograph()
    after, _ = pictures.shrunk(encoded(made))
    off = np.sqrt(np.mean((decoded(after).astype(float) - made) ** 2))
    assert off <= pictures.MAX_DIFFERENCE


def test_transparent_parts_become_white():
    made = np.zeros((50, 50, 4), np.uint8)
    made[:25] = (0, 0, 255, 255)
    after = decoded(pictures.shrunk(encoded(made))[0])
    assert tuple(after[40, 10]) == (255, 255, 255)
    assert tuple(after[10, 10]) == (0, 0, 255)
