"""Draw stick figures into pictures."""

from collections.abc import Iterable, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

FURTHEST_PX = 10_000  # from the picture's corner: OpenCV draws no further
Colour = int | tuple[int, int, int]  # grey, or BGR


def drawable(xy: NDArray) -> NDArray:
    """Return which joints (..., 2) px can be drawn, (...) bool."""
    return (np.abs(xy) < FURTHEST_PX).all(axis=-1)  # NaN is not


def pixel(place: NDArray) -> tuple[int, ...]:
    """Return a position as OpenCV takes it."""
    return tuple(int(value) for value in np.round(place))


def draw(
    image: NDArray,
    persons: Iterable[NDArray],
    bones: Sequence[tuple[int, int]],
    colour: Colour,
    thick: int,
    radius: int,
) -> None:
    """Draw persons, (J, 2) px each, NaN where missing, into a picture, in place.

    Bones are `thick` px wide, joints discs of a `radius`, px.
    """
    for xy in persons:
        inside = drawable(xy)
        for start, stop in bones:
            if inside[start] and inside[stop]:
                cv2.line(image, pixel(xy[start]), pixel(xy[stop]), colour, thick, cv2.LINE_AA)
        for joint in xy[inside]:
            cv2.circle(image, pixel(joint), radius, colour, -1, cv2.LINE_AA)
