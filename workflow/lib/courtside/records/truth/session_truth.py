"""The truth of a virtual session: real poses of its cameras and walks, real court points.

Only code that evaluates a result may read it.
"""

import zipfile
from collections.abc import Collection, Iterable, Mapping, Sequence
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
    "dist": ("float", ("C", "L")),  # 5, or 9 where lenses have what no calibration estimates
    "cam_from_world": ("float", ("C", "3", "4")),
    "court_points": ("str", ("P",)),
    "court_xyz": ("float", ("P", "3")),
}


@dataclass(frozen=True, eq=False)
class _Steady:
    """The walked camera at its frames."""

    # Time of each frame since the first: mid-exposure of the middle row
    time_s: Annotated[NDArray, "float G"]
    K: Annotated[NDArray, "float 3 3"]  # the lens without stabilisation, px
    dist: Annotated[NDArray, "float L"]
    cam_from_world: Annotated[NDArray, "float G 3 4"]  # pose at `time_s`, metres
    # Principal point of each frame, which a stabiliser moves; equal to that of `K` without one
    principal_point_px: Annotated[NDArray, "float G 2"]


@dataclass(frozen=True, eq=False)
class Walk(_Steady):
    """The walked camera at its frames, with what a world may add that no calibration knows."""

    # (G,): focal length of each frame over that of `K`; None: 1
    focal_scale: NDArray | None = None
    # (G, 2, 2) px: how a stabiliser bends the rows of each frame, by
    # `virtualgym.cameras.row_warp.shifts`; None: not at all
    row_warp_px: NDArray | None = None
    readout_s: NDArray | float | None = None  # of its rolling shutter; None: the preset's


SOMETIMES: npz.Spec = {
    "focal_scale": ("float", ("G",)),
    "row_warp_px": ("float", ("G", "2", "2")),
    "readout_s": ("float", ()),
}
READOUT: npz.Spec = {"readout_s": ("float", ("C",))}


@dataclass(frozen=True, eq=False)
class Truth:
    """What a virtual session really is."""

    cameras: list[Camera]  # the fixed cameras
    walks: dict[str, Walk]
    court_points: NDArray  # (P,) str: names of the court's points
    # (P, 3) float: their real positions, metres: painted lines lie millimetres off
    court_xyz: NDArray
    # (C,) float: of the fixed cameras' rolling shutters, s; None: the preset's
    readout_s: NDArray | None = None


def write(
    path: StrPath,
    cameras: Sequence[Camera],
    walks: Mapping[str, Walk],
    court_points: Sequence[str],
    court_xyz: NDArray,
    readout_s: ArrayLike | None = None,
) -> None:
    """Write the truth of a session with at least one fixed camera; `court_xyz` (P, 3) in metres.

    `readout_s` (C,) where the cameras' readout times differ from the preset's.
    """
    arrays: dict[str, ArrayLike] = {
        "camera": [camera.name for camera in cameras],
        "size": [camera.size for camera in cameras],
        "K": [camera.K for camera in cameras],
        "dist": [camera.dist for camera in cameras],
        "cam_from_world": [camera.cam_from_world for camera in cameras],
        "court_points": np.array(court_points, dtype=str),
        "court_xyz": np.asarray(court_xyz, dtype=float),
    }
    if readout_s is not None:
        arrays["readout_s"] = readout_s
    for name, walk in walks.items():
        given = {key: value for key, value in vars(walk).items() if value is not None}
        arrays |= {f"{name}/{key}": value for key, value in given.items()}
    npz.write(path, FORM, _spec(walks, arrays), arrays)


def read(path: StrPath) -> Truth:
    """Read the truth of a session; raise `InputError` if the file is not one of `write`."""
    names, stored = _walk_names(path)
    arrays = npz.read(path, FORM, _spec(names, stored))
    rows = zip(
        *(arrays[key] for key in ("camera", "size", "K", "dist", "cam_from_world")), strict=True
    )
    with reading(path, "cameras that can be"):
        cameras = [
            Camera(str(name), tuple(size.tolist()), matrix, dist, pose)
            for name, size, matrix, dist, pose in rows
        ]
    walks = {
        name: Walk(**{key: arrays[at] for key in _keys() if (at := f"{name}/{key}") in arrays})
        for name in names
    }
    known = arrays["court_points"], arrays["court_xyz"], arrays.get("readout_s")
    return Truth(cameras, walks, *known)


def _keys() -> npz.Spec:
    return {**npz.spec_of(_Steady), **SOMETIMES}


def _spec(walks: Iterable[str], there: Collection[str]) -> npz.Spec:
    # Each walk has its own number of frames G.
    of_walks = {
        f"{name}/{key}": (kind, tuple("G of " + name if one == "G" else one for one in dimensions))
        for name in walks
        for key, (kind, dimensions) in _keys().items()
        if key not in SOMETIMES or f"{name}/{key}" in there
    }
    return {**SPEC, **of_walks, **(READOUT if "readout_s" in there else {})}


def _walk_names(path: StrPath) -> tuple[list[str], list[str]]:
    """Return the names of the walks and keys in a file; none if `npz.read` will refuse it."""
    try:
        with zipfile.ZipFile(path) as stored:
            keys = [name.removesuffix(".npy") for name in stored.namelist()]
    except RAISED_BY_READERS:
        return [], []
    names = [key.rpartition("/")[0] for key in keys]
    return list(dict.fromkeys(name for name in names if name)), keys
