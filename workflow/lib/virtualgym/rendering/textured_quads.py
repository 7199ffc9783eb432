"""Textured quads: one atlas of all textures, looked up at ray hits."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import ArrayLike, NDArray

from virtualgym.hall.quads import Quad

MAX_TAPS = 8  # along the longer side of a pixel's footprint
LOOKUP_WIDTH = 1024  # row length for cv2.remap, which needs a picture, not a line
TINY = np.float32(1e-6)  # against division by zero


class Surfaces:
    """Quads, ready for rays: an acceleration structure, planes, and an atlas of textures.

    Parameters
    ----------
    quads : iterable of Quad
    earlier : Surfaces or None
        Those of the last picture, whose atlas is used again if the textures are the same.
    """

    def __init__(self, quads: Iterable[Quad], earlier: "Surfaces | None" = None) -> None:
        self.quads = list(quads)
        origin, u, v = (
            np.array([getattr(q, name) for q in self.quads]) for name in ("origin", "u", "v")
        )
        normal = np.cross(u, v)
        self.origin = origin
        self.normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
        # Keep the textures, so that no new array gets the id of one of them.
        self.textures = {id(quad.texture): quad.texture for quad in self.quads}
        order = {key: index for index, key in enumerate(self.textures)}
        if earlier is not None and list(earlier.textures) == list(self.textures):
            packed = earlier.packed
        else:
            packed = pack(list(self.textures.values()))
        of_quad = np.array([order[id(quad.texture)] for quad in self.quads])
        sizes = packed.sizes[of_quad]
        # Dual vectors: texel = dual . (point - origin), also if u and v are not orthogonal.
        self.u_dual = _dual(u, v, self.normal) * sizes[:, :1]
        self.v_dual = _dual(v, u, self.normal) * sizes[:, 1:]
        self.packed: Atlas = packed
        self.width, self.height = np.ascontiguousarray(sizes.T.astype(np.float32))
        flat = packed.places[of_quad].reshape(-1, 4)
        self.place = np.ascontiguousarray(flat.T)  # indexed by quad * LEVELS + level
        self.light = np.array([quad.light for quad in self.quads], np.float32)
        corners = np.stack([origin, origin + u, origin + u + v, origin + v], axis=1)
        triangles = corners[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3).astype(np.float32)
        self._scene = EmbreeScene()
        self._mesh = TriangleMesh(self._scene, np.ascontiguousarray(triangles))

    def hit(self, origin: NDArray, direction: NDArray) -> NDArray:
        """Return the index of the nearest quad that each ray hits, -1 for none.

        Parameters
        ----------
        origin : (n, 3) or (3,) float32
        direction : (n, 3) float32
            Need not have unit length.
        """
        origin = np.broadcast_to(origin, direction.shape)
        triangle = self._scene.run(origin, direction, query="INTERSECT")
        return (triangle >> 1).astype(np.intp)


def _dual(along: NDArray, other: NDArray, normal: NDArray) -> NDArray:
    across = np.cross(other, normal)
    return across / np.einsum("ij,ij->i", across, along)[:, None]


class View:
    """The scene's planes seen from one point: homographies from ray directions to texels.

    A ray of direction d from the eye meets quad q at the texel (U d, V d) / (N d) and at the
    distance depth / (N d), in units of d. If the eye moves with a constant velocity, U, V and depth
    are exactly linear in time.

    Parameters
    ----------
    surfaces : Surfaces
    eye : (3,) float
        World, metres.
    steps : (2, 3) float
        Change of the direction per pixel to the right, and per pixel down.
    velocity : (3,) float or None
        Of the eye, m/s.
    """

    def __init__(
        self, surfaces: Surfaces, eye: ArrayLike, steps: ArrayLike, velocity: NDArray | None = None
    ) -> None:
        self.surfaces = surfaces
        self.eye = np.asarray(eye, dtype=float)
        self.velocity = velocity
        rel = surfaces.origin - self.eye
        normal, u_dual, v_dual = surfaces.normal, surfaces.u_dual, surfaces.v_dual
        depth = np.einsum("ij,ij->i", normal, rel)
        self.depth = depth.astype(np.float32)
        rows = [
            depth[:, None] * dual - np.einsum("ij,ij->i", dual, rel)[:, None] * normal
            for dual in (u_dual, v_dual)
        ]
        self.rows = _columns([*rows, normal])  # (3, 3, Q): row, component, quad
        self.steps = _columns([row @ np.asarray(steps).T for row in (*rows, normal)])
        if velocity is not None:
            rate = normal @ velocity
            self.depth_rate = (-rate).astype(np.float32)
            self.rates = _columns(
                [
                    -rate[:, None] * dual + (dual @ velocity)[:, None] * normal
                    for dual in (u_dual, v_dual)
                ]
            )

    def distance(self, quad: NDArray, direction: NDArray, time_s: NDArray | None) -> NDArray:
        """Return the distance to each ray's quad, (n,) float32, in units of its direction."""
        away = _take(self.depth, quad)
        if time_s is not None:
            away += _take(self.depth_rate, quad) * time_s
        below = _dot(self.rows[2], quad, direction)
        return away / _nonzero(below)

    def texels(
        self, quad: NDArray, direction: NDArray, time_s: NDArray | None
    ) -> tuple[NDArray, NDArray, NDArray, NDArray]:
        """Return where rays meet their quads, and the footprints of their pixels there.

        Parameters
        ----------
        quad : (n,) intp
        direction : (3, n) float32
        time_s : (n,) float32 or None

        Returns
        -------
        u, v : (n,) float32
            Texels.
        major : (2, n) float32
            The longer side of the pixel's footprint, texels.
        minor : (n,) float32
            Its shorter side.
        """
        below = _nonzero(_dot(self.rows[2], quad, direction))
        np.divide(1.0, below, out=below)
        at = []
        for index in (0, 1):
            value = _dot(self.rows[index], quad, direction)
            if time_s is not None:
                value += _dot(self.rates[index], quad, direction) * time_s
            value *= below
            at.append(value)
        sides = [
            [(_take(self.steps[i, s], quad) - at[i] * slope) * below for i in (0, 1)]
            for s, slope in ((s, _take(self.steps[2, s], quad)) for s in (0, 1))
        ]
        major, minor = _footprint(sides)
        return at[0], at[1], major, minor


def _columns(rows: Sequence[NDArray]) -> NDArray:
    return np.ascontiguousarray(np.stack(rows).transpose(0, 2, 1), dtype=np.float32)


def _take(table: NDArray, index: NDArray) -> NDArray:
    return table.take(index, mode="clip")  # "clip" is three times as fast as checking


def _dot(columns: NDArray, quad: NDArray, direction: NDArray) -> NDArray:
    total = _take(columns[0], quad)
    total *= direction[0]
    for axis in (1, 2):
        part = _take(columns[axis], quad)
        part *= direction[axis]
        total += part
    return total


def _nonzero(value: NDArray) -> NDArray:
    value[np.abs(value) < TINY] = TINY
    return value


def _footprint(sides: Sequence[Sequence[NDArray]]) -> tuple[NDArray, NDArray]:
    (ux, vx), (uy, vy) = sides
    square_x, square_y = ux * ux + vx * vx, uy * uy + vy * vy
    down = square_y > square_x
    major = np.stack([np.where(down, uy, ux), np.where(down, vy, vx)])
    length = np.sqrt(np.maximum(np.maximum(square_x, square_y), TINY))
    return major, np.abs(ux * vy - uy * vx) / length


def shade(
    view: View,
    quad: NDArray,
    direction: NDArray,
    time_s: NDArray | None = None,
    *,
    coarser: float = 0.0,
    taps: int = MAX_TAPS,
) -> NDArray:
    """Return the colours that rays see on their quads, with anisotropic filtering.

    Parameters
    ----------
    view : View
    quad : (n,) intp
    direction : (3, n) float32
    time_s : (n,) float32 or None
        Of each ray, where the eye moves.
    coarser : float
        Levels (powers of two) added to the texture level that the pixels need.
    taps : int
        Greatest number of lookups along a footprint.

    Returns
    -------
    colour : (n, 3) float32
        BGR, 0..255 times the quad's light.

    Notes
    -----
    Lookups of one footprint alternate between the two nearest levels in the right proportion: the
    same mean as trilinear interpolation at half its cost.
    """
    surfaces = view.surfaces
    u, v, major, minor = view.texels(quad, direction, time_s)
    np.clip(u, 0, _take(surfaces.width, quad), out=u)
    np.clip(v, 0, _take(surfaces.height, quad), out=v)
    length = np.sqrt(major[0] ** 2 + major[1] ** 2)
    np.maximum(minor, length * np.float32(1 / taps), out=minor)
    level = np.log2(np.maximum(minor, TINY)) + np.float32(coarser)
    np.clip(level, 0, LEVELS - 1.01, out=level)
    ratio = length / np.maximum(minor, TINY)
    sums = np.empty(len(u), np.uint64)
    light = _take(surfaces.light, quad)
    doublings = np.clip(np.ceil(np.log2(ratio)), 1, np.log2(taps)).astype(np.uint8)
    for doubling in np.unique(doublings):
        chosen = np.flatnonzero(doublings == doubling)
        parts = (x[chosen] for x in (u, v, major[0], major[1], level, quad))
        n_taps = 1 << int(doubling)
        sums[chosen] = _total(surfaces, n_taps, *parts).view(np.uint64).ravel()
        light[chosen] /= n_taps
    colour = np.empty((len(u), 3), np.float32)
    for channel in range(3):  # in a third of the time of all at once
        np.multiply(sums.view(np.uint16)[channel::4], light, out=colour[:, channel])
    return colour


def _total(
    surfaces: Surfaces,
    n_taps: int,
    u: NDArray,
    v: NDArray,
    du: NDArray,
    dv: NDArray,
    level: NDArray,
    quad: NDArray,
) -> NDArray:
    """Add up lookups along each footprint, (n, 4) of 16 bits."""
    total = np.zeros((len(u), 4), np.uint16)
    first = quad * LEVELS
    for tap in range(n_taps):
        share = np.float32((tap + 0.5) / n_taps)
        index = first + (level + share).astype(np.intp)
        x = (u + (share - np.float32(0.5)) * du) * _take(surfaces.place[2], index)
        y = (v + (share - np.float32(0.5)) * dv) * _take(surfaces.place[3], index)
        x += _take(surfaces.place[0], index)
        y += _take(surfaces.place[1], index)
        total += lookup(surfaces.packed.image, x, y)
    return total


def lookup(image: NDArray, x: NDArray, y: NDArray) -> NDArray:
    """Return the colours of an image at points, bilinear.

    Parameters
    ----------
    image : (h, w, 4) uint8
    x, y : (n,) float32
        Px, the first pixel's centre at (0, 0).

    Returns
    -------
    colours : (n, 4) uint8
    """
    short = -len(x) % LOOKUP_WIDTH
    places = np.zeros((2, len(x) + short), np.float32)
    places[0, : len(x)], places[1, : len(x)] = x, y
    across, down = places.reshape(2, -1, LOOKUP_WIDTH)
    found = cv2.remap(image, across, down, cv2.INTER_LINEAR)
    return found.reshape(-1, 4)[: len(x)]


LEVELS = 10  # enough to halve 512 texels to one
BORDER = 1  # bilinear lookups reach half a texel beyond the edge
LARGEST = 32766  # cv2.remap counts source pixels in 16 bits


@dataclass(frozen=True, eq=False)
class Atlas:
    """Packed textures.

    Attributes
    ----------
    image : (h, w, 4) uint8
        BGR and an unused channel: four channels are twice as fast to look up as three.
    places : (T, LEVELS, 4) float32
        x, y in the image of each texture's first corner at each level, minus half a pixel; and the
        level's size over the full one, in x and y. Levels beyond the last repeat it.
    sizes : (T, 2) float
        Width and height of the textures, texels.
    """

    image: np.ndarray
    places: np.ndarray
    sizes: np.ndarray


def pack(textures: Sequence[NDArray]) -> "Atlas":
    """Pack textures (h, w, 3) uint8 and their smaller levels into an atlas, in this order."""
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


def _chain(texture: NDArray) -> list[NDArray]:
    """Return the texture and its smaller levels, each averaged from the one before."""
    chain = [texture]
    while max(chain[-1].shape[:2]) > 1 and len(chain) < LEVELS:
        height, width = chain[-1].shape[:2]
        size = ((width + 1) // 2, (height + 1) // 2)
        chain.append(cv2.resize(chain[-1], size, interpolation=cv2.INTER_AREA))
    return chain


def _block_size(chain: Sequence[NDArray]) -> tuple[int, int]:
    """Return the (width, height) of level 0 with a column of the other levels to its right."""
    sizes = np.array([level.shape[1::-1] for level in chain]) + 2 * BORDER
    right = sizes[1:].max(axis=0, initial=0)[0]
    return sizes[0, 0] + right, max(sizes[0, 1], sizes[1:, 1].sum())


def _shelves(blocks: NDArray) -> tuple[NDArray, tuple[int, int]]:
    """Place blocks (T, 2) in rows, tallest first; return their corners (T, 2) and the size used."""
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


def _fill(image: NDArray, chain: Sequence[NDArray], corner: NDArray, place: NDArray) -> None:
    x, y = corner
    full_height, full_width = chain[0].shape[:2]
    for level, texture in enumerate(chain):
        height, width = texture.shape[:2]
        framed = cv2.copyMakeBorder(texture, BORDER, BORDER, BORDER, BORDER, cv2.BORDER_REPLICATE)
        image[y : y + height + 2 * BORDER, x : x + width + 2 * BORDER, :3] = framed
        ratio = width / full_width, height / full_height
        place[level:] = x + BORDER - 0.5, y + BORDER - 0.5, *ratio
        if level == 0:
            x += width + 2 * BORDER
        else:
            y += height + 2 * BORDER
