"""Soft shadows of athletes on the floor, under the many lamps of a hall."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

# ASSUME: lamps and softness of shadows as in a hall, chosen by eye; they change pictures only.
CELL_M = 0.05
# Of larger meshes, only every n-th triangle casts a shadow, n times as strong.
MOST_TRIANGLES = 20000
LAMPS = np.array(  # direction (x, y) per metre of height, and fraction of the floor's light
    [
        [0.0, 0.0, 0.24],
        [0.5, 0.35, 0.09],
        [-0.5, 0.3, 0.09],
        [0.45, -0.4, 0.09],
        [-0.4, -0.45, 0.09],
    ]
)
LAYERS_M = 0.0, 0.12, 0.35, 0.8, 1.5  # lower limits of layers whose shadows are equally soft
SOFT_M = 0.05  # standard deviation of the blur at the floor
SOFTER = 0.11  # its increase per metre of height: angular size of a lamp
BEYOND_M = 0.4, 0.6  # reach of a shadow beyond the surface, and its increase per metre of height


@dataclass(frozen=True, eq=False)
class Shadow:
    """Light on a part of the floor.

    Attributes
    ----------
    corner_m : (2,) float
        World x and y of the first cell's centre.
    light : (rows along y, columns along x) float32
        Remaining fraction of the light.
    """

    corner_m: np.ndarray
    light: np.ndarray

    def outline(self) -> NDArray:
        """Return the corners of the part of the floor, (4, 3) m."""
        rows, columns = self.light.shape
        x, y = self.corner_m[:, None] + np.array([[0, 0], [columns, rows]]).T * CELL_M
        return np.array([[x[i], y[j], 0.0] for i in (0, 1) for j in (0, 1)])

    def seen(self, eye: NDArray, direction: NDArray) -> NDArray:
        """Return the light (H, W) float32 where rays from `eye` meet the floor.

        Rays (3, H, W) that do not point down see full light.
        """
        down = np.minimum(direction[2], np.float32(-1e-6))
        x, y = (
            (
                np.float32(eye[axis] - self.corner_m[axis])
                - np.float32(eye[2]) * direction[axis] / down
            )
            * np.float32(1 / CELL_M)
            for axis in (0, 1)
        )
        return cv2.remap(
            self.light, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=1.0
        )


def cast(vertices: NDArray, triangles: NDArray) -> Shadow:
    """Return the shadow of a closed surface: vertices (V, 3) m, triangles (F, 3).

    Notes
    -----
    A lamp does not light cells of the floor that two layers of the surface, front and back, cover
    as seen from it; the result is blurred by the size of the lamps.
    """
    every = -(-len(triangles) // MOST_TRIANGLES)
    middle, spread = _faces(vertices, triangles[::every])
    spread *= every / 2
    beyond_m = BEYOND_M[0] + BEYOND_M[1] * max(middle[2].max(), 0)
    low = middle[:2].min(axis=1) - beyond_m
    shape = np.ceil((middle[:2].max(axis=1) + beyond_m - low) / CELL_M).astype(int)
    light = np.full(shape[::-1], 1 - LAMPS[:, 2].sum(), np.float32)
    layer = np.digitize(middle[2], LAYERS_M[1:])
    for x, y, share in LAMPS:
        cover = np.abs(spread @ np.array([x, y, 1.0])) / CELL_M**2
        place = [
            np.floor((middle[axis] - middle[2] * way - low[axis]) / CELL_M).astype(int)
            for axis, way in enumerate((x, y))
        ]
        light += np.float32(share) * np.maximum(1 - _covered(place, layer, cover, shape) / 2, 0)
    return Shadow(low + CELL_M / 2, light)


def _faces(vertices: NDArray, triangles: NDArray) -> tuple[NDArray, NDArray]:
    """Return the centres (3, F) of triangles, and their area vectors times two (F, 3)."""
    a, b, c = (np.take(np.ascontiguousarray(vertices.T), corner, axis=1) for corner in triangles.T)
    middle = (a + b + c) / 3
    (ux, uy, uz), (wx, wy, wz) = b - a, c - a
    return middle, np.stack([uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx], axis=1)


def _covered(place: Sequence[NDArray], layer: NDArray, cover: NDArray, shape: NDArray) -> NDArray:
    """Return the number of surface layers over each cell (rows, columns), softer from higher up."""
    (x, y), size = place, shape[0] * shape[1]
    inside = (x >= 0) & (x < shape[0]) & (y >= 0) & (y < shape[1])
    if not inside.all():
        x, y, layer, cover = (part[inside] for part in (x, y, layer, cover))
    cell = layer * size + y * shape[0] + x
    counted = np.bincount(cell, cover, minlength=size * len(LAYERS_M)).astype(np.float32)
    total = np.zeros(shape[::-1], np.float32)
    heights = [*LAYERS_M, 2 * LAYERS_M[-1] - LAYERS_M[-2]]
    for number, part in enumerate(counted.reshape(len(LAYERS_M), *shape[::-1])):
        sigma_m = SOFT_M + SOFTER * (heights[number] + heights[number + 1]) / 2
        total += cv2.GaussianBlur(part, (0, 0), sigma_m / CELL_M, borderType=cv2.BORDER_CONSTANT)
    return total
