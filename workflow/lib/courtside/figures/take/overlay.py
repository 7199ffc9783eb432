"""Detected joints and the reprojected 3D skeleton on the pictures."""

from collections.abc import Sequence

import cv2
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from courtside.figures.style import style
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints2D, Keypoints3D
from courtside.records.keypoints.skeleton import Skeleton

MARGIN = 1.25  # of the person's extent, around it
PANEL_PX = 520  # longest side of a panel


def chosen_times(points: Keypoints3D, n_frames: int) -> NDArray:
    """Return `n_frames` times (s) evenly spread over a take, without its ends."""
    at = np.linspace(0, len(points.time_s) - 1, n_frames + 2)[1:-1].round().astype(int)
    return points.time_s[np.unique(at)]


def nearest(view: Keypoints2D, time_s: float) -> int:
    """Return the index of the frame of a `Keypoints2D` nearest to a time."""
    return int(np.abs(view.time_s - time_s).argmin())


def reproject(camera: Camera, points: Keypoints3D, time_s: float) -> NDArray:
    """Return the skeletons nearest to a time as one camera sees them, (P, J, 2) px."""
    at = int(np.abs(points.time_s - time_s).argmin())
    return camera_models.project(camera, points.xyz[:, at])


def table(
    cameras: list[list[Camera]],
    views: list[Keypoints2D],
    points: Keypoints3D,
    times_s: Sequence[float],
) -> pd.DataFrame:
    """Return detected and reprojected joints, one row per time, camera, person and joint.

    `cameras[time]` are the cameras as they stood then, `views` are in their order.
    """
    parts = []
    for time_s, standing in zip(times_s, cameras, strict=True):
        frame = int(np.abs(points.time_s - time_s).argmin())
        for at, (camera, view) in enumerate(zip(standing, views, strict=True)):
            detected = view.xy[:, nearest(view, time_s)].reshape(-1, 2)
            reprojected = reproject(camera, points, time_s).reshape(-1, 2)
            columns = {
                "time_s": time_s,
                "camera": camera.name,
                "person": np.repeat(points.person_id, len(points.joints)),
                "joint": np.tile(points.joints, len(points.person_id)),
                "detected_x_px": detected[:, 0],
                "detected_y_px": detected[:, 1],
                "reprojected_x_px": reprojected[:, 0],
                "reprojected_y_px": reprojected[:, 1],
                "distance_px": np.linalg.norm(detected - reprojected, axis=1),
                "accepted": points.accepted[:, frame, :, at].ravel(),
                "reason": [
                    missing_reason.WORDS[int(code)] for code in points.reason[:, frame].ravel()
                ],
            }
            parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def panel(
    image: NDArray, detected: NDArray, reprojected: NDArray, accepted: NDArray, skeleton: Skeleton
) -> NDArray:
    """Draw one picture (H, W, 3) BGR and cut out the part around the persons, (h, w, 3) BGR.

    `detected` and `reprojected` are (P, J, 2) px, `accepted` is (P, J).
    """
    width = max(1, round(_extent(detected, reprojected, image)[2] / 300))
    image = image.copy()
    for xy, colour in ((reprojected, style.REPROJECTED_BGR), (detected, style.DETECTED_BGR)):
        for person in xy:
            _draw_bones(image, person, skeleton, colour, width)
    for start, stop in zip(detected[~accepted], reprojected[~accepted], strict=True):
        _line(image, start, stop, style.REJECTED_BGR, width)
    x, y, side = _extent(detected, reprojected, image)
    cut = image[
        max(0, int(y - side / 2)) : int(y + side / 2), max(0, int(x - side / 2)) : int(x + side / 2)
    ]
    scale = min(1.0, PANEL_PX / max(cut.shape[:2]))
    return cv2.resize(cut, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)


def _extent(detected: NDArray, reprojected: NDArray, image: NDArray) -> tuple[float, float, float]:
    """Return centre x, y and side of the square to show; the whole picture if nobody is seen."""
    known = np.concatenate([detected, reprojected]).reshape(-1, 2)
    known = known[np.isfinite(known).all(axis=1)]
    if not len(known):
        return image.shape[1] / 2, image.shape[0] / 2, max(image.shape[:2])
    low, high = known.min(axis=0), known.max(axis=0)
    return (*((low + high) / 2), MARGIN * (high - low).max())


def _draw_bones(
    image: NDArray, xy: NDArray, skeleton: Skeleton, colour: tuple[int, int, int], width: int
) -> None:
    for start, stop in skeleton.bones:
        _line(image, xy[skeleton.index(start)], xy[skeleton.index(stop)], colour, width)
    for x, y in xy[np.isfinite(xy).all(axis=1)]:
        cv2.circle(image, (round(x), round(y)), 2 * width, colour, -1, cv2.LINE_AA)


def _line(
    image: NDArray, start: NDArray, stop: NDArray, colour: tuple[int, int, int], width: int
) -> None:
    if np.isfinite([start, stop]).all():
        ends = [tuple(int(v) for v in np.round(end)) for end in (start, stop)]
        cv2.line(image, *ends, colour, width, cv2.LINE_AA)


def draw(panels: list[list[NDArray]], times_s: Sequence[float], camera_names: list[str]) -> Figure:
    """Return the figure of `panels[time][camera]` (BGR): rows are times, columns cameras."""
    drawing = style.figure(18 + style.WIDTH_MM / len(camera_names) * len(times_s))
    axes = drawing.subplots(len(times_s), len(camera_names), squeeze=False)
    for row, time_s, line in zip(axes, times_s, panels, strict=True):
        for axis, name, image in zip(row, camera_names, line, strict=True):
            axis.imshow(image[:, :, ::-1])
            axis.set(xticks=[], yticks=[])
            axis.spines[:].set_visible(False)
            axis.set_title(f"{name}, {time_s:.2f} s")
    drawing.suptitle(
        "Detected (yellow), 3D skeleton reprojected (blue), view not used (red)", fontsize=8
    )
    return drawing
