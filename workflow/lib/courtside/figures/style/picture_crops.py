"""Parts of a picture around a person, with stick figures drawn on them as vector lines."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from courtside.figures.style import style
from courtside.pose import privacy
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import StrPath
from courtside.video import reader

MARGIN = 1.2  # of the person's extent, around it
LARGEST_PX = 800  # longest side of what is kept of a picture
NOT_FILMED = "does not film then"
LEAST_PX = 60  # the smallest box: for a person with only one or two known joints
DETECTED, REPROJECTED, MARKED = (
    tuple(value / 255 for value in bgr[::-1])
    for bgr in (style.DETECTED_BGR, style.REPROJECTED_BGR, style.REJECTED_BGR)
)


@dataclass(frozen=True)
class Box:
    """A part of a picture: centre, width and height, px; it may reach beyond the picture."""

    x: float
    y: float
    width: float
    height: float


def read(
    video: StrPath,
    time_s: float,
    persons: Sequence[NDArray],
    skeleton: Skeleton,
    *,
    others: Sequence[NDArray] | NDArray,
    hidden: bool,
) -> NDArray:
    """Return a video's frame (H, W, 3) BGR at a time of its own clock; `hidden`: without faces.

    `persons` are the joints (P, J, 2) px of the same persons by one or more methods, such as
    detected and reprojected: where one of them does not know a face, another may. `others` are the
    joints (J, 2) px of all whose faces may lie before a person's body.
    """
    _, image = reader.read_frame(video, time_s)
    if not hidden:
        return image
    body = privacy.Body.of(skeleton)
    image = privacy.only_persons(image, np.concatenate(persons), body)
    # The joints of all methods side by side: one face of each person.
    everybody = np.concatenate(persons, axis=1)
    image = privacy.hide_faces(image, everybody, privacy.Body.of(skeleton, len(persons)))
    return privacy.hide_faces(image, others, body)


def at_frame(
    one: Footage, points: Keypoints3D, frame: int, skeleton: Skeleton, *, hidden: bool
) -> tuple[NDArray, NDArray, NDArray]:
    """Return a camera's picture at a frame of a take, as `read`, and the joints in it.

    The joints are those of `joints_at`. A picture without pixels where the camera does not film.
    """
    at, both = one.frame_at(points.time_s[frame]), joints_at(one, points, frame)
    if at is None:
        return np.zeros((0, 0, 3), np.uint8), *both
    if one.video is None:
        raise ValueError(f"expected a video of camera {one.camera.name}, found none")
    others = privacy.around(one.tracklets.time_s, one.tracklets.xy, at)
    image = read(one.video, one.view.time_s[at], both, skeleton, others=others, hidden=hidden)
    return image, *both


def joints_at(one: Footage, points: Keypoints3D, frame: int) -> tuple[NDArray, NDArray]:
    """Return the joints in a camera's picture nearest to a frame of `points`, (P, J, 2) px.

    Those detected, and those of `points` reprojected, both of the time of the picture. All are NaN
    where the camera does not film.
    """
    at = one.frame_at(points.time_s[frame])
    if at is None:
        nowhere = np.full((*points.xyz[:, frame].shape[:2], 2), np.nan)
        return nowhere, nowhere
    return one.view.xy[:, at], one.reprojected(points, at)


def as_fused(
    points: Keypoints3D, frame: int, camera: str, xy: NDArray, mirror: Sequence[int]
) -> NDArray:
    """Return a camera's detected joints (P, J, 2) px with left and right as the fusion took them.

    `frame` is that of `points` which the joints are compared with; `mirror` holds for each joint
    the index of the same one on the other body side.
    """
    exchanged = points.swapped[:, frame, :, list(points.cameras).index(camera), None]
    return np.where(exchanged, xy[:, mirror], xy)


def box(xy: ArrayLike, size: tuple[int, int], aspect: float = 1.0) -> Box:
    """Return the part of a picture that shows some points (..., 2) px; all of it if none is known.

    `size` is width and height of the picture, `aspect` width over height of the part.
    """
    known = np.asarray(xy, dtype=float).reshape(-1, 2)
    known = known[np.isfinite(known).all(axis=1)]
    if not len(known):
        known = np.array([[0, 0], size], dtype=float) / MARGIN
        known += np.array(size) * (1 - 1 / MARGIN) / 2
    low, high = known.min(axis=0), known.max(axis=0)
    width, height = np.maximum(MARGIN * (high - low), LEAST_PX)
    width, height = max(width, height * aspect), max(height, width / aspect)
    x, y = (low + high) / 2
    return Box(x, y, width, height)


def show(axis: Axes, image: NDArray, part: Box) -> None:
    """Show a part of a picture (BGR) in the picture's own coordinates, empty beyond its edges.

    Of a picture without pixels, it says that the camera does not film.
    """
    left, top = part.x - part.width / 2, part.y - part.height / 2
    x0, y0 = max(0, int(left)), max(0, int(top))
    x1, y1 = (max(0, int(np.ceil(end)) + 1) for end in (left + part.width, top + part.height))
    cut = image[y0:y1, x0:x1, ::-1]
    extent = (x0 - 0.5, x0 + cut.shape[1] - 0.5, y0 + cut.shape[0] - 0.5, y0 - 0.5)
    if cut.size:
        scale = min(1.0, LARGEST_PX / max(cut.shape[:2]))
        if scale < 1:  # what no print shows would only make the file large
            cut = cv2.resize(
                np.ascontiguousarray(cut), None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA
            )
        axis.imshow(cut, extent=extent, interpolation="bicubic")
    elif not image.size:
        look = {"ha": "center", "va": "center", "fontsize": 7, "transform": axis.transAxes}
        axis.text(0.5, 0.5, NOT_FILMED, **look)
    axis.set(xlim=(left, left + part.width), ylim=(top + part.height, top))
    axis.set(xticks=[], yticks=[], aspect="equal", facecolor="#eeeeee")
    axis.spines[:].set_visible(False)


def sticks(
    axis: Axes,
    xy: NDArray,
    bones: Sequence[tuple[int, int]],
    colour: str | tuple[float, ...],
    *,
    width: float = 1.2,
    outline: float = 0.8,
    dots: bool = True,
) -> None:
    """Draw one or more stick figures (..., K, 2) px; a line without both ends is left out.

    `width` is that of a line in points, `outline` how much wider the black line behind it is;
    `dots` says whether joints are drawn.
    """
    behind = [(width + outline, "black")] if outline else []
    for one in np.reshape(xy, (-1, *np.shape(xy)[-2:])):
        ends = [one[list(bone)] for bone in bones if np.isfinite(one[list(bone)]).all()]
        for line_width, line_colour in (*behind, (width, colour)):
            look = {"linewidth": line_width, "solid_capstyle": "round", "color": line_colour}
            for end in ends:
                axis.plot(*end.T, **look)
        if dots:
            look = {"markersize": 2.2 * width, "markeredgewidth": outline / 2, "zorder": 3}
            axis.plot(*one.T, "o", color=colour, markeredgecolor="black", **look)


def compare(
    axis: Axes,
    detected: NDArray,
    reprojected: NDArray,
    bones: Sequence[tuple[int, int]],
    width: float,
) -> None:
    """Draw reprojected stick figures (..., K, 2) px over the detected ones, which are wider."""
    sticks(axis, detected, bones, DETECTED, width=2.2 * width, dots=False)
    sticks(axis, reprojected, bones, REPROJECTED, width=width, outline=0)


def rings(axis: Axes, xy: NDArray, size: float = 9.0) -> None:
    """Put red rings (`size` in points) around points (n, 2)."""
    look = {"markersize": size, "markerfacecolor": "none", "markeredgewidth": 1.3, "zorder": 4}
    axis.plot(*np.reshape(xy, (-1, 2)).T, "o", markeredgecolor=MARKED, **look)
