"""Pictures in which nobody can be recognised: faces hidden, surroundings made coarse."""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.pose import stick_drawing

# ASSUME: these cover hair, chin and limbs, and leave nothing to recognise.
REACH = 1.6  # radius of the mosaic, of the distance from the face's centre to its furthest joint
LEAST_SHARE = 0.012  # of the picture's height: the smallest radius
# Of a person's extent: the smallest radius, 15 cm, where few joints of a face are known. It covers
# the disc around a joint that stays sharp (half of BODY).
HEAD = 0.09
GRAIN = 8  # mosaic cells across the face
COARSE = 1 / 60  # of the picture's height: cells that surroundings are reduced to
BODY = 0.18  # of a person's extent: width of the body around its bones


def blur_face(image: NDArray, xy_face: NDArray, extent_px: float = 0.0) -> NDArray:
    """Return a new picture with the face hidden under a mosaic.

    `xy_face` (K, 2) px are joints of one face; NaN are ignored. `extent_px` is that of the whole
    person, 0 if unknown. A mosaic of at most 8 cells across destroys the detail; a Gaussian blur
    could be sharpened again.
    """
    known = xy_face[np.isfinite(xy_face).all(axis=1)]
    result = image.copy()
    if not len(known):
        return result
    centre = (known.min(axis=0) + known.max(axis=0)) / 2
    reach = REACH * np.linalg.norm(known - centre, axis=1).max(initial=0.0)
    radius = int(np.ceil(max(reach, HEAD * extent_px, LEAST_SHARE * image.shape[0])))
    x, y = np.round(centre).astype(int)
    top, left = max(0, y - radius), max(0, x - radius)
    patch = result[top : max(0, y + radius + 1), left : max(0, x + radius + 1)]
    if not patch.size:
        return result
    shares = [length / (2 * radius) for length in patch.shape[1::-1]]
    cells = [min(GRAIN, max(1, round(GRAIN * share))) for share in shares]
    coarse = cv2.resize(patch, cells, interpolation=cv2.INTER_AREA)
    mosaic = cv2.resize(coarse, patch.shape[1::-1], interpolation=cv2.INTER_NEAREST)
    rows, columns = np.mgrid[: patch.shape[0], : patch.shape[1]]
    inside = (rows + top - y) ** 2 + (columns + left - x) ** 2 <= radius**2
    patch[inside] = mosaic[inside]
    return result


def hide_faces(
    image: NDArray, everybody: Sequence[NDArray] | NDArray, face: Sequence[int]
) -> NDArray:
    """Return a picture with the faces of all people hidden.

    `everybody` (n, J, 2) are joints, px, NaN where unknown; `face` are the indices of those of the
    face.
    """
    for xy in everybody:
        image = blur_face(image, xy[list(face)], _extent_px(xy))
    return image


def _extent_px(xy: NDArray) -> float:
    """Return the longer side of the box around a person's joints (J, 2) px; 0 if none is known."""
    known = xy[stick_drawing.drawable(xy)]
    return float(np.ptp(known, axis=0).max()) if len(known) else 0.0


def only_persons(image: NDArray, persons: NDArray, bones: Sequence[tuple[int, int]]) -> NDArray:
    """Return a picture that is sharp at some persons only, so that nobody else can be recognised.

    `persons` (n, J, 2) are joints, px, NaN where unknown. Surroundings are reduced to 60 cells
    along the height, then drawn smoothly. No detector looks for others: it misses those in the
    background most often.
    """
    height, width = image.shape[:2]
    cell = max(1.0, height * COARSE)
    cells = max(1, round(width / cell)), max(1, round(height / cell))
    small = cv2.resize(image, cells, interpolation=cv2.INTER_AREA)
    result = cv2.resize(small, (width, height), interpolation=cv2.INTER_LINEAR)
    sharp = np.zeros((height, width), np.uint8)
    for xy in persons:
        wide = max(2, round(BODY * _extent_px(xy)))
        stick_drawing.draw(sharp, [xy], bones, 255, wide, wide // 2)
    cv2.copyTo(image, sharp, result)
    return result


def hide(
    image: NDArray,
    persons: NDArray,
    bones: Sequence[tuple[int, int]],
    everybody: NDArray,
    face: Sequence[int],
) -> NDArray:
    """Return a picture in which neither these persons nor anybody else can be recognised.

    `persons` and `bones` are as for `only_persons`, `everybody` and `face` as for `hide_faces`.
    """
    return hide_faces(only_persons(image, persons, bones), everybody, face)
