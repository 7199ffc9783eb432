"""A mesh of plain-coloured triangles: the surface of an athlete or a racket."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles of one colour each.

    Attributes
    ----------
    vertices : (V, 3) float32
        Metres.
    triangles : (F, 3) int32
        Corners, counter-clockwise seen from outside.
    colours : (F, 3) uint8
        BGR.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    colours: np.ndarray

    def __post_init__(self) -> None:
        vertices = np.ascontiguousarray(self.vertices, dtype=np.float32)
        triangles = np.ascontiguousarray(self.triangles, dtype=np.int32)
        if vertices.ndim != 2 or vertices.shape[1] != 3:
            raise ValueError(f"expected vertices (V, 3), found {vertices.shape}")
        if triangles.ndim != 2 or triangles.shape[1] != 3:
            raise ValueError(f"expected triangles (F, 3), found {triangles.shape}")
        if len(triangles) and not 0 <= triangles.min() <= triangles.max() < len(vertices):
            raise ValueError(f"expected corners among {len(vertices)} vertices, found others")
        if self.colours.shape != triangles.shape or self.colours.dtype != np.uint8:
            found = f"{self.colours.dtype} {self.colours.shape}"
            raise ValueError(f"expected colours {triangles.shape} of uint8, found {found}")
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "triangles", triangles)


def join(meshes: Sequence[Mesh]) -> Mesh:
    """Join meshes, at least one, in their order."""
    counts = [len(mesh.vertices) for mesh in meshes]
    starts = np.cumsum([0, *counts[:-1]])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([m.triangles + start for m, start in zip(meshes, starts, strict=True)]),
        np.concatenate([mesh.colours for mesh in meshes]),
    )


def normals(vertices: NDArray, triangles: NDArray) -> NDArray:
    """Return the outward unit normal of each vertex, the mean over its triangles by area.

    Parameters
    ----------
    vertices : (V, 3) float
    triangles : (F, 3) int

    Returns
    -------
    normals : (V, 3) float
        Zero for a vertex without triangles.
    """
    triangles = np.asarray(triangles)
    places = np.ascontiguousarray(np.asarray(vertices, dtype=float).T)
    a, b, c = (np.take(places, corner, axis=1) for corner in triangles.T)
    (ux, uy, uz), (wx, wy, wz) = b - a, c - a
    faces = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx  # length: twice the area
    corner = triangles.ravel()
    summed = [np.bincount(corner, np.repeat(part, 3), len(vertices)) for part in faces]
    length = np.sqrt(summed[0] ** 2 + summed[1] ** 2 + summed[2] ** 2)
    length[length == 0] = 1
    return np.stack([part / length for part in summed], axis=1)


def volume(vertices: NDArray, triangles: NDArray) -> float:
    """Return the volume of a closed mesh, m3: the sum of signed tetrahedra (divergence theorem).

    It is positive if triangles face outwards; small holes count as closed towards the mesh's
    centre.
    """
    vertices = np.asarray(vertices, dtype=float)
    first, second, third = np.moveaxis(vertices[triangles] - vertices.mean(axis=0), 1, 0)
    return float(np.einsum("ij,ij->", first, np.cross(second, third)) / 6)
