"""A network in parts: the fixed cameras and some of the walk's images each, spread over the whole walk.

Views a fraction of a degree apart get the same things wrong: what is off in one is off in the next, and an
adjustment of all takes their agreement for evidence. The images of one part lie farther apart, and the mean
over the parts has less noise than any of them.
"""

from dataclasses import dataclass, replace

import numpy as np

from courtside.calibration.bundle import selection
from courtside.calibration.bundle.problem import Network

PER_IMAGE = ("cam_from_world", "flex", "lens_of_image", "height_px", "flex_sigma")


@dataclass(frozen=True, eq=False)
class Part:
    """Some images of a network.

    Attributes
    ----------
    images : (W,) int
        Where they stand in the whole, ascending.
    fixed : (C,) int
        Where the fixed cameras' images stand in the part.
    network : courtside.calibration.bundle.problem.Network
        Of these images; all points and lenses of the whole, until it is thinned.
    """

    images: np.ndarray
    fixed: np.ndarray
    network: Network


def split(network, fixed, images_per_part):
    """Share the images of a walk out among parts, by turns.

    Parameters
    ----------
    network : courtside.calibration.bundle.problem.Network
    fixed : sequence of int
        Images of the fixed cameras; every part has them all.
    images_per_part : int
        Of the walk. The number of parts is that which comes nearest to it.

    Returns
    -------
    parts : list of Part
        At least one.
    """
    walked = np.setdiff1d(np.arange(len(network.cam_from_world)), fixed)
    n_parts = max(1, round(len(walked) / images_per_part))
    parts = []
    for first in range(n_parts):
        images = np.sort(np.concatenate([np.asarray(fixed, dtype=int), walked[first::n_parts]]))
        at = np.searchsorted(images, fixed)
        parts.append(Part(images, at, _of_images(network, images)))
    return parts


def _of_images(network, images):
    every_point = np.ones(len(network.xyz), dtype=bool)
    mine = selection.select(network, every_point, np.isin(network.image_idx, images))
    per_image = {name: getattr(network, name)[images] for name in PER_IMAGE}
    return replace(mine, image_idx=np.searchsorted(images, mine.image_idx), **per_image)


def centres(parts):
    """Return the projection centres of the whole's images, (V, 3); of fixed ones those of the first part."""
    found = np.empty((1 + max(part.images.max() for part in parts), 3))
    for part in reversed(parts):
        found[part.images] = selection.centres(part.network)
    return found


def points(parts):
    """Return the points that tie images, (N, 3); one that does in several parts comes several times."""
    return np.concatenate([part.network.xyz for part in parts])


def residual_spread(parts):
    """Return the median over parts of `selection.residual_spread`, px."""
    return float(np.median([selection.residual_spread(part.network) for part in parts]))
