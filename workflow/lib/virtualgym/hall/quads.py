"""The elements of a virtual scene: textured parallelograms, and boxes made of them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

# ASSUME: light chosen by eye, so that faces of a box differ; it changes pictures only.
SUN = np.array([0.12, -0.08, 0.2])  # added light per unit of a face's outward normal
AMBIENT = 0.82


@dataclass(frozen=True, eq=False)
class Quad:
    """A textured parallelogram, seen from both sides.

    Attributes
    ----------
    origin : (3,) float
        World, metres: the outer corner of the texture's first pixel.
    u, v : (3,) float
        Edges from there, metres: u along a texture row (to the right), v along a column (down).
    texture : (h, w, 3) uint8
        BGR; quads may share one array.
    light : float
        Factor on the texture's colour; above 1 for lamps.
    """

    origin: np.ndarray
    u: np.ndarray
    v: np.ndarray
    texture: np.ndarray
    light: float = 1.0

    def __post_init__(self) -> None:
        for field in ("origin", "u", "v"):
            object.__setattr__(self, field, np.array(getattr(self, field), dtype=float))
        if self.texture.dtype != np.uint8 or self.texture.ndim != 3 or self.texture.shape[2] != 3:
            found = f"{self.texture.dtype} {self.texture.shape}"
            raise ValueError(f"expected a texture (h, w, 3) of uint8, found {found}")


def box(
    corner: ArrayLike, edges: ArrayLike, textures: NDArray | list[NDArray], *, light: float = 1.0
) -> list[Quad]:
    """Return the six outward faces of a box (or parallelepiped).

    Parameters
    ----------
    corner : (3,) float
        World, metres.
    edges : (3, 3) float
        Rows: its three edges from that corner, metres, right-handed; the third points up.
    textures : (h, w, 3) uint8 array, or a list of six of them
        Of the faces at -second, +first, +second, -first edge, top and bottom; the upright ones have
        their first row at the top.
    light : float
        Factor on all faces, besides the shading by their direction.
    """
    first, second, up = np.asarray(edges, dtype=float)
    corner = np.asarray(corner, dtype=float)
    if isinstance(textures, np.ndarray):
        textures = [textures] * 6
    faces = [
        (corner + up, first, -up),
        (corner + first + up, second, -up),
        (corner + first + second + up, -first, -up),
        (corner + second + up, -second, -up),
        (corner + second + up, first, -second),
        (corner, first, second),
    ]
    _, across, down = (np.array(each) for each in zip(*faces, strict=True))
    outward = np.cross(down, across)  # one call: six calls take four times as long
    return [
        Quad(*face, texture, light * _facing(way))
        for face, texture, way in zip(faces, textures, outward, strict=True)
    ]


def _facing(outward: NDArray) -> float:
    """Return the light on a face; its outward normal may have any length."""
    return float(AMBIENT + SUN @ outward / np.linalg.norm(outward))
