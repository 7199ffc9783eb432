"""Faces made unrecognisable."""

import cv2
import numpy as np

REACH = 1.6  # of the distance from the face's centre to its furthest joint
LEAST_SHARE = 0.012  # of the picture's height: the smallest radius
GRAIN = 8  # mosaic cells across the face


def blur(image, xy_face):
    """Return a picture with the face hidden under a mosaic.

    Parameters
    ----------
    image : (H, W, 3) uint8
    xy_face : (K, 2) float
        Joints of one face, px; NaN are ignored. Nothing changes where all are.

    Returns
    -------
    blurred : (H, W, 3) uint8
        A new picture.

    Notes
    -----
    A mosaic of at most 8 cells across throws the detail away; a Gaussian could be sharpened again.
    """
    known = xy_face[np.isfinite(xy_face).all(axis=1)]
    result = image.copy()
    if not len(known):
        return result
    centre = (known.min(axis=0) + known.max(axis=0)) / 2
    reach = REACH * np.linalg.norm(known - centre, axis=1).max(initial=0.0)
    radius = int(np.ceil(max(reach, LEAST_SHARE * image.shape[0])))
    x, y = np.round(centre).astype(int)
    top, left = max(0, y - radius), max(0, x - radius)
    patch = result[top : max(0, y + radius + 1), left : max(0, x + radius + 1)]
    if not patch.size:
        return result
    cells = [max(1, round(GRAIN * length / (2 * radius))) for length in patch.shape[1::-1]]
    coarse = cv2.resize(patch, cells, interpolation=cv2.INTER_AREA)
    mosaic = cv2.resize(coarse, patch.shape[1::-1], interpolation=cv2.INTER_NEAREST)
    rows, columns = np.mgrid[: patch.shape[0], : patch.shape[1]]
    inside = (rows + top - y) ** 2 + (columns + left - x) ** 2 <= radius**2
    patch[inside] = mosaic[inside]
    return result
