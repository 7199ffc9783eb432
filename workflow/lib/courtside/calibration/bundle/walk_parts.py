"""A network in parts: each has the fixed cameras and images spread over the whole walk.

Views a fraction of a degree apart have correlated errors, but an adjustment of all views treats
them as independent. The images of one part are farther apart, and the mean over the parts has less
noise than each part.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.bundle import conversion, selection
from courtside.calibration.bundle.problem import PER_IMAGE, Network
from courtside.geometry.camera import Camera
from courtside.geometry.similarity import Sim3


@dataclass(frozen=True, eq=False)
class Part:
    """Some images of a network."""

    images: NDArray  # (W,) int: their indices in the whole network, ascending
    fixed: NDArray  # (C,) int: indices of the fixed cameras' images within the part
    network: Network  # of these images; has all points and lenses of the whole until it is thinned


def split(network: Network, fixed: Sequence[int], images_per_part: int) -> list[Part]:
    """Distribute the images of a walk in turn among one or more parts.

    Every part has all images of the `fixed` cameras. The number of parts is chosen so that the
    number of walk images per part is nearest to `images_per_part`.
    """
    walked = np.setdiff1d(np.arange(len(network.cam_from_world)), fixed)
    n_parts = max(1, round(len(walked) / images_per_part))
    parts, every_point = [], np.ones(len(network.xyz), dtype=bool)
    for first in range(n_parts):
        images = np.sort(np.concatenate([np.asarray(fixed, dtype=int), walked[first::n_parts]]))
        mine = selection.select(network, every_point, np.isin(network.image_idx, images))
        per_image = {name: getattr(network, name)[images] for name in PER_IMAGE}
        mine = replace(mine, image_idx=np.searchsorted(images, mine.image_idx), **per_image)
        parts.append(Part(images, np.searchsorted(images, fixed), mine))
    return parts


def in_one_frame(parts: Sequence[Part], whole: Network) -> list[Part]:
    """Return the parts of a network in the frame of the first, where each has one of its own.

    The images of each part tell where the frame of `whole` is.
    """
    first, *others = parts
    found = [first]
    for part in others:
        in_whole = selection.transform(part.network, _whole_from_part(part, whole))
        in_first = selection.transform(in_whole, _whole_from_part(first, whole).inverse())
        found.append(replace(part, network=in_first))
    return found


def _whole_from_part(part: Part, whole: Network) -> Sim3:
    pose = whole.cam_from_world[part.images]
    return selection.between(part.network.cam_from_world, pose)


def centres(parts: Sequence[Part]) -> NDArray:
    """Return all projection centres, (V, 3); of fixed images, those in the first part."""
    found = np.empty((1 + max(part.images.max() for part in parts), 3))
    for part in reversed(parts):
        found[part.images] = selection.centres(part.network)
    return found


def views(
    parts: Sequence[Part], names: Sequence[str], sizes: Sequence[tuple[int, int]]
) -> list[Camera]:
    """Return all images as cameras with the images' `names`; of fixed images, the first part's.

    `sizes` (width, height), px, are of the pictures of each lens.
    """
    found: dict[str, Camera] = {}
    for part in reversed(parts):
        of_part = [names[at] for at in part.images]
        of_lenses = [sizes[lens] for lens in part.network.lens_of_image]
        found |= {c.name: c for c in conversion.cameras_of(part.network, of_part, of_lenses)}
    return [found[name] for name in names]


def points(parts: Sequence[Part]) -> NDArray:
    """Return the tie points of all parts, (N, 3); a point in several parts is repeated."""
    return np.concatenate([part.network.xyz for part in parts])


def residual_spread(parts: Sequence[Part]) -> float:
    """Return the median over parts of `selection.residual_spread`, px."""
    return float(np.median([selection.residual_spread(part.network) for part in parts]))
