"""Pictures of ROS messages into arrays: `sensor_msgs/Image` and `sensor_msgs/CompressedImage`."""

import cv2
import numpy as np

LARGEST_PX = 1 << 26  # of a picture: beyond any camera, below what would fill the memory
DEPTH_HEADER_BYTES = 12  # of compressedDepth, before the PNG; it says nothing of 16-bit depth
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


def colour(message):
    """Return the colour picture (H, W, 3) uint8 BGR of a message.

    Raises
    ------
    ValueError
        If its encoding is not supported or it is damaged.
    """
    if hasattr(message, "format"):
        return _unpacked(message, message.data, cv2.IMREAD_COLOR)
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


def depth(message):
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


def _rows(message, n_bytes):
    """Return the bytes of a picture (H, W, n_bytes), without the padding of its rows."""
    height, width, step = int(message.height), int(message.width), int(message.step)
    data = np.asarray(message.data, dtype=np.uint8)
    whole = 0 < height * width <= LARGEST_PX and step >= width * n_bytes
    if not whole or data.size != height * step:
        raise ValueError(
            f"expected {n_bytes} bytes per pixel of {width}x{height}, found rows of {step} and "
            f"{data.size} bytes"
        )
    return data.reshape(height, step)[:, : width * n_bytes].reshape(height, width, n_bytes)


def _unpacked(message, packed, flags):
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
