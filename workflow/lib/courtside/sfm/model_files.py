"""Check that a COLMAP model's files are complete: COLMAP itself reads past their end."""

import struct
from pathlib import Path

from courtside.study.errors import StrPath

PARAMETERS = 8  # of the lens model that the project uses, OPENCV
OPENCV = 4
POSE_BYTES = 7 * 8
SENSOR_BYTES = 8
POINT_BYTES = 24  # of an image: x, y, id
TRACK_BYTES = 8  # of a track's element: image, index


class _Walk:
    """A cursor in a file's bytes; a step past their end is a `ValueError`."""

    def __init__(self, path: Path) -> None:
        self.path, self.content, self.at = path, path.read_bytes(), 0

    def skip(self, n_bytes: int) -> None:
        self.at += n_bytes
        if self.at > len(self.content):
            raise ValueError(f"{self.path.name} that ends early")

    def take(self, form: str) -> int:
        start = self.at
        self.skip(struct.calcsize(form))
        return struct.unpack_from(form, self.content, start)[0]

    def skip_name(self) -> None:
        end = self.content.find(b"\0", self.at)
        self.skip(end + 1 - self.at if end >= 0 else len(self.content))


def _camera(walk: _Walk) -> None:
    walk.skip(4)
    if walk.take("<i") != OPENCV:
        raise ValueError(f"{walk.path.name} with another lens than OPENCV")
    walk.skip(16 + 8 * PARAMETERS)


def _image(walk: _Walk) -> None:
    walk.skip(4 + POSE_BYTES + 4)
    walk.skip_name()
    walk.skip(POINT_BYTES * walk.take("<Q"))


def _point(walk: _Walk) -> None:
    walk.skip(8 + 24 + 3 + 8)
    walk.skip(TRACK_BYTES * walk.take("<Q"))


def _rig(walk: _Walk) -> None:
    walk.skip(4)
    count = walk.take("<I")
    walk.skip(SENSOR_BYTES if count else 0)
    for _ in range(count - 1):
        walk.skip(SENSOR_BYTES)
        walk.skip(POSE_BYTES if walk.take("<B") else 0)


def _frame(walk: _Walk) -> None:
    walk.skip(8 + POSE_BYTES)
    walk.skip(16 * walk.take("<I"))


RECORDS = {
    "cameras": _camera,
    "images": _image,
    "points3D": _point,
    "rigs": _rig,
    "frames": _frame,
}


def check(folder: StrPath) -> None:
    """Walk through the binary files of a model (`RECORDS`), each to its end.

    colmap/scene/reconstruction_io_binary.cc of COLMAP 4. Raises `ValueError` if a file is longer or
    shorter than its counts say, `OSError` if one is missing.
    """
    for name, record in RECORDS.items():
        walk = _Walk(Path(folder) / f"{name}.bin")
        for _ in range(walk.take("<Q")):
            record(walk)
        if walk.at != len(walk.content):
            raise ValueError(f"{walk.path.name} of {len(walk.content)} bytes, not {walk.at}")
