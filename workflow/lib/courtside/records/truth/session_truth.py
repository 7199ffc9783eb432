"""The truth of a virtual session: real poses of its cameras and walks, real court points.

Only code that evaluates a result may read it.
"""

import zipfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry.camera import Camera
from courtside.records import npz
from courtside.study.errors import RAISED_BY_READERS, StrPath, reading

FORM = "courtside truth 1"
SPEC = {
    "camera": ("str", ("C",)),
    "size": ("int", ("C", "2")),
    "K": ("float", ("C", "3", "3")),
    "dist": ("float", ("C", "5")),
    "cam_from_world": ("float", ("C", "3", "4")),
    "court_points": ("str", ("P",)),
    "court_xyz": ("float", ("P", "3")),
}


@dataclass(frozen=True, eq=False)
class Walk:
    """The walked camera at its frames."""

    # Time of each frame since the first: mid-exposure of the middle row
    time_s: Annotated[NDArray, "float G"]
    K: Annotated[NDArray, "float 3 3"]  # the lens without stabilisation, px
    dist: Annotated[NDArray, "float 5"]
    cam_from_world: Annotated[NDArray, "float G 3 4"]  # pose at `time_s`, metres
    # Principal point of each frame, which a stabiliser moves; equal to that of `K` without one
    principal_point_px: Annotated[NDArray, "float G 2"]


@dataclass(frozen=True, eq=False)
class Truth:
    """What a virtual session really is."""

    cameras: list[Camera]  # the fixed cameras
    walks: dict[str, Walk]
    court_points: NDArray  # (P,) str: names of the court's points
    # (P, 3) float: their real positions, metres: painted lines lie millimetres off
    court_xyz: NDArray


def write(
    path: StrPath,
    cameras: Sequence[Camera],
    walks: Mapping[str, Walk],
    court_points: Sequence[str],
    court_xyz: NDArray,
) -> None:
    """Write the truth of a session with at least one fixed camera; `court_xyz` (P, 3) in metres."""
    arrays: dict[str, ArrayLike] = {
        "camera": [camera.name for camera in cameras],
        "size": [camera.size for camera in cameras],
        "K": [camera.K for camera in cameras],
        "dist": [camera.dist for camera in cameras],
        "cam_from_world": [camera.cam_from_world for camera in cameras],
        "court_points": np.array(court_points, dtype=str),
        "court_xyz": np.asarray(court_xyz, dtype=float),
    }
    for name, walk in walks.items():
        arrays |= {f"{name}/{key}": value for key, value in vars(walk).items()}
    npz.write(path, FORM, _spec(walks), arrays)


def read(path: StrPath) -> Truth:
    """Read the truth of a session; raise `InputError` if the file is not one of `write`."""
    names = _walk_names(path)
    arrays = npz.read(path, FORM, _spec(names))
    rows = zip(
        *(arrays[key] for key in ("camera", "size", "K", "dist", "cam_from_world")), strict=True
    )
    with reading(path, "cameras that can be"):
        cameras = [
            Camera(str(name), tuple(size.tolist()), matrix, dist, pose)
            for name, size, matrix, dist, pose in rows
        ]
    keys = npz.spec_of(Walk)
    walks = {name: Walk(**{key: arrays[f"{name}/{key}"] for key in keys}) for name in names}
    return Truth(cameras, walks, arrays["court_points"], arrays["court_xyz"])


def _spec(walks: Iterable[str]) -> npz.Spec:
    # Each walk has its own number of frames G.
    of_walks = {
        f"{name}/{key}": (kind, tuple("G of " + name if one == "G" else one for one in dimensions))
        for name in walks
        for key, (kind, dimensions) in npz.spec_of(Walk).items()
    }
    return SPEC | of_walks


def _walk_names(path: StrPath) -> list[str]:
    """Return the names of the walks in a file; none of a file that `npz.read` will refuse."""
    try:
        with zipfile.ZipFile(path) as stored:
            names = [name.rpartition("/")[0] for name in stored.namelist()]
    except RAISED_BY_READERS:
        return []
    return list(dict.fromkeys(name for name in names if name))
