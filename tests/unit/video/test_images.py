"""Pictures: read as OpenCV reads them; whatever is wrong with a file is one line that names it."""

import struct
import zlib

import cv2
import numpy as np
import pytest

from courtside.study.errors import InputError
from courtside.video import images

PICTURE = np.random.default_rng(0).integers(0, 256, (6, 8, 3), dtype=np.uint8)


def test_a_picture_comes_back(tmp_path):
    cv2.imwrite(str(tmp_path / "a.png"), PICTURE)
    np.testing.assert_array_equal(images.read(tmp_path / "a.png"), PICTURE)
    grey = images.read(tmp_path / "a.png", cv2.IMREAD_GRAYSCALE)
    assert grey.shape == (6, 8)


def test_a_path_may_have_any_letters(tmp_path):
    (tmp_path / "Aufschläge 試合").mkdir()
    path = tmp_path / "Aufschläge 試合" / "a.png"
    path.write_bytes(cv2.imencode(".png", PICTURE)[1])
    np.testing.assert_array_equal(images.read(path), PICTURE)


def huge(width):
    """Return a PNG of a width that no memory holds."""
    head = struct.pack(">IIBBBBB", width, width, 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", head), (b"IDAT", zlib.compress(bytes(100))), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(c)) + name + c + struct.pack(">I", zlib.crc32(name + c))
        for name, c in chunks
    )


@pytest.mark.parametrize("content", [None, b"", b"hello", b"\x89PNG\r\n\x1a\n", huge(1 << 20)])
def test_what_is_no_picture_is_one_line(tmp_path, content):
    path = tmp_path / "a.png"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=r"a\.png: expected depth, found .*; do so") as caught:
        images.read(path, what="depth", advice="do so")
    assert len(str(caught.value).splitlines()) == 1


def test_a_folder_is_no_picture(tmp_path):
    with pytest.raises(InputError, match="no file or an empty one"):
        images.read(tmp_path)
