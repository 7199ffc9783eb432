"""A part of a picture as the tensor that a network expects, and the way back to the picture."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

PADDING = (114, 114, 114)  # grey around letterboxed pictures: that of YOLOX, RTMDet, RTMO, YOLOv8


@dataclass(frozen=True)
class Input:
    """What a network expects: size, layout, colours and scale of its picture."""

    size: Sequence[int]  # width and height, px
    channels: str  # order of colours: "rgb" or "bgr"
    layout: str = "nchw"  # or "nhwc"
    mean: Sequence[float] = (0, 0, 0)  # in the order of `channels`, of values 0 to 255
    std: Sequence[float] = (1, 1, 1)

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """The shape of the tensor."""
        width, height = self.size
        return (1, 3, height, width) if self.layout == "nchw" else (1, height, width, 3)

    def tensor(self, patch: NDArray) -> NDArray:
        """Return a picture (height, width, 3) uint8 BGR of this size as float32."""
        patch = patch if self.channels == "bgr" else patch[:, :, ::-1]
        values = patch.astype(np.float32) - np.asarray(self.mean, np.float32)
        values /= np.asarray(self.std, np.float32)
        values = values.transpose(2, 0, 1) if self.layout == "nchw" else values
        return np.ascontiguousarray(values[None])


@dataclass(frozen=True)
class Window:
    """An upright rectangle of a picture, px, that fills a network's input.

    Pixel 0 of the input lies at its left edge. Pixel `size` would lie at its right edge; with
    `ends_inside`, the last pixel does (UDP, Huang et al. 2020).
    """

    x: float  # of the centre
    y: float
    width: float
    height: float
    size: Sequence[int]  # width and height of the input, px
    ends_inside: bool = False

    def cut(
        self,
        image: NDArray,
        border: Sequence[int] = (0, 0, 0),
        mirror: float | None = None,
    ) -> NDArray:
        """Return this part of a picture (H, W, 3) uint8, with `border` outside it, bilinear.

        A `mirror` exchanges left and right: fractions f of the width and `mirror` - f.
        """
        less = int(self.ends_inside)
        across, down = self.width / (self.size[0] - less), self.height / (self.size[1] - less)
        left = self.x - across * ((self.size[0] - less) / 2)
        top = self.y - down * ((self.size[1] - less) / 2)
        if mirror is not None:
            left, across = left + mirror * self.width, -across
        matrix = np.array([[across, 0, left], [0, down, top]])
        flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        size = (self.size[0], self.size[1])
        return cv2.warpAffine(
            image, matrix, size, flags=flags, borderMode=cv2.BORDER_CONSTANT, borderValue=border
        )

    def to_picture(self, fraction: NDArray) -> NDArray:
        """Map fractions (..., 2) of the width and height, from the upper left, to px."""
        return np.array([self.x, self.y]) + (fraction - 0.5) * [self.width, self.height]


def letterbox(shape: Sequence[int], size: Sequence[int], *, centred: bool) -> Window:
    """Return the window that shows a whole picture, (H, W, ...), as large as the input allows.

    What remains is right and below of it, or on both sides if `centred`.
    """
    height, width = shape[:2]
    scale = min(size[0] / width, size[1] / height)
    whole = (size[0] / scale, size[1] / scale)
    x, y = (width / 2, height / 2) if centred else (whole[0] / 2, whole[1] / 2)
    return Window(x, y, *whole, size)
