"""Cameras of EasyMocap: `intri.yml` and `extri.yml` in one folder, both ways.

As its `camera_utils` reads and writes them: K_<name>, dist_<name> (or D_), H_ and W_, the size of
the picture in px; R_<name>, the rotation vector from the world to the camera, or Rot_, the matrix,
and T_<name>. Lengths are in metres where the session does not say another unit.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from courtside.calibration.foreign import opencv
from courtside.geometry import camera as camera_files
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

INTRINSIC, EXTRINSIC = FILES = ("intri.yml", "extri.yml")


def check_both(folder: Path) -> None:
    """Raise `InputError` if one of the two files is missing."""
    there = [file for file in FILES if (folder / file).is_file()]
    if len(there) == 1:
        (missing,) = set(FILES) - set(there)
        raise InputError(
            f"{folder}: expected {missing} beside {there[0]}, found none; put EasyMocap's two "
            "files into one folder"
        )


def read(folder: Path, texts: tuple[str, str]) -> list[Camera]:
    """Return the cameras of both files' `texts`, in the order of `names`, lengths as stated."""
    kept = [opencv.opened(folder / file, text) for file, text in zip(FILES, texts, strict=True)]
    lenses, places = (root for _, root in kept)
    names = opencv.value(opencv.child(lenses, ("names",)))
    if not isinstance(names, list):
        raise InputError(
            f"{folder / INTRINSIC}: expected names of cameras, found none; write it with "
            "EasyMocap again"
        )
    return [_camera(folder, _written(name), lenses, places) for name in names]


def _written(name: Any) -> str:
    """Return a name as the file has it: without quotation marks it is read as a number."""
    if not isinstance(name, float):
        return str(name)
    return f"{name:.0f}" if name.is_integer() else f"{name:g}"


def _camera(folder: Path, name: str, lenses: Any, places: Any) -> Camera:
    def get(node: Any, *stems: str) -> Any:
        return opencv.value(opencv.child(node, [f"{stem}_{name}" for stem in stems]))

    size = [get(lenses, "W"), get(lenses, "H")]
    if None in size:
        raise InputError(
            f"{folder / INTRINSIC}: camera {name}: expected the size of its picture as W_{name} "
            f"and H_{name}, found none; add two lines such as `W_{name}: 1920` and "
            f"`H_{name}: 1080`, which EasyMocap reads too"
        )
    table = {
        "size": size,
        "matrix": get(lenses, "K"),
        "distortions": get(lenses, "dist", "D"),
        "rotation": get(places, "R", "Rot"),
        "translation": get(places, "T"),
    }
    return camera_files.build(f"{folder}: camera {name}", name, table, 1.0)


def texts(cameras: Sequence[Camera]) -> dict[str, str]:
    """Return the texts of both files, by name: metres, all digits."""
    names = ["names:", *(f'  - "{camera.name}"' for camera in cameras)]
    lenses, places = [*names], [*names]
    for camera in cameras:
        rotation = camera.cam_from_world[:, :3]
        lenses += _matrix("K", camera, camera.K)
        lenses += _matrix("dist", camera, camera.dist[None])
        lenses += [f"H_{camera.name}: {camera.size[1]}", f"W_{camera.name}: {camera.size[0]}"]
        places += _matrix("R", camera, rotations.rodrigues_from_rotation(rotation)[:, None])
        places += _matrix("Rot", camera, rotation)
        places += _matrix("T", camera, camera.cam_from_world[:, 3:])
    head = ["%YAML:1.0", "---"]
    return {
        INTRINSIC: "\n".join([*head, *lenses, ""]),
        EXTRINSIC: "\n".join([*head, *places, ""]),
    }


def _matrix(stem: str, camera: Camera, values: np.ndarray) -> list[str]:
    return [
        f"{stem}_{camera.name}: !!opencv-matrix",
        f"  rows: {values.shape[0]}",
        f"  cols: {values.shape[1]}",
        "  dt: d",
        f"  data: [ {', '.join(repr(float(value)) for value in values.ravel())} ]",
    ]
