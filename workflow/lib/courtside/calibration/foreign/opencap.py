"""Cameras of OpenCap: pickles of numpy arrays, read without running what a pickle may ask for.

A pickle is a program. Here it may build texts, numbers, lists, dictionaries and arrays, of which
own classes take the parts; anything else is refused. OpenCap's world is the board's, in mm; as
Pose2Sim does, the board is taken to hang upright, so that z is up.
"""

import io
import pickle
import pickletools
import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera as camera_files
from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.study.errors import RAISED_BY_READERS, reading

SUFFIXES = (".pickle", ".pkl")
IN_SESSION = "cameraIntrinsicsExtrinsics.pickle"  # of OpenCap, in one folder for each camera
OURS_FROM_BOARD = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]])
HARMLESS = {
    *("PROTO", "FRAME", "STOP", "MARK", "NONE", "NEWTRUE", "NEWFALSE"),
    *("EMPTY_DICT", "EMPTY_LIST", "EMPTY_TUPLE", "TUPLE", "TUPLE1", "TUPLE2", "TUPLE3"),
    *("SETITEM", "SETITEMS", "APPEND", "APPENDS", "BININT", "BININT1", "BININT2", "LONG1"),
    *("BINFLOAT", "BINUNICODE", "SHORT_BINUNICODE", "SHORT_BINBYTES", "BINBYTES"),
    *("BINPUT", "LONG_BINPUT", "BINGET", "LONG_BINGET", "MEMOIZE"),
    *("GLOBAL", "STACK_GLOBAL", "REDUCE", "BUILD"),
}
NUMBERS = re.compile(r"[fiu][248]")
KEYS = ("imageSize", "intrinsicMat", "distortion", "rotation", "translation")


class _Kind:
    """The type of an array's numbers."""

    def __init__(self, code: str, *_: object) -> None:
        if not isinstance(code, str) or not NUMBERS.fullmatch(code):
            raise ValueError(f"numbers of type {camera_fields.short(code)}")
        self.code = code

    def __setstate__(self, state: tuple) -> None:
        self.code = (">" if state[1] == ">" else "<") + self.code


class _Array:
    """An array, taken apart."""

    values: NDArray | None = None

    def __init__(self, *_: object) -> None:
        """Take the arguments of an array that is filled later."""

    def __setstate__(self, state: tuple) -> None:
        _, shape, kind, by_columns, data = state
        values = np.frombuffer(data, dtype=kind.code).astype(float)
        self.values = values.reshape(shape, order="F" if by_columns else "C")


def _scalar(kind: _Kind, data: bytes) -> float:
    return float(np.frombuffer(data, dtype=kind.code)[0])


def _encode(text: str, *_: object) -> bytes:
    return text.encode("latin-1")


STANDING_IN: dict[str, Any] = {
    **dict.fromkeys(
        (f"numpy.{core}.multiarray._reconstruct" for core in ("core", "_core")), _Array
    ),
    **dict.fromkeys((f"numpy.{core}.multiarray.scalar" for core in ("core", "_core")), _scalar),
    "numpy.ndarray": _Array,
    "numpy.dtype": _Kind,
    "_codecs.encode": _encode,
}


class _Unpickler(pickle.Unpickler):
    """Builds nothing but what stands in for numpy's arrays."""

    def find_class(self, module: str, name: str) -> Any:
        try:
            return STANDING_IN[f"{module}.{name}"]
        except KeyError:
            raise ValueError(f"a pickle that asks for {module}.{name}") from None


def files(folder: Path) -> dict[str, Path]:
    """Return the pickles of a folder by their cameras: of its own, or of OpenCap's folders."""
    own = {path.stem: path for path in sorted(folder.iterdir()) if path.suffix in SUFFIXES}
    return own or {path.parent.name: path for path in sorted(folder.glob(f"*/{IN_SESSION}"))}


def read(path: Path, data: bytes, name: str) -> Camera:
    """Return the camera of a pickle's `data`; raise `InputError` if it holds anything else."""
    with reading(
        path,
        "a calibration of OpenCap",
        "give the pickle that OpenCap wrote, or a TOML file made of it by Pose2Sim "
        "(convert_from = 'opencap')",
        kinds=(*RAISED_BY_READERS, pickle.UnpicklingError, AttributeError, TypeError),
    ):
        content = _content(data)
    table = {key: one.values if isinstance(one, _Array) else one for key, one in content.items()}
    where = f"{path}: camera {name}"
    height, width = camera_fields.numbers(
        where, "imageSize", table["imageSize"], (2,), (2, 1), (1, 2)
    ).ravel()
    translation = camera_fields.numbers(where, "translation", table["translation"], (3,), (3, 1))
    rotation = camera_fields.numbers(where, "rotation", table["rotation"], (3, 3))
    built = {
        "size": [width, height],
        "matrix": table["intrinsicMat"],
        "distortions": table["distortion"],
        "rotation": rotation @ OURS_FROM_BOARD.T,
        "translation": translation,
    }
    return camera_files.build(where, name, built, camera_fields.METRES["mm"])


def _content(data: bytes) -> dict[str, Any]:
    """Return the dictionary of a pickle, arrays as `_Array`."""
    for operation, argument, _ in pickletools.genops(data):
        if operation.name not in HARMLESS:
            raise ValueError(f"a pickle that uses {operation.name}")
        if operation.name == "LONG_BINPUT" and (argument or 0) > len(data):
            raise ValueError("a pickle with a memo index beyond its length")
    content = _Unpickler(io.BytesIO(data)).load()
    if not isinstance(content, dict) or not set(KEYS) <= set(content):
        found = list(content) if isinstance(content, dict) else type(content).__name__
        raise ValueError(f"{camera_fields.short(found)} in place of {', '.join(KEYS)}")
    return {key: content[key] for key in KEYS}
