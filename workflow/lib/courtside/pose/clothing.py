"""Colours of the clothes of a person in a picture: by them a body is known again.

No network: the median colour of the upper body, between shoulders and hips, and of the thighs.
"""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

UPPER = ("left_shoulder", "right_shoulder", "left_hip", "right_hip")
THIGHS = (("left_hip", "left_knee"), ("right_hip", "right_knee"))
# Where colours are taken, in shares of the way across, down the trunk, and down a thigh: far enough
# inside that a joint some centimetres off still leaves them on the clothes.
ACROSS, DOWN = (
    grid.reshape(-1, 1)
    for grid in np.meshgrid((0.25, 0.375, 0.5, 0.625, 0.75), (0.2, 0.35, 0.5, 0.65, 0.8))
)
ALONG = np.linspace(0.2, 0.8, 13)[:, None]
FEWEST = 8  # points of a part in the picture: fewer tell no colour


class Clothing:
    """Takes the colours of clothes at the joints of a network; none where it lacks these joints."""

    def __init__(self, joints: Sequence[str]) -> None:
        names = [*UPPER, *(name for thigh in THIGHS for name in thigh)]
        self._known = set(names) <= set(joints)
        if self._known:
            self._upper = [list(joints).index(name) for name in UPPER]
            self._thighs = [[list(joints).index(name) for name in thigh] for thigh in THIGHS]

    def colours(self, image: NDArray, xy: NDArray) -> NDArray:
        """Return the colours (2, 3), CIE L*a*b*, of upper body and thighs; NaN where not seen.

        `image` is a (H, W, 3) uint8 BGR picture, `xy` (J, 2) are the joints of a person in it, px.
        """
        if not self._known:
            return np.full((2, 3), np.nan)
        left, right, left_hip, right_hip = xy[self._upper]
        top, bottom = left + ACROSS * (right - left), left_hip + ACROSS * (right_hip - left_hip)
        limbs = [xy[hip] + ALONG * (xy[knee] - xy[hip]) for hip, knee in self._thighs]
        parts = (top + DOWN * (bottom - top), np.concatenate(limbs))
        return np.stack([_median_lab(image, part) for part in parts])


def _median_lab(image: NDArray, xy: NDArray) -> NDArray:
    size = image.shape[1], image.shape[0]
    with np.errstate(invalid="ignore"):
        at = np.round(xy[np.isfinite(xy).all(axis=1)]).astype(int)
    at = at[((at >= 0) & (at < size)).all(axis=1)]
    if len(at) < FEWEST:
        return np.full(3, np.nan)
    bgr = image[at[:, 1], at[:, 0]].astype(np.float32)[None] / 255
    return np.median(cv2.cvtColor(bgr, cv2.COLOR_BGR2LAB)[0], axis=0).astype(float)
