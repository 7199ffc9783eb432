"""Cameras of OpenCV's FileStorage, YAML or XML: one camera, or several under their names."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cv2

from courtside.calibration.foreign import forms
from courtside.geometry import camera as camera_files
from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.study.errors import reading

KEYS = {  # the first is what `camera.build` calls it
    "matrix": ("camera_matrix", "K"),
    "distortions": ("distortion_coefficients", "dist"),
    "rotation": ("R", "rvec"),
    "translation": ("T", "tvec"),
}
PAIR = (
    "give each camera with its own camera_matrix, distortion_coefficients, R, T, image_width and "
    "image_height, both placed in the frame of the hall, in one file"
)
# Keys, in small letters, by which the matrices of both cameras of a pair are stored.
STEREO = (
    {"m1", "m2"},
    {"k1", "k2"},
    {"cameramatrix1", "cameramatrix2"},
    {"camera_matrix_1", "camera_matrix_2"},
    {"camera_matrix1", "camera_matrix2"},
    {"camera_matrix_left", "camera_matrix_right"},
    {"left_camera_matrix", "right_camera_matrix"},
    {"k_left", "k_right"},
    {"kl", "kr"},
)


def opened(path: Path, text: str) -> tuple[cv2.FileStorage, cv2.FileNode]:
    """Return a file of FileStorage, to be kept while its nodes are read, and its root.

    Raises `InputError` if it is damaged.
    """
    what = "a file of OpenCV's FileStorage, YAML or XML"
    with reading(path, what, "check it", kinds=(cv2.error, ValueError)):
        try:
            storage = cv2.FileStorage(text, cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY)
        except SystemError:  # OpenCV does not say why
            start = camera_fields.short(text.strip()[:40])
            raise ValueError(f"a text that begins with {start!r}") from None
        return storage, storage.root()


def read(path: Path, text: str) -> list[Camera]:
    """Return the camera of a file, or its cameras by the names of its maps."""
    _kept, root = opened(path, text)
    keys = list(root.keys()) if root.isMap() else []
    if any(pair <= {key.lower() for key in keys} for pair in STEREO):
        raise forms.refused(path, f"a stereo pair ({', '.join(keys[:4])} ...)", PAIR)
    if child(root, KEYS["matrix"]) is not None:
        return [_camera(path, root, path.stem, root)]
    maps = [(key, root.getNode(key)) for key in keys]
    maps = [(key, node) for key, node in maps if node.isMap() and child(node, ("data",)) is None]
    if not maps:
        found = ", ".join(keys[:6]) or "nothing"
        raise forms.refused(path, f"no camera_matrix among: {found}", "check it")
    return [_camera(path, node, key, root) for key, node in maps]


def _camera(path: Path, node: Any, name: str, root: Any) -> Camera:
    name_node = child(node, ("name", "camera_name"))
    name = name_node.string() if name_node is not None and name_node.isString() else name
    where = f"{path}: camera {name}"
    table = {ours: value(child(node, keys)) for ours, keys in KEYS.items()}
    fisheye = child(node, ("fisheye_model",)) or child(root, ("fisheye_model",))
    table["fisheye"] = bool(value(fisheye))
    table["size"] = [value(child(node, (key,))) for key in ("image_width", "image_height")]
    unit = child(node, ("unit",)) or child(root, ("unit",))
    # ASSUME: metres where the file names no unit; OpenCV has none of its own.
    metres = camera_fields.unit_in_metres(where, "m" if unit is None else value(unit))
    return camera_files.build(where, name, table, metres)


def child(node: Any, keys: Sequence[str]) -> Any:
    """Return the first child of a map under one of `keys`, None without any."""
    found = [node.getNode(key) for key in keys] if node.isMap() else []
    return next((one for one in found if not one.empty() and not one.isNone()), None)


def value(node: Any) -> Any:
    """Return a node of FileStorage as rows of a matrix, list, number or text; else None."""
    if node is None:
        return None
    if node.isSeq():
        return [value(node.at(index)) for index in range(node.size())]
    if node.isString():
        return node.string()
    if node.isInt() or node.isReal():
        return node.real()
    return _rows(node) if node.isMap() else None


def _rows(node: Any) -> Any:
    """Return a stored matrix as rows, or a vector as a list.

    FileStorage's own method crashes where rows, columns and type do not fit the data.
    """
    columns, data = (value(child(node, (key,))) for key in ("cols", "data"))
    if not isinstance(data, list) or not isinstance(columns, float):
        return data
    if not 1 < columns < len(data):
        return data
    return [data[at : at + int(columns)] for at in range(0, len(data), int(columns))]
