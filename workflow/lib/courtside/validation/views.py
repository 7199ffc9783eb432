"""Whether small pictures show one place: cameras given twice, cameras exchanged.

Fixed cameras see the same background in all recordings. The small pictures are compared by their
structure, at even local contrast: light and exposure do not count.
"""

from collections.abc import Iterator, Mapping
from itertools import combinations

import cv2
import numpy as np
from numpy.typing import NDArray

# Correlation of two small pictures. On players-dev 0.97 and more between recordings of one camera,
# at most 0.48 between cameras (12 videos): the place is the same from halfway on, and another where
# the correlation is less by nearly half of the gap.
SAME_PLACE, LESS = 0.7, 0.2
# A copy in poor quality or another size: 0.94 to 1. Two cameras whose pictures differ by less than
# 0.5 % of the width reach it too, but they see no depth.
ONE_VIEW = 0.95
NEAR_PX, LOCAL_PX = 3.0, 6.0  # blur that takes shading away, and over which contrast is evened
LEAST_CONTRAST = 2.0  # grey levels; flatter parts are not amplified further


def likeness(one: NDArray, other: NDArray) -> float:
    """Return the correlation (-1 to 1) of two small grey pictures (H, W) uint8; NaN if empty."""
    a, b = _evened(one), _evened(other)
    power = float(np.sqrt((a * a).sum() * (b * b).sum()))
    return float((a * b).sum() / power) if power > 0 else float("nan")


def faults(
    files: Mapping[str, str], smalls: Mapping[str, NDArray], known: Mapping[str, NDArray], what: str
) -> Iterator[str]:
    """Yield what is wrong with the views of the cameras of a take, without its name.

    By camera: `files`, the videos; `smalls`, small pictures of them; `known`, small pictures of
    other recordings of these cameras, called `what` in messages.
    """
    same = doubles(smalls)
    for one, other in same:
        yield (
            f"cameras {one} and {other}: expected two views, found one and the same in "
            f"{files[one]} and {files[other]}; name each camera's own video"
        )
    if not same:
        yield from exchanged(smalls, known, what)


def doubles(smalls: Mapping[str, NDArray]) -> list[tuple[str, str]]:
    """Return the pairs of cameras whose small pictures show one view."""
    pairs = combinations(smalls, 2)
    return [(a, b) for a, b in pairs if likeness(smalls[a], smalls[b]) >= ONE_VIEW]


def exchanged(
    smalls: Mapping[str, NDArray], known: Mapping[str, NDArray], what: str
) -> Iterator[str]:
    """Yield each camera, or pair of cameras, whose video shows what another camera has seen."""
    told: set[str] = set()
    for camera in (name for name in smalls if name in known):
        own = likeness(smalls[camera], known[camera])
        others = {c: likeness(small, known[camera]) for c, small in smalls.items() if c != camera}
        found = max(others, key=lambda name: others[name], default=camera)
        clearly = others.get(found, 0) >= max(SAME_PLACE, own + LESS)
        if clearly and camera not in told:
            told |= {camera, found}
            yield (
                f"cameras {camera} and {found}: expected each camera's own video, found {found}'s "
                f"to show what {camera} shows in {what}; they seem to be exchanged: exchange their "
                "paths"
            )


def _evened(small: NDArray) -> NDArray:
    grey = small.astype(np.float32)
    high = grey - cv2.GaussianBlur(grey, (0, 0), NEAR_PX)
    contrast = np.sqrt(cv2.GaussianBlur(high * high, (0, 0), LOCAL_PX))
    return np.asarray(high / np.maximum(contrast, LEAST_CONTRAST), dtype=float)
