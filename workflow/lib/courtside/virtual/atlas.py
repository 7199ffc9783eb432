"""All textures of a scene, each at every power of two smaller, in one picture: one lookup serves all."""

from dataclasses import dataclass

import cv2
import numpy as np

LEVELS = 10
BORDER = 1  # bilinear lookups reach half a texel beyond the edge
LARGEST = 32766  # cv2.remap counts source pixels in 16 bits


@dataclass(frozen=True, eq=False)
class Atlas:
    """Packed textures.

    Attributes
    ----------
    image : (h, w, 4) uint8
        BGR and an unused channel: four are twice as fast to look up as three.
    places : (T, LEVELS, 4) float32
        x, y in the image of each texture's first corner at each level, minus half a pixel; and that level's
        size over the full one, in x and y. Levels beyond the last repeat it.
    sizes : (T, 2) float
        Width and height of the textures, texels.
    """

    image: np.ndarray
    places: np.ndarray
    sizes: np.ndarray


def pack(textures):
    """Pack textures with their smaller levels.

    Parameters
    ----------
    textures : list of (h, w, 3) uint8

    Returns
    -------
    atlas : Atlas
        In the order given.
    """
    chains = [_chain(texture) for texture in textures]
    blocks = np.array([_block_size(chain) for chain in chains])
    corners, (width, height) = _shelves(blocks)
    if max(width, height) > LARGEST:
        raise ValueError(f"expected textures that fit {LARGEST} px, found {width} x {height}")
    image = np.zeros((height, width, 4), np.uint8)
    places = np.empty((len(textures), LEVELS, 4), np.float32)
    for chain, corner, place in zip(chains, corners, places, strict=True):
        _fill(image, chain, corner, place)
    sizes = np.array([texture.shape[1::-1] for texture in textures], dtype=float)
    return Atlas(image, places, sizes)


def _chain(texture):
    """Return the texture and its halves, quarters ..., each averaged from the one before."""
    chain = [texture]
    while max(chain[-1].shape[:2]) > 1 and len(chain) < LEVELS:
        height, width = chain[-1].shape[:2]
        size = ((width + 1) // 2, (height + 1) // 2)
        chain.append(cv2.resize(chain[-1], size, interpolation=cv2.INTER_AREA))
    return chain


def _block_size(chain):
    """Return width and height of a chain laid out as level 0 with a column of the others to its right."""
    sizes = np.array([level.shape[1::-1] for level in chain]) + 2 * BORDER
    right = sizes[1:].max(axis=0, initial=0)[0]
    return sizes[0, 0] + right, max(sizes[0, 1], sizes[1:, 1].sum())


def _shelves(blocks):
    """Place blocks (T, 2) on shelves, tallest first; return their corners (T, 2) and the size used."""
    width = int(max(blocks[:, 0].max(), min(8192, np.sqrt(blocks.prod(axis=1).sum()) * 1.2)))
    corners = np.empty_like(blocks)
    x = y = tallest = 0
    for index in np.argsort(-blocks[:, 1], kind="stable"):
        if x + blocks[index, 0] > width:
            x, y, tallest = 0, y + tallest, 0
        corners[index] = x, y
        x += blocks[index, 0]
        tallest = max(tallest, blocks[index, 1])
    return corners, (width, int(y + tallest))


def _fill(image, chain, corner, place):
    x, y = corner
    full_height, full_width = chain[0].shape[:2]
    for level, texture in enumerate(chain):
        height, width = texture.shape[:2]
        framed = cv2.copyMakeBorder(texture, *[BORDER] * 4, cv2.BORDER_REPLICATE)
        image[y : y + height + 2 * BORDER, x : x + width + 2 * BORDER, :3] = framed
        ratio = width / full_width, height / full_height
        place[level:] = x + BORDER - 0.5, y + BORDER - 0.5, *ratio
        if level == 0:
            x += width + 2 * BORDER
        else:
            y += height + 2 * BORDER
