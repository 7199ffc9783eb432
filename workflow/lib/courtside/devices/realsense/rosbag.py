"""RealSense recordings in rosbag files: their topics, and the images in their messages."""

import contextlib
import itertools
import re
import struct
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import apsw
import cv2
import numpy as np
from numpy.typing import NDArray
from rosbags import rosbag1, rosbag2
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_typestore

from courtside.geometry import camera_fields
from courtside.study.errors import InputError, StrPath

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

Parser = Callable[[bytes, str], Any]
# What rosbags, its parsers and its decompressors raise on damaged files.
DAMAGED: tuple[type[Exception], ...]
DAMAGED = (rosbag1.ReaderError, rosbag2.ReaderError, SerdeError, apsw.Error, struct.error)
DAMAGED += (OSError, EOFError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError)
DAMAGED += (AssertionError, RuntimeError, MemoryError, zstd.ZstdError)
LARGEST_MESSAGE_BYTES = 1 << 28  # a 4K colour picture has 25 MB
# SDK 2.48 to 2.57 states by this frame_id, after number and time, that a picture of a `.bag` is
# followed by the depth unit (float32), which the type of the message does not have.
FRAME_ID, HAS_UNIT, UNIT_BYTES = slice(12, 17), b"\1\0\0\x001", 4
ZSTD = b"\x28\xb5\x2f\xfd"  # begins each message that SDK 2.58 compressed
HOW = (
    "copy it again from the camera's computer, "
    "or record again and stop the recording in its program"
)


@dataclass(frozen=True, eq=False)
class Bag:
    """An open recording; `counts` is the number of messages on each topic."""

    path: Path
    counts: dict[str, int]
    _reader: Any  # rosbag1.Reader or rosbag2.Reader: they share what is used, but no base class
    _parse: Parser

    def messages(self, topics: Iterable[str]) -> Iterator[tuple[str, int, Any]]:
        """Yield (topic, time_ns, message) of some topics, in order of time.

        Raises `InputError` if a message is damaged or missing.
        """
        wanted = [c for c in self._reader.connections if c.topic in set(topics)]
        if not wanted:
            return
        with _guarded(self.path):
            for connection, time_ns, raw in self._reader.messages(wanted):
                if len(raw) > LARGEST_MESSAGE_BYTES:
                    raise ValueError(f"a message of {len(raw)} bytes on {connection.topic}")
                yield connection.topic, time_ns, self._parse(raw, connection.msgtype)

    def first(self, topic: str) -> Any:
        """Return the first message on a topic; None if there is none."""
        found = next(self.messages([topic]), None)
        return found[2] if found else None

    def all(self, topic: str, limit: int = 1000) -> list[Any]:
        """Return the first messages on a topic, at most `limit`."""
        return [message for _, _, message in itertools.islice(self.messages([topic]), limit)]


@contextlib.contextmanager
def opened(path: StrPath) -> Iterator[Bag]:
    """Open a recording: `.bag` of ROS 1 or `.db3` of ROS 2.

    An `InputError` if the file is missing, neither of these, cut short or damaged.
    """
    path = Path(path)
    if path.suffix.lower() not in READERS or not path.is_file():
        found = f"a file named *{path.suffix}" if path.is_file() else "no file"
        raise InputError(
            f"{path}: expected a recording in ROS format (.bag or .db3), found {found}; correct "
            "the path"
        )
    kind, parser = READERS[path.suffix.lower()]
    with contextlib.ExitStack() as stack:
        with _guarded(path):
            reader = stack.enter_context(kind(path))
            counts: dict[str, int] = {}
            for connection in reader.connections:
                if not isinstance(connection.topic, str) or not connection.topic.isprintable():
                    raise ValueError("a topic without a readable name")
                counts[connection.topic] = counts.get(connection.topic, 0) + connection.msgcount
        yield Bag(path, counts, reader, parser())


def _ros1() -> Parser:
    parse = get_typestore(Stores.ROS1_NOETIC).deserialize_ros1

    def parsed(raw: bytes, kind: str) -> Any:
        has_unit = kind == "sensor_msgs/msg/Image" and raw[FRAME_ID] == HAS_UNIT
        return parse(raw[:-UNIT_BYTES] if has_unit else raw, kind)

    return parsed


def _ros2() -> Parser:
    parse = get_typestore(Stores.ROS2_HUMBLE).deserialize_cdr

    def parsed(raw: bytes, kind: str) -> Any:
        if raw[: len(ZSTD)] == ZSTD:
            raw = zstd.ZstdDecompressor().decompress(raw, LARGEST_MESSAGE_BYTES)
        return parse(raw, kind)

    return parsed


READERS: dict[str, tuple[Callable[[Path], Any], Callable[[], Parser]]] = {
    ".bag": (rosbag1.Reader, _ros1),
    ".db3": (rosbag2.Reader, _ros2),
}


@contextlib.contextmanager
def _guarded(path: Path) -> Iterator[None]:
    try:
        yield
    except InputError:
        raise
    except DAMAGED as error:
        found = camera_fields.short(error) or type(error).__name__
        if "not indexed" in found:
            found = "a recording that was not finished (it has no index)"
        raise InputError(
            f"{path}: expected a whole recording in ROS format, found damage: {found}; {HOW}"
        ) from error


LARGEST_PX = 1 << 26  # of a picture: beyond any camera, below what would fill the memory
DEPTH_HEADER_BYTES = 12  # of compressedDepth, before the PNG; not needed for 16-bit depth
DEPTHS = ("mono16", "16uc1", "z16")
COLOURS = {  # encoding -> bytes per pixel and conversion to BGR
    "bgr8": (3, None),
    "rgb8": (3, cv2.COLOR_RGB2BGR),
    "bgra8": (4, cv2.COLOR_BGRA2BGR),
    "rgba8": (4, cv2.COLOR_RGBA2BGR),
    "mono8": (1, cv2.COLOR_GRAY2BGR),
    "8uc1": (1, cv2.COLOR_GRAY2BGR),
    "yuyv": (2, cv2.COLOR_YUV2BGR_YUYV),
    "yuy2": (2, cv2.COLOR_YUV2BGR_YUYV),
    "yuv422_yuy2": (2, cv2.COLOR_YUV2BGR_YUYV),
    "uyvy": (2, cv2.COLOR_YUV2BGR_UYVY),
    "yuv422": (2, cv2.COLOR_YUV2BGR_UYVY),  # in ROS's words, and the camera program's
}


def colour(message: Any) -> NDArray:
    """Return the colour picture (H, W, 3) uint8 BGR of a message.

    Raises `ValueError` if its encoding is not supported or it is damaged.
    """
    if hasattr(message, "format"):
        rows = _decompressed(message)
        if rows is None:
            return _unpacked(message, message.data, cv2.IMREAD_COLOR)
        message = rows
    encoding = message.encoding.lower()
    if encoding == "mjpeg":
        return _unpacked(message, message.data, cv2.IMREAD_COLOR)
    if encoding not in COLOURS:
        raise ValueError(f"expected colour as one of {', '.join(COLOURS)}, found {encoding[:40]!r}")
    n_bytes, conversion = COLOURS[encoding]
    stored = _rows(message, n_bytes)
    if n_bytes == 2 and message.width % 2:
        raise ValueError(f"expected an even width of {encoding}, found {message.width}")
    return np.array(stored) if conversion is None else cv2.cvtColor(stored, conversion)


def depth(message: Any) -> NDArray:
    """Return the depth picture (h, w) uint16 of a message; raise `ValueError` as `colour`."""
    if hasattr(message, "format"):
        kind = message.format.lower()
        if "16uc1" not in kind and "mono16" not in kind:
            raise ValueError(f"expected 16-bit depth, found {message.format[:40]!r}")
        packed = message.data[DEPTH_HEADER_BYTES if "compresseddepth" in kind else 0 :]
        return _unpacked(message, packed, cv2.IMREAD_UNCHANGED)
    encoding = message.encoding.lower()
    if encoding not in DEPTHS:
        raise ValueError(f"expected depth as one of {', '.join(DEPTHS)}, found {encoding[:40]!r}")
    bytes_of_16 = np.ascontiguousarray(_rows(message, 2))
    kind = ">u2" if message.is_bigendian else "<u2"
    return bytes_of_16.view(kind)[..., 0].astype(np.uint16)


def _rows(message: Any, n_bytes: int) -> NDArray:
    """Return the bytes of a picture (H, W, n_bytes), without row padding."""
    height, width, step = int(message.height), int(message.width), int(message.step)
    data = np.asarray(message.data, dtype=np.uint8)
    whole = 0 < height * width <= LARGEST_PX and step >= width * n_bytes
    if not whole or data.size != height * step:
        raise ValueError(
            f"expected {n_bytes} bytes per pixel of {width}x{height}, found rows of {step} and "
            f"{data.size} bytes"
        )
    return data.reshape(height, step)[:, : width * n_bytes].reshape(height, width, n_bytes)


# SDK 2.58 and later pack pictures that no image format holds: "YUYV; zstd; 640x480 step=1280".
ROWS_IN_ZSTD = re.compile(r"(\w+); zstd; (\d+)x(\d+) step=(\d+)")


def _decompressed(message: Any) -> SimpleNamespace | None:
    """Return a picture whose rows are in Zstandard as a plain message, None of other formats."""
    found = ROWS_IN_ZSTD.fullmatch(message.format)
    if not found:
        return None
    try:
        raw = zstd.ZstdDecompressor().decompress(bytes(message.data), LARGEST_MESSAGE_BYTES)
    except zstd.ZstdError as error:
        raise ValueError(f"a packed picture that does not open: {error}") from error
    width, height, step = map(int, found.groups()[1:])
    data = np.frombuffer(raw, dtype=np.uint8)
    return SimpleNamespace(encoding=found[1], width=width, height=height, step=step, data=data)


def _unpacked(message: Any, packed: Any, flags: int) -> NDArray:
    packed = np.asarray(packed, dtype=np.uint8)
    try:
        image = cv2.imdecode(packed, flags) if packed.size else None
    except cv2.error as error:
        raise ValueError(f"a packed picture that does not open: {error.code}") from error
    wanted = (np.uint8, 3) if flags == cv2.IMREAD_COLOR else (np.uint16, 2)
    if image is None or (image.dtype, image.ndim) != wanted:
        name = getattr(message, "format", getattr(message, "encoding", ""))[:40]
        raise ValueError(f"a packed picture ({name!r}) that does not open")
    return image
