"""Unpacks what pages pack, by a few lines of numpy that follow the words of the format."""

import base64
import zlib

import numpy as np


def unpacked(text, shape):
    """Return whole numbers as the format says: low bytes, high bytes, changes along the last axis."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).astype(int)
    low, high = planes.reshape(2, -1)
    sums = np.cumsum((low + 256 * high).reshape(shape), axis=-1) & 0xFFFF
    return np.where(sums < 1 << 15, sums, sums - (1 << 16))


def size_of(level):
    return 1e-5 * 1e6 ** ((np.asarray(level, float) - 1) / 254)


def covariance_of(levels):
    """Return the covariance (3, 3) of six levels, by the angles of the format."""
    a, b, c = levels[3:] * np.pi / 255
    rows = [
        [1, 0, 0],
        [np.cos(a), np.sin(a), 0],
        [np.cos(b), np.sin(b) * np.cos(c), np.sin(b) * np.sin(c)],
    ]
    factor = size_of(levels[:3])[:, None] * np.array(rows)
    return factor @ factor.T
