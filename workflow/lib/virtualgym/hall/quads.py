"""What a virtual scene is made of: textured parallelograms, and boxes of them."""

from dataclasses import dataclass

import numpy as np

SUN = np.array([0.12, -0.08, 0.2])  # how much brighter a face is per unit of its outward normal
AMBIENT = 0.82


@dataclass(frozen=True, eq=False)
class Quad:
    """A textured parallelogram, seen from both sides.

    Attributes
    ----------
    origin : (3,) float
        World, metres: the outer corner of the texture's first pixel.
    u, v : (3,) float
        Edges from there, metres, along the texture's columns (to the right) and rows (down).
    texture : (h, w, 3) uint8
        BGR. Quads that share one array share its place in memory.
    light : float
        Factor on the texture's colour; lamps have more than 1.
    """

    origin: np.ndarray
    u: np.ndarray
    v: np.ndarray
    texture: np.ndarray
    light: float = 1.0

    def __post_init__(self):
        for field in ("origin", "u", "v"):
            object.__setattr__(self, field, np.array(getattr(self, field), dtype=float))
        if self.texture.dtype != np.uint8 or self.texture.ndim != 3 or self.texture.shape[2] != 3:
            found = f"{self.texture.dtype} {self.texture.shape}"
            raise ValueError(f"expected a texture (h, w, 3) of uint8, found {found}")


def box(corner, edges, textures, *, light=1.0):
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
        Factor on all faces, besides that of the direction they face.

    Returns
    -------
    quads : list of Quad, length 6
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
    outward = np.cross(down, across)  # all at once: six calls take four times as long
    return [
        Quad(*face, texture, light * _facing(way))
        for face, texture, way in zip(faces, textures, outward, strict=True)
    ]


def _facing(outward):
    """Return the light on a face with this outward normal, of any length."""
    return float(AMBIENT + SUN @ outward / np.linalg.norm(outward))
