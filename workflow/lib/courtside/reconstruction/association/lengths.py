"""Bone lengths of tracked people, in 3D; they distinguish people of different size."""

from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera as camera_models
from courtside.geometry import triangulation
from courtside.geometry.camera import Camera
from courtside.reconstruction.association.identity import Followed
from courtside.records.keypoints.skeleton import SEGMENTS


def bones(names: Sequence[str]) -> list[tuple[int, int]]:
    """Return the bones of arms and legs as pairs of indices of `names` that are there."""
    at = {name: index for index, name in enumerate(names)}
    pairs = product(SEGMENTS.values(), ("left", "right"))
    wanted = [(f"{side}_{a}", f"{side}_{b}") for (a, b), side in pairs]
    return [(at[a], at[b]) for a, b in wanted if a in at and b in at]


def of_people(
    cameras: Sequence[Camera],
    xy: Sequence[NDArray],
    instants: NDArray,
    people: Followed,
    pairs: Sequence[tuple[int, int]],
) -> NDArray:
    """Return the lengths (K, N, B) m of bones of each person at each instant; NaN where unknown.

    `xy` are the rows (P, T, J, 2) of each camera, px; `instants` (N,) index their frames. Both
    joints of a bone need two views or more.
    """
    count, n = people.chosen.shape
    if not pairs:
        return np.full((count, n, 0), np.nan)
    person, at = np.nonzero(people.chosen >= 0)
    row = people.candidates.row[people.chosen[person, at]]
    used = sorted({joint for pair in pairs for joint in pair})
    plane = []
    for c, (camera, view) in enumerate(zip(cameras, xy, strict=True)):
        seen = view[np.maximum(row[:, c], 0), instants[at]][:, used]
        seen = np.where((row[:, c] >= 0)[:, None, None], seen, np.nan)
        plane.append(camera_models.undistort(camera, seen.reshape(-1, 2)))
    views = np.stack(plane)
    matrix = np.stack([camera.cam_from_world for camera in cameras])
    weight = np.isfinite(views).all(axis=-1).astype(float)
    xyz = triangulation.triangulate(views, weight, matrix).reshape(len(at), -1, 3)
    ends = np.array([[used.index(a), used.index(b)] for a, b in pairs])
    found = np.full((count, n, len(pairs)), np.nan)
    found[person, at] = np.linalg.norm(xyz[:, ends[:, 0]] - xyz[:, ends[:, 1]], axis=-1)
    return found
