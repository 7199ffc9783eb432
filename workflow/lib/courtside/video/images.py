"""Pictures in files: OpenCV reports faults in three ways, here they all become an InputError."""

import re
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.study.errors import DAMAGED, InputError, StrPath, reading

AGAIN = "copy it again from the camera"


def read(
    path: StrPath, flags: int = cv2.IMREAD_COLOR, *, what: str = "a picture", advice: str = AGAIN
) -> NDArray:
    """Read a picture (H, W) or (H, W, 3), upright by its EXIF orientation unless `flags` differ.

    `flags` are OpenCV's, such as `cv2.IMREAD_GRAYSCALE`; `what` is expected and `advice` tells what
    to do, for messages. Raise InputError if the file is missing, empty, no picture, too damaged, or
    too large for the memory.
    """
    path = Path(path)
    return decode(
        path, path.read_bytes() if path.is_file() else b"", flags, what=what, advice=advice
    )


def name_order(path: Path) -> tuple[list[int | str], str]:
    """Return the key to sort pictures by name, numbers by value: picture 9 before picture 10."""
    parts = re.split(r"(\d+)", path.stem)
    return [int(part) if at % 2 else part for at, part in enumerate(parts)], str(path)


def decode(
    path: StrPath,
    content: bytes,
    flags: int = cv2.IMREAD_COLOR,
    *,
    what: str = "a picture",
    advice: str = AGAIN,
) -> NDArray:
    """Decode the content of a file, as `read` does; `path` is for messages."""
    with reading(path, what, advice, kinds=(*DAMAGED, cv2.error)):
        image = cv2.imdecode(np.frombuffer(content, np.uint8), flags) if content else None
    if image is None:
        found = "one that is damaged or cut short" if content else "no file or an empty one"
        raise InputError(f"{path}: expected {what}, found {found}; {advice}")
    return image
