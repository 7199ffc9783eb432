"""Pictures in files, whatever the file holds: OpenCV says what is wrong in three ways, here it is one."""

from pathlib import Path

import cv2
import numpy as np

from courtside.study.errors import DAMAGED, InputError, reading

AGAIN = "copy it again from the camera"


def read(path, flags=cv2.IMREAD_COLOR, *, what="a picture", advice=AGAIN):
    """Read a picture.

    Parameters
    ----------
    path : str or Path
    flags : int
        OpenCV's, such as `cv2.IMREAD_GRAYSCALE`.
    what, advice : str
        What was expected and what to do, for messages.

    Returns
    -------
    image : (H, W) or (H, W, 3) array
        Upright as its EXIF orientation says unless the flags say otherwise.

    Raises
    ------
    InputError
        If the file is missing, empty, no picture, damaged so that nothing can be made of it, or too large for
        the memory.
    """
    path = Path(path)
    return decode(
        path, path.read_bytes() if path.is_file() else b"", flags, what=what, advice=advice
    )


def decode(path, content, flags=cv2.IMREAD_COLOR, *, what="a picture", advice=AGAIN):
    """Decode the content of a file that is read already; otherwise as `read`.

    Parameters
    ----------
    path : str or Path
        For messages.
    content : bytes
    flags, what, advice
        As for `read`.
    """
    with reading(path, what, advice, kinds=(*DAMAGED, cv2.error)):
        image = cv2.imdecode(np.frombuffer(content, np.uint8), flags) if content else None
    if image is None:
        found = "one that is damaged or cut short" if content else "no file or an empty one"
        raise InputError(f"{path}: expected {what}, found {found}; {advice}")
    return image
