"""Rays against surfaces in the pixels of one picture: colours, and how much of each pixel they cover."""

from dataclasses import dataclass

import cv2
import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from courtside.virtual import exposure

MOMENTS = {
    0.8: 1,
    2.6: 2,
    5.2: 4,
    10.4: 8,
    16.0: 12,
    31.0: 24,
    np.inf: 32,
}  # of what moves no farther, px
RAYS = len(exposure.SUBPIXELS)  # at least, of each pixel
NEAREST_M = 0.1  # surfaces that come nearer are left out
CELL_PX = 8  # rays are cast in the cells of that size that hold a corner, and in those round them
BESIDE = np.ones((3, 3), np.uint8)


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
    row, column = np.indices(shape, np.float32).reshape(2, -1)
    centres = np.stack([column, row, np.zeros_like(row)], axis=1)
    hall = np.asarray(solid_m, np.float32).ravel(), np.asarray(net_m, np.float32).ravel()
    layer = np.zeros((len(row), 4), np.float32)
    n_rays = max(RAYS, *parts) if parts else 0
    for ray in range(n_rays):
        pieces = [
            surface.piece(parts[count], count, ray * count // n_rays, shape) for count in parts
        ]
        places = centres + np.float32([*exposure.SUBPIXELS[ray % RAYS], 0.0])
        _add(layer, _hits(pieces, places), surface, hall)
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
        self._screens, self._corner, self._made = screens, corner, {}
        self._blur_px = np.nan_to_num(np.concatenate([screen.blur_px for screen in screens]))

    def at(self, share):
        """Return the vertices (V, 3) at a moment of the exposure, in the box."""
        return np.concatenate([screen.at(share) for screen in self._screens]) - self._corner

    def parts(self):
        """Return the triangles that face the camera, by how many moments they need: dict of int to (n,)."""
        vertices = self.at(0.0)
        with np.errstate(invalid="ignore"):
            seen = np.isfinite(vertices).all(axis=1) & (vertices[:, 2] > NEAREST_M)
        x, y = np.nan_to_num(vertices[:, :2]).T[:, self.triangles]
        # Counter-clockwise seen from outside, but pixels count downwards.
        area = (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
        shown = np.flatnonzero((area < 0) & seen[self.triangles].all(axis=1))
        needed = np.searchsorted(list(MOMENTS), self._blur_px[self.triangles[shown]].max(axis=1))
        counts = np.array(list(MOMENTS.values()))[needed]
        return {int(count): shown[counts == count] for count in np.unique(counts)}

    def piece(self, kept, count, moment, shape):
        """Return triangles at one of so many moments of the exposure, ready for rays."""
        if (count, moment) not in self._made:
            corners, inverse = np.unique(self.triangles[kept], return_inverse=True)
            vertices = self.at((moment + 0.5) / count - 0.5)[corners].astype(np.float32)
            triangles = inverse.reshape(-1, 3).astype(np.int32)
            scene = EmbreeScene()
            TriangleMesh(scene, vertices, triangles)
            self._made[count, moment] = _Piece(scene, kept, _near(vertices[triangles], shape))
        return self._made[count, moment]


def _near(corners, shape):
    """Return the pixels (n,) of a box that may see triangles (F, 3, 3): whole cells of it."""
    cells = [-(-length // CELL_PX) for length in shape]
    occupied = np.zeros(cells, np.uint8)
    size_px = np.ptp(corners[:, :, :2], axis=1).max(axis=1)
    long = size_px > CELL_PX
    points = [corners.reshape(-1, 3)]
    if long.any():  # points all over them, no cell apart
        n = int(np.ceil(size_px.max() / CELL_PX))
        shares = [(i / n, j / n, (n - i - j) / n) for i in range(n + 1) for j in range(n + 1 - i)]
        points.append((np.array(shares) @ corners[long]).reshape(-1, 3))
    column, row, _ = (np.concatenate(points).T / CELL_PX).astype(int)
    inside = (row >= 0) & (row < cells[0]) & (column >= 0) & (column < cells[1])
    occupied[row[inside], column[inside]] = 1
    whole = cv2.dilate(occupied, BESIDE).repeat(CELL_PX, axis=0).repeat(CELL_PX, axis=1)
    return np.flatnonzero(whole[: shape[0], : shape[1]])


def _hits(pieces, places):
    """Return which pixels see a triangle, which one, where in it (u, v), and how far it is, each (n,)."""
    triangle = np.full(len(places), -1)
    where = np.full((3, len(places)), np.inf, np.float32)  # depth, u, v
    for piece in pieces:
        start = places[piece.pixels]
        along = np.zeros_like(start)
        along[:, 2] = 1
        found = piece.scene.run(start, along, output=True)
        nearer = (found["primID"] >= 0) & (found["tfar"] < where[0, piece.pixels])
        pixel = piece.pixels[nearer]
        triangle[pixel] = piece.kept[found["primID"][nearer]]
        where[:, pixel] = [found[key][nearer] for key in ("tfar", "u", "v")]
    pixel = np.flatnonzero(triangle >= 0)
    depth, u, v = where[:, pixel]
    return pixel, triangle[pixel], u, v, depth


def _add(layer, hits, surface, hall):
    """Add what rays hit to the layer (n, 4), unless something in the hall is before it."""
    pixel, triangle, u, v, depth = hits
    solid_m, net_m = hall
    free = depth < solid_m[pixel]
    if not free.all():
        pixel, triangle, u, v, depth = (part[free] for part in (pixel, triangle, u, v, depth))
    a, b, c = surface.light[surface.triangles[triangle]].T
    colour = surface.colours[triangle] * (a + u * (b - a) + v * (c - a))[:, None]
    behind = depth > net_m[pixel]
    if behind.any():
        colour[behind] *= 1 - exposure.NET_COVER
        colour[behind] += exposure.NET_COVER * exposure.NET_BGR
    layer[pixel, :3] += colour
    layer[pixel, 3] += 1
