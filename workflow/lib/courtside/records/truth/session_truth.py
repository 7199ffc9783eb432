"""The truth of a virtual session: real poses of its cameras and walks, real court points.

Only code that evaluates a result may read it.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry.camera import Camera
from courtside.records import npz
from courtside.study.errors import StrPath, reading

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
OF_WALK: npz.Spec = {
    "time_s": ("float", ("G",)),
    "K": ("float", ("3", "3")),
    "dist": ("float", ("L",)),
    "cam_from_world": ("float", ("G", "3", "4")),
    "principal_point_px": ("float", ("G", "2")),
}
# What is written only where a world differs from the preset.
SOMETIMES: npz.Spec = {"readout_s": ("float", ("C",))}
SOMETIMES_OF_WALK: npz.Spec = {
    "focal_scale": ("float", ("G",)),
    "row_warp_px": ("float", ("G", "2", "2")),
    "readout_s": ("float", ()),
}


@dataclass(frozen=True, eq=False)
class Walk:
    """The walked camera at its frames, with what a world may add that no calibration knows."""

    time_s: NDArray  # (G,) of each frame since the first: mid-exposure of the middle row
    K: NDArray  # (3, 3): the lens without stabilisation, px
    dist: NDArray  # (L,)
    cam_from_world: NDArray  # (G, 3, 4): pose at `time_s`, metres
    # (G, 2): principal point of each frame, which a stabiliser moves; equal to that of `K` without
    # one
    principal_point_px: NDArray
    # (G,): focal length of each frame over that of `K`; None: 1
    focal_scale: NDArray | None = None
    # (G, 2, 2) px: how a stabiliser bends the rows of each frame, by
    # `virtualgym.cameras.row_warp.shifts`; None: not at all
    row_warp_px: NDArray | None = None
    readout_s: NDArray | float | None = None  # of its rolling shutter; None: the preset's


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
    npz.write(path, FORM, _spec(arrays), arrays)


def read(path: StrPath) -> Truth:
    """Read the truth of a session; raise `InputError` if the file is not one of `write`."""
    arrays = npz.read(path, FORM, _spec)
    rows = zip(
        *(arrays[key] for key in ("camera", "size", "K", "dist", "cam_from_world")), strict=True
    )
    with reading(path, "cameras that can be"):
        cameras = [
            Camera(str(name), tuple(size.tolist()), matrix, dist, pose)
            for name, size, matrix, dist, pose in rows
        ]
    keys = [*OF_WALK, *SOMETIMES_OF_WALK]
    walks = {
        name: Walk(**{key: arrays[at] for key in keys if (at := f"{name}/{key}") in arrays})
        for name in _walk_names(arrays)
    }
    known = arrays["court_points"], arrays["court_xyz"], arrays.get("readout_s")
    return Truth(cameras, walks, *known)


def _spec(stored: Collection[str]) -> npz.Spec:
    """Return the spec of a file with these keys."""
    found = {**SPEC, **{key: kind for key, kind in SOMETIMES.items() if key in stored}}
    for name in _walk_names(stored):
        for key, (kind, dimensions) in {**OF_WALK, **SOMETIMES_OF_WALK}.items():
            if key in OF_WALK or f"{name}/{key}" in stored:
                # Each walk has its own number of frames.
                own = (f"G of {name}" if length == "G" else length for length in dimensions)
                found[f"{name}/{key}"] = kind, tuple(own)
    return found


def _walk_names(keys: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(key.rpartition("/")[0] for key in keys if "/" in key))
