"""Small pictures of one place and of others: likeness, exchanged cameras."""

import cv2
import numpy as np
import pytest

from courtside.validation import views
from courtside.video.glance import SMALL_PX
from fixtures.recordings import rooms_filmed


def small(seed, frame=0, gain=1.0, offset=0):
    picture = next(rooms_filmed.frames(seed, 1, start=frame)).astype(float) * gain + offset
    grey = cv2.cvtColor(np.clip(picture, 0, 255).astype(np.uint8), cv2.COLOR_BGR2GRAY)
    return cv2.resize(grey, SMALL_PX, interpolation=cv2.INTER_AREA)


@pytest.mark.parametrize("seed", range(5))
def test_one_place_is_alike_and_others_are_not(seed):
    here = small(seed)
    assert views.likeness(here, here) == pytest.approx(1)
    assert views.likeness(here, small(seed, frame=20, gain=0.6, offset=20)) > views.SAME_PLACE
    for other in range(seed + 1, seed + 6):
        assert abs(views.likeness(here, small(other))) < views.SAME_PLACE - views.LESS


def test_an_empty_picture_is_like_nothing():
    assert np.isnan(views.likeness(np.zeros(SMALL_PX[::-1], np.uint8), small(1)))


def test_two_exchanged_among_three_are_one_line():
    known = {"a": small(1), "b": small(2), "c": small(3)}
    now = {"a": small(2, 9), "b": small(1, 9), "c": small(3, 9)}
    (line,) = views.exchanged(now, known, "take one")
    assert line.startswith("cameras a and b: expected each camera's own video")
    assert list(views.exchanged(known, known, "take one")) == []
    moved = {"a": small(7), "b": small(2, 9), "c": small(3, 9)}  # another gym: not exchanged
    assert list(views.exchanged(moved, known, "take one")) == []
