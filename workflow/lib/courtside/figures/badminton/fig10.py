"""Skeletons with trajectories in 3D beside their detections, at several instants.

The counterpart of [Shishido2020, fig 10].
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.figures.style import oblique_view, picture_crops, style
from courtside.figures.style.stick_figure import Stick
from courtside.records.keypoints.keypoints import Keypoints3D

TRAILS = ("neck", "left_wrist", "right_wrist", "left_ankle", "right_ankle")
TRAIL_COLOURS = {"neck": style.CYCLE[2]}
SPACE_SHARE = 0.36  # of the width, for the 3D panel
ASPECT = 0.8  # width over height of a picture's panel
ROW_MM = (44, 54)  # height, least and most


def instants(frames: slice, count: int) -> NDArray:
    """Return `count` frames of a slice, evenly from its first to its last, (n,) int."""
    return np.unique(np.linspace(frames.start, frames.stop - 1, count).round().astype(int))


def trails(xyz: NDArray, stick: Stick, frames: slice) -> dict[str, NDArray]:
    """Return the paths (P, n, 3) of the joints `TRAILS` over some frames.

    `xyz` (P, T, K, 3) m are the stick figure's joints.
    """
    return {joint: xyz[:, frames, stick.joints.index(joint)] for joint in TRAILS}


def table(points: Keypoints3D, stick: Stick, frames: slice, shown: Sequence[int]) -> pd.DataFrame:
    """Return the trails as numbers.

    time_s, person, joint, x_m, y_m, z_m of all joints of the figure in all frames; drawn: whether
    the skeleton of that time is drawn (`shown`); trail: whether the joint has one.
    """
    xyz = stick.of(points.xyz)[:, frames]
    at = np.arange(frames.start, frames.stop)
    n_persons, n_frames, n_joints = xyz.shape[:3]
    columns = {
        "time_s": np.tile(np.repeat(points.time_s[frames], n_joints), n_persons),
        "person": np.repeat(points.person_id, n_frames * n_joints),
        "joint": np.tile(stick.joints, n_persons * n_frames),
        **{f"{axis}_m": xyz[..., n].ravel() for n, axis in enumerate("xyz")},
        "drawn": np.tile(np.repeat(np.isin(at, shown), n_joints), n_persons),
    }
    rows = pd.DataFrame(columns)
    return rows.assign(trail=rows.joint.isin(TRAILS))


def draw(
    points: Keypoints3D,
    stick: Stick,
    frames: slice,
    shown: Sequence[int],
    pictures: list[dict[str, tuple[NDArray, NDArray]]],
    court: Court | None = None,
) -> Figure:
    """Draw a row for each instant: each camera's picture with its detections, then the 3D skeleton.

    The trails begin at the first of `frames`; `shown` are the instants' frames of `points`.
    `pictures` are for each instant by camera the picture (H, W, 3) BGR and the detected joints
    (P, K, 2) px of the figure.
    """
    names = list(pictures[0])
    width = style.WIDTH_MM * (1 - SPACE_SHARE) / len(names)
    height = np.clip(width / ASPECT, *ROW_MM)
    drawing = style.figure(len(shown) * height + 12)
    drawing.get_layout_engine().set(h_pad=0.02, hspace=0.0)
    grid = drawing.add_gridspec(
        len(shown),
        len(names) + 1,
        width_ratios=[*[width] * len(names), style.WIDTH_MM * SPACE_SHARE],
    )
    parts = {name: _common_box(pictures, name, width / height) for name in names}
    xyz = stick.of(points.xyz)
    line = 1.5 * np.sqrt(width / 60)
    for row, (frame, by_camera) in enumerate(zip(shown, pictures, strict=True)):
        for column, name in enumerate(names):
            axis, (image, detected) = drawing.add_subplot(grid[row, column]), by_camera[name]
            picture_crops.show(axis, image, parts[name])
            picture_crops.sticks(axis, detected, stick.bones, picture_crops.DETECTED, width=line)
            axis.set_title(name if not row else "", pad=3)
            if not column:
                axis.set_ylabel(f"{points.time_s[frame]:.2f} s")
        axis = drawing.add_subplot(grid[row, -1])
        _draw_space(axis, xyz, stick, (frames, frame), court)
    _explain(drawing)
    return drawing


def _common_box(pictures: list[dict], name: str, aspect: float) -> picture_crops.Box:
    """Return the part of a camera's pictures that shows the persons at all instants."""
    detected = [by_camera[name][1] for by_camera in pictures]
    image = max((by_camera[name][0] for by_camera in pictures), key=np.size)
    return picture_crops.box(detected, image.shape[1::-1], aspect)


def _draw_space(
    axis: Axes, xyz: NDArray, stick: Stick, when: tuple[slice, int], court: Court | None
) -> None:
    frames, now = when
    sight, past = oblique_view.Sight(), slice(frames.start, now + 1)
    corners = oblique_view.limits(xyz[:, frames])
    oblique_view.floor(axis, sight, *corners, court)
    oblique_view.figures(axis, sight, xyz[:, now], stick)
    for joint, paths in trails(xyz, stick, past).items():
        colour = TRAIL_COLOURS.get(joint, style.side_colour(joint))
        for path in paths:
            oblique_view.line(axis, sight, path, ".-", color=colour, markersize=2, linewidth=0.7)
    low, high = corners
    oblique_view.finish(axis, sight, low)
    ends = np.array([low, (high[0], high[1], 0), (high[0], low[1], 0)])
    places = sight.seen(np.concatenate([xyz[:, frames].reshape(-1, 3), ends]))
    axis.update_datalim(places[np.isfinite(places).all(axis=1)])
    axis.margins(0.02)
    axis.autoscale_view()


def _explain(drawing: Figure) -> None:
    looks = [
        (picture_crops.DETECTED, "", 2.5, "detected"),
        (style.LEFT, "", 1.4, "left side"),
        (style.RIGHT, "", 1.4, "right side"),
        (TRAIL_COLOURS["neck"], ".", 0.7, "trails of neck, wrists, ankles: a dot per frame"),
    ]
    handles = [
        Line2D([], [], color=colour, marker=marker, linewidth=width, markersize=3)
        for colour, marker, width, _ in looks
    ]
    words = [word for *_, word in looks]
    drawing.legend(handles, words, loc="outside lower center", ncols=len(words), fontsize=7)
