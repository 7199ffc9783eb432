"""Rays against surfaces in the pixels of one picture: colours, and how much of each pixel they cover."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from virtualgym.rendering import shading

MOMENTS = {
    0.8: 1,
    2.6: 2,
    5.2: 4,
    10.4: 8,
    16.0: 12,
    31.0: 24,
    np.inf: 32,
}  # of what moves no farther, px
OFFSETS = shading.SUBPIXELS.astype(np.float32)  # of a pixel's rays from its middle
RAYS = len(OFFSETS)  # at least, of each pixel: every number of moments is a multiple or a divisor
ALONG = np.array([[0, 0, 1]], np.float32)
NEAREST_M = 0.1  # surfaces that come nearer are left out
NEAR_PX = 1e-3  # rays that pass a triangle nearer than that count as if they met it


@dataclass(frozen=True, eq=False)
class _Piece:
    """What rays are cast at: a scene, which triangles it holds, and which pixels may see them."""

    scene: EmbreeScene
    kept: np.ndarray
    pixels: np.ndarray


def cover(screens, box, solid_m, net_m):
    """Cast rays at surfaces that may hide one another.

    Parameters
    ----------
    screens : list of onscreen.Screen
    box : (int, int, int, int)
        First column, first row, and one beyond the last of each.
    solid_m, net_m : (h, w) float
        How far what stands in the hall, and the net's mesh, is in the pixels of the box; inf where none is.

    Returns
    -------
    layer : (h, w, 4) float32
        BGR times cover, 0..255, and cover, 0..1.

    Notes
    -----
    Surfaces are cast as the picture shows them, with parallel rays along the depth: rolling shutter and lens
    are then exact at every corner, and triangles are so small that they are straight in the picture. Only
    faces towards the camera are cast, and only what is fast is cast at several moments.
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
    """All surfaces together, numbered through."""

    def __init__(self, screens, corner):
        first = np.cumsum([0] + [len(screen.moving.vertices) for screen in screens])
        moving = [screen.moving for screen in screens]
        parts = [each.triangles + start for each, start in zip(moving, first, strict=False)]
        self.triangles = np.concatenate(parts)
        self.colours = np.concatenate([each.colours for each in moving]).astype(np.float32)
        self.light = np.concatenate([each.light() for each in moving])
        self._screens, self._corner, self._made = screens, corner[:, np.newaxis], {}
        self._corners = np.ascontiguousarray(self.triangles.T)
        self._blur_px = np.nan_to_num(np.concatenate([screen.blur_px for screen in screens]))

    def at(self, share):
        """Return the vertices (3, V) at a moment of the exposure, in the box."""
        return np.hstack([screen.at(share).T for screen in self._screens]) - self._corner

    def parts(self):
        """Return {number of moments: triangles to cast at so many}, those towards the camera."""
        x, y, depth = self.at(0.0)
        with np.errstate(invalid="ignore"):
            seen = np.isfinite(x) & np.isfinite(y) & np.isfinite(depth) & (depth > NEAREST_M)
        if not seen.all():
            x, y = np.nan_to_num(x), np.nan_to_num(y)
        a, b, c = self._corners
        xa, ya = x[a], y[a]
        # Counter-clockwise seen from outside, but pixels count downwards.
        towards = (x[b] - xa) * (y[c] - ya) - (x[c] - xa) * (y[b] - ya) < 0
        if not seen.all():
            towards &= seen[a] & seen[b] & seen[c]
        shown = np.flatnonzero(towards)
        farthest = np.maximum.reduce([self._blur_px[corner[shown]] for corner in (a, b, c)])
        needed = np.searchsorted(list(MOMENTS), farthest)
        counts = np.array(list(MOMENTS.values()))[needed]
        return {int(count): shown[counts == count] for count in np.unique(counts)}

    def piece(self, kept, count, moment, shape):
        """Return triangles at one of so many moments of the exposure, ready for rays."""
        if (count, moment) not in self._made:
            vertices = self.at((moment + 0.5) / count - 0.5).astype(np.float32)
            corners = self._corners[:, kept]
            near = _near(*spans(vertices, corners), shape)
            self._made[count, moment] = _Piece(scene(vertices, corners), kept, near)
        return self._made[count, moment]


def scene(vertices, corners):
    """Make triangles ready for rays.

    Parameters
    ----------
    vertices : (3, V) float32
    corners : (3, F) int

    Returns
    -------
    scene : EmbreeScene
    """
    ready = EmbreeScene()
    if corners.size:
        used = np.zeros(vertices.shape[1], bool)
        used[corners.ravel()] = True
        corners = (np.cumsum(used) - 1)[corners]
        # As tuples: embreex takes them one by one, and far longer over rows of an array.
        triangles = np.fromiter(zip(*corners.tolist(), strict=True), object, corners.shape[1])
        TriangleMesh(ready, np.ascontiguousarray(vertices[:, used].T), triangles)
    return ready


def spans(vertices, corners):
    """Return where triangles begin and end, (2, 2, F): first and last; px across and down.

    Parameters
    ----------
    vertices : (3, V) float32
    corners : (3, F) int
    """
    a, b, c = (vertices[:2, corner] for corner in corners)
    return np.stack([np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)])


def _near(first, last, shape):
    """Return the pixels (n,) of a box of which a ray may meet what lies in these spans (2, F)."""
    reach = np.abs(shading.SUBPIXELS).max(axis=0)[:, np.newaxis] + NEAR_PX
    most = np.array(shape[::-1])[:, np.newaxis]
    left, top = np.clip(np.ceil(first - reach), 0, most).astype(int)
    right, bottom = np.clip(np.floor(last + reach) + 1, 0, most).astype(int)
    width = shape[1] + 1
    size = width * (shape[0] + 1)
    # How many spans begin less how many end up to a pixel, across and down: above 0 inside of one.
    rows = np.concatenate([top, bottom, top, bottom])
    columns = np.concatenate([left, right, right, left])
    signs = np.repeat([1.0, 1.0, -1.0, -1.0], len(top))
    begun = np.bincount(rows * width + columns, signs, minlength=size)
    inside = begun.reshape(-1, width).cumsum(axis=0).cumsum(axis=1)
    return np.flatnonzero(inside[:-1, :-1])


def _casts(surface, parts, rays, n_rays, shape):
    """Yield what some of the rays are cast at, and which of them, as places in OFFSETS."""
    for count, kept in parts.items():
        moments = np.array([ray * count // n_rays for ray in rays])
        for moment in dict.fromkeys(moments.tolist()):
            yield surface.piece(kept, count, moment, shape), np.flatnonzero(moments == moment)


def _hits(casts, shape):
    """Return what rays hit: which, numbered through all pixels for each offset, and where.

    Parameters
    ----------
    casts : iterable of (_Piece, (m,) int)
        Of `_casts`.
    shape : (int, int)
        Rows and columns.

    Returns
    -------
    ray, triangle : (n,) int
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


def _add(layer, hits, surface, hall):
    """Add what rays hit to the layer (n, 4), unless something in the hall is before it."""
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
    for start, end in pairwise(ends):  # in no offset a pixel comes twice
        layer[pixel[start:end]] += colour[start:end]
