"""Detected joints and the reprojected 3D skeleton on the pictures."""

from collections.abc import Sequence
from itertools import product

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from courtside.figures.style import picture_crops, style
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.keypoints.skeleton import Skeleton

LINE = 1.6  # points, in a panel as wide as the page


def frames(points: Keypoints3D, count: int) -> NDArray:
    """Return `count` frames (n,) evenly spread over a take, without its ends."""
    at = np.linspace(0, len(points.time_s) - 1, count + 2)[1:-1]
    return np.unique(at.round().astype(int))


def seen(
    points: Keypoints3D, one: Footage, frame: int, skeleton: Skeleton
) -> tuple[NDArray, NDArray]:
    """Return the joints that a camera detected nearest to a frame, and reprojected, (P, J, 2) px.

    The frame is of `points`; the 3D joints are those of the picture's time, and the sides of the
    detected ones are as the fusion took them. All are NaN where the camera does not film.
    """
    detected, reprojected = picture_crops.joints_at(one, points, frame)
    mirror = skeleton.mirror()
    detected = picture_crops.as_fused(points, frame, one.camera.name, detected, mirror)
    return detected, reprojected


def table(
    points: Keypoints3D, footage: list[Footage], shown: Sequence[int], skeleton: Skeleton
) -> pd.DataFrame:
    """Return detected and reprojected joints, one row per frame, camera, person and joint.

    `footage` is of the cameras of `points`, in their order; `shown` are frames of `points`.
    """
    parts = []
    for frame, (at, one) in product(shown, enumerate(footage)):
        detected, reprojected = (xy.reshape(-1, 2) for xy in seen(points, one, frame, skeleton))
        columns = {
            "time_s": points.time_s[frame],
            "camera": one.camera.name,
            "person": np.repeat(points.person_id, len(points.joints)),
            "joint": np.tile(points.joints, len(points.person_id)),
            "detected_x_px": detected[:, 0],
            "detected_y_px": detected[:, 1],
            "reprojected_x_px": reprojected[:, 0],
            "reprojected_y_px": reprojected[:, 1],
            "distance_px": np.linalg.norm(detected - reprojected, axis=1),
            "accepted": points.accepted[:, frame, :, at].ravel(),
            "reason": [missing_reason.WORDS[int(code)] for code in points.reason[:, frame].ravel()],
        }
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def draw(
    points: Keypoints3D,
    footage: list[Footage],
    shown: Sequence[int],
    images: list[list[NDArray]],
    skeleton: Skeleton,
) -> Figure:
    """Draw the pictures of all cameras for each frame in turn; arguments as for `table`.

    `images[row][column]` (H, W, 3) are BGR, with faces hidden if asked for.
    """
    lines, columns = style.wrapped(len(footage))
    drawing = style.figure(18 + style.WIDTH_MM / columns * len(shown) * lines)
    axes = drawing.subplots(len(shown) * lines, columns, squeeze=False)
    for row, frame in enumerate(shown):
        panels = axes[row * lines : (row + 1) * lines].ravel()
        for at, (axis, one) in enumerate(zip(panels, footage, strict=False)):
            both, image = seen(points, one, frame, skeleton), images[row][at]
            picture_crops.show(axis, image, picture_crops.box(both, image.shape[1::-1]))
            line = LINE / np.sqrt(columns)
            picture_crops.compare(axis, *both, skeleton.bone_indices(), line)
            unused = ~points.accepted[:, frame, :, at]
            for ends in np.stack(both, axis=2)[unused]:
                axis.plot(*ends.T, color=picture_crops.MARKED, linewidth=1.0, zorder=4)
            axis.set_title(f"{one.camera.name}, {points.time_s[frame]:.2f} s")
        for axis in panels[len(footage) :]:
            axis.remove()
    words = "Detected (yellow), 3D skeleton reprojected (blue), view not used (red)"
    drawing.suptitle(words, fontsize=8)
    return drawing
