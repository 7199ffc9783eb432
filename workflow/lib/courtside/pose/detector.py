"""The interface of pose networks: an image and a region in, joints out.

A network pair has two parts. A *person detector* finds regions in a picture; a *landmark network*
places the joints in one region, and returns the region to look at in the next frame.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

# Of a region around a person's box, in its longer sides: as BlazePose's regions are.
SIDE_OF_BOX = 1.4


@dataclass(frozen=True)
class Region:
    """A rotated square in a picture."""

    x: float  # of the centre, px
    y: float
    side: float  # px
    angle_rad: float = 0.0  # positive turns the x axis towards the y axis (clockwise as seen)
    # Width and height of the person's upright box about the centre, px, where it is known.
    box: tuple[float, float] | None = None

    def placed(self, left: float, top: float, scale: float = 1.0) -> "Region":
        """Return the region in the picture of which its own was a part, at a corner and scale."""
        box = None if self.box is None else (self.box[0] * scale, self.box[1] * scale)
        x, y = left + self.x * scale, top + self.y * scale
        return Region(x, y, self.side * scale, self.angle_rad, box)


@dataclass(frozen=True)
class Pose:
    """One person in one picture."""

    xy: NDArray  # (J, 2): joints, px of the picture
    score: NDArray  # (J,): confidence of each joint, from 0 to 1, or more: see `tracking.limited`
    # (J, 3): the network's own guess from the hip centre, m, axes as in cam; NaN without one.
    xyz_in_body: NDArray
    presence: float  # confidence that the region shows a person at all, 0 to 1
    region: Region  # where to look for the same person in the next frame

    @property
    def size_px(self) -> float:
        """The longer side of the box around the joints."""
        return float(np.ptp(self.xy, axis=0).max())


class PersonDetector(Protocol):
    """Finds persons in a whole picture."""

    side_px: int  # longer side of its input: larger pictures are shrunk to it

    def detect(self, image: NDArray) -> list[Region]:
        """Return the regions of all persons in a (H, W, 3) uint8 BGR picture, best first."""
        ...


class LandmarkNetwork:
    """Places the joints of one person: a subclass has `estimate` or `estimate_each`."""

    n_joints: int

    def estimate(self, image: NDArray, region: Region) -> Pose:
        """Return the `Pose` of the person in one `Region` of a (H, W, 3) uint8 BGR picture."""
        return self.estimate_each(image, [region])[0]

    def estimate_each(self, image: NDArray, regions: Sequence[Region]) -> list[Pose]:
        """Return the `Pose` of the person in each `Region` of such a picture."""
        return [self.estimate(image, region) for region in regions]


def around_box(low: NDArray, high: NDArray) -> Region:
    """Return the region of a person whose box has the corners `low` and `high`, (2,) px."""
    x, y = (low + high) / 2
    width, height = high - low
    side = SIDE_OF_BOX * max(width, height)
    return Region(float(x), float(y), float(side), box=(float(width), float(height)))


def cut_out(
    image: NDArray, region: Region, side_px: int, border: int = cv2.BORDER_CONSTANT
) -> NDArray:
    """Cut a rotated square out of a picture and scale it to a network's input.

    Parts outside the picture (H, W, 3) uint8 are filled as OpenCV's border mode says. Bilinear
    without half-pixel shift and without smoothing when it shrinks, as MediaPipe's OpenCV
    image-to-tensor calculator does: its networks were trained on such input.
    """
    scale = region.side / side_px
    cosine, sine = math.cos(region.angle_rad) * scale, math.sin(region.angle_rad) * scale
    half = side_px / 2
    image_from_patch = np.array(
        [
            [cosine, -sine, region.x - (cosine - sine) * half],
            [sine, cosine, region.y - (sine + cosine) * half],
        ]
    )
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    return cv2.warpAffine(
        image, image_from_patch, (side_px, side_px), flags=flags, borderMode=border
    )


def to_picture(fraction: NDArray, region: Region) -> NDArray:
    """Map fractions (..., 2) of a region's sides, from its first corner, to px of the picture."""
    centre = np.array([region.x, region.y])
    return centre + rotate((fraction - 0.5) * region.side, region.angle_rad)


def rotate(xy: NDArray, angle_rad: float) -> NDArray:
    """Rotate plane vectors (..., 2) by an angle that turns x towards y."""
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    return xy @ np.array([[cosine, sine], [-sine, cosine]])
