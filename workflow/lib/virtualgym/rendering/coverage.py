"""Cast rays at moving surfaces in one picture: colour, and coverage of each pixel."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray

from virtualgym.rendering import shading
from virtualgym.rendering.rolling_shutter import Box, Screen

# Moments of the exposure at which triangles are cast, by how far they move at most, px. Every count
# is a multiple or a divisor of RAYS.
MOMENTS = {0.8: 1, 2.6: 2, 5.2: 4, 10.4: 8, 16.0: 12, 31.0: 24, np.inf: 32}
OFFSETS = shading.SUBPIXELS.astype(np.float32)  # of a pixel's rays from its centre
RAYS = len(OFFSETS)  # least number of rays of each pixel
ALONG = np.array([[0, 0, 1]], np.float32)
NEAREST_M = 0.1  # nearer surfaces are left out
NEAR_PX = 1e-3  # margin for rounding: rays this close to a triangle count as hits


@dataclass(frozen=True, eq=False)
class _Piece:
    """A scene for rays, the triangles it holds, and the pixels that may see them."""

    scene: EmbreeScene
    kept: np.ndarray
    pixels: np.ndarray


def cover(screens: Sequence[Screen], box: Box, solid_m: NDArray, net_m: NDArray) -> NDArray:
    """Cast rays at surfaces that may occlude each other.

    Parameters
    ----------
    screens : list of Screen
    box : (int, int, int, int)
        First column, first row, and one beyond the last of each.
    solid_m, net_m : (h, w) float
        Depth of the hall and of the net's mesh in the pixels of the box; inf where none is.

    Returns
    -------
    layer : (h, w, 4) float32
        BGR times coverage, 0..255, and coverage, 0..1.

    Notes
    -----
    Rays are cast in picture coordinates, parallel to the depth axis: rolling shutter and lens are
    then exact at every vertex, and triangles are so small that their edges are straight in the
    picture. Only faces towards the camera are cast, and only fast ones at several moments.
    """
    shape = box[3] - box[1], box[2] - box[0]
    surface = _Surface(screens, np.array([*box[:2], 0.0]))
    parts = surface.parts()
    hall = np.asarray(solid_m, np.float32).ravel(), np.asarray(net_m, np.float32).ravel()
    layer = np.zeros((shape[0] * shape[1], 4), np.float32)
    n_rays = max(RAYS, *parts) if parts else 0
    for first in range(0, n_rays, RAYS):
        rays = range(first, first + RAYS)
        _add(layer, _hits(_casts(surface, parts, rays, n_rays, shape), shape), surface, hall)
    return (layer / max(n_rays, 1)).reshape(*shape, 4)


class _Surface:
    """All surfaces together, with consecutive indices."""

    def __init__(self, screens: Sequence[Screen], corner: NDArray) -> None:
        first = np.cumsum([0] + [len(screen.moving.vertices) for screen in screens])
        moving = [screen.moving for screen in screens]
        parts = [each.triangles + start for each, start in zip(moving, first, strict=False)]
        self.triangles = np.concatenate(parts)
        self.colours = np.concatenate([each.colours for each in moving]).astype(np.float32)
        self.light = np.concatenate([each.light() for each in moving])
        self._screens, self._corner = screens, corner[:, np.newaxis]
        self._made: dict[tuple[int, int], _Piece] = {}
        self._corners = np.ascontiguousarray(self.triangles.T)
        self._blur_px = np.nan_to_num(np.concatenate([screen.blur_px for screen in screens]))

    def at(self, share: float) -> NDArray:
        """Return the vertices (3, V) at a moment of the exposure, in px of the box."""
        return np.hstack([screen.at(share).T for screen in self._screens]) - self._corner

    def parts(self) -> dict[int, NDArray]:
        """Return {number of moments: triangles cast at so many}, those that face the camera."""
        x, y, depth = self.at(0.0)
        with np.errstate(invalid="ignore"):
            seen = np.isfinite(x) & np.isfinite(y) & np.isfinite(depth) & (depth > NEAREST_M)
        if not seen.all():
            x, y = np.nan_to_num(x), np.nan_to_num(y)
        a, b, c = self._corners
        xa, ya = x[a], y[a]
        # Counter-clockwise seen from outside; negative, as pixel rows count downwards.
        towards = (x[b] - xa) * (y[c] - ya) - (x[c] - xa) * (y[b] - ya) < 0
        if not seen.all():
            towards &= seen[a] & seen[b] & seen[c]
        shown = np.flatnonzero(towards)
        farthest = np.maximum.reduce([self._blur_px[corner[shown]] for corner in (a, b, c)])
        needed = np.searchsorted(list(MOMENTS), farthest)
        counts = np.array(list(MOMENTS.values()))[needed]
        return {int(count): shown[counts == count] for count in np.unique(counts)}

    def piece(self, kept: NDArray, count: int, moment: int, shape: tuple[int, int]) -> _Piece:
        """Return triangles at one of `count` moments of the exposure, ready for rays."""
        if (count, moment) not in self._made:
            vertices = self.at((moment + 0.5) / count - 0.5).astype(np.float32)
            corners = self._corners[:, kept]
            first, last = spans(vertices, corners)
            near = _near(first, last, shape)
            self._made[count, moment] = _Piece(scene(vertices, corners), kept, near)
        return self._made[count, moment]


def scene(vertices: NDArray, corners: NDArray) -> EmbreeScene:
    """Make triangles with vertices (3, V) float32 and corners (3, F) int ready for rays."""
    ready = EmbreeScene()
    if corners.size:
        used = np.zeros(vertices.shape[1], bool)
        used[corners.ravel()] = True
        corners = (np.cumsum(used) - 1)[corners]
        # As tuples: embreex reads them one by one, and is far slower on rows of an array.
        triangles = np.fromiter(zip(*corners.tolist(), strict=True), object, corners.shape[1])
        TriangleMesh(ready, np.ascontiguousarray(vertices[:, used].T), triangles)
    return ready


def spans(vertices: NDArray, corners: NDArray) -> NDArray:
    """Return the bounding boxes (2, 2, F) of triangles: first and last; px across and down."""
    a, b, c = (vertices[:2, corner] for corner in corners)
    return np.stack([np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)])


def _near(first: NDArray, last: NDArray, shape: tuple[int, int]) -> NDArray:
    """Return the pixels (n,) of a box whose rays may hit triangles in these spans (2, F)."""
    reach = np.abs(shading.SUBPIXELS).max(axis=0)[:, np.newaxis] + NEAR_PX
    most = np.array(shape[::-1])[:, np.newaxis]
    left, top = np.clip(np.ceil(first - reach), 0, most).astype(int)
    right, bottom = np.clip(np.floor(last + reach) + 1, 0, most).astype(int)
    width = shape[1] + 1
    size = width * (shape[0] + 1)
    # Cumulative sum of spans that begin minus spans that end, across and down: above 0 inside of
    # one.
    rows = np.concatenate([top, bottom, top, bottom])
    columns = np.concatenate([left, right, right, left])
    signs = np.repeat([1.0, 1.0, -1.0, -1.0], len(top))
    begun = np.bincount(rows * width + columns, signs, minlength=size)
    inside = begun.reshape(-1, width).cumsum(axis=0).cumsum(axis=1)
    return np.flatnonzero(inside[:-1, :-1])


def _casts(
    surface: _Surface, parts: dict[int, NDArray], rays: range, n_rays: int, shape: tuple[int, int]
) -> Iterator[tuple[_Piece, NDArray]]:
    """Yield each piece that some of the rays are cast at, and these rays as indices of OFFSETS."""
    for count, kept in parts.items():
        moments = np.array([ray * count // n_rays for ray in rays])
        for moment in dict.fromkeys(moments.tolist()):
            yield surface.piece(kept, count, moment, shape), np.flatnonzero(moments == moment)


def _hits(casts: Iterable[tuple[_Piece, NDArray]], shape: tuple[int, int]) -> tuple[NDArray, ...]:
    """Return the nearest hits of rays.

    Parameters
    ----------
    casts : iterable of (_Piece, (m,) int)
        From `_casts`.
    shape : (int, int)
        Rows and columns.

    Returns
    -------
    ray, triangle : (n,) int
        Rays are numbered through all pixels for each offset.
    u, v, depth : (n,) float32
    """
    size = shape[0] * shape[1]
    triangle = np.full(RAYS * size, -1)
    where = np.full((3, RAYS * size), np.inf, np.float32)  # depth, u, v
    for piece, chosen in casts:
        row, column = np.divmod(piece.pixels, shape[1])
        start = np.zeros((len(chosen), len(row), 3), np.float32)
        start[..., 0] = column + OFFSETS[chosen, :1]
        start[..., 1] = row + OFFSETS[chosen, 1:]
        found = piece.scene.run(start.reshape(-1, 3), ALONG, output=True)
        ray = (chosen[:, np.newaxis] * size + piece.pixels).ravel()
        nearer = (found["primID"] >= 0) & (found["tfar"] < where[0, ray])
        ray = ray[nearer]
        triangle[ray] = piece.kept[found["primID"][nearer]]
        where[:, ray] = [found[key][nearer] for key in ("tfar", "u", "v")]
    ray = np.flatnonzero(triangle >= 0)
    depth, u, v = where[:, ray]
    return ray, triangle[ray], u, v, depth


def _add(
    layer: NDArray, hits: tuple[NDArray, ...], surface: _Surface, hall: tuple[NDArray, NDArray]
) -> None:
    """Add hits to the layer (n, 4), unless the hall is in front of them."""
    ray, triangle, u, v, depth = hits
    solid_m, net_m = hall
    free = depth < solid_m[ray % len(layer)]
    if not free.all():
        ray, triangle, u, v, depth = (part[free] for part in (ray, triangle, u, v, depth))
    pixel = ray % len(layer)
    a, b, c = surface.light[surface.triangles[triangle]].T
    colour = np.ones((len(ray), 4), np.float32)
    colour[:, :3] = surface.colours[triangle] * (a + u * (b - a) + v * (c - a))[:, None]
    behind = depth > net_m[pixel]
    if behind.any():
        colour[behind, :3] *= 1 - shading.NET_COVER
        colour[behind, :3] += shading.NET_COVER * shading.NET_BGR
    ends = np.searchsorted(ray, len(layer) * np.arange(RAYS + 1))
    for start, end in pairwise(ends):  # within one offset, each pixel occurs once
        layer[pixel[start:end]] += colour[start:end]
