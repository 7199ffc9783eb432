"""The metric skeletons in the hall, with the paths of hands and feet."""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from courtside.figures.style import oblique_view, style
from courtside.geometry.camera import Camera
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.keypoints.skeleton import Skeleton

PATHS = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
PERCENTILES = (0.5, 99.5)  # of the joints' positions, shown: without gross outliers
ARROW_POINTS, AWAY_POINTS = 18, 5  # of a camera's direction, and from its tip to the name
NAME_POINTS = 9  # from a person's last place to the name
BELOW_MM = 10.5  # from the panel to the legend, for the numbers and the label of the axis
N_POSES = 5
MOST_NUMBERS = 10  # along the longer side of the floor in perspective
DEEP_M = 0.5  # the box of people on the floor begins so far below it; others are not on z = 0


def table(points: Keypoints3D) -> pd.DataFrame:
    """Return the drawn paths: time_s, person, joint, x_m, y_m, z_m."""
    parts = [
        pd.DataFrame(
            {
                "time_s": points.time_s,
                "person": str(person),
                "joint": joint,
                **{f"{axis}_m": xyz[:, n] for n, axis in enumerate("xyz")},
            }
        )
        for at, person in enumerate(points.person_id)
        for joint in PATHS
        for xyz in [points.xyz[at, :, list(points.joints).index(joint)]]
    ]
    return pd.concat(parts, ignore_index=True)


def draw(points: Keypoints3D, cameras: list[Camera], skeleton: Skeleton) -> Figure:
    """Draw skeletons at several times, in perspective and from above."""
    drawing = style.figure(95)
    space = drawing.add_subplot(1, 2, 1, projection="3d")
    above = drawing.add_subplot(1, 2, 2)
    _draw_space(space, points, skeleton)
    _draw_above(above, points, cameras, skeleton)
    return drawing


def _bones(points: Keypoints3D, skeleton: Skeleton) -> Iterator[tuple[NDArray, str, float]]:
    """Yield both ends (2, 3), colour and opacity of every bone to draw."""
    frames = np.unique(np.linspace(0, len(points.time_s) - 1, N_POSES).round().astype(int))
    for frame, opacity in zip(frames, np.linspace(0.35, 1.0, len(frames)), strict=True):
        for person in range(len(points.person_id)):
            xyz = points.xyz[person, frame]
            for start, stop in skeleton.bones:
                ends = xyz[[skeleton.index(start), skeleton.index(stop)]]
                yield ends, style.side_colour(start, stop), opacity


def _paths(points: Keypoints3D) -> Iterator[tuple[NDArray, str]]:
    for joint in PATHS:
        at = list(points.joints).index(joint)
        for person in range(len(points.person_id)):
            yield points.xyz[person, :, at], style.side_colour(joint)


def _draw_space(axis: Axes, points: Keypoints3D, skeleton: Skeleton) -> None:
    low, high = oblique_view.limits(points.xyz, PERCENTILES)
    for ends, colour, opacity in _bones(points, skeleton):
        axis.plot(*ends.T, color=colour, alpha=opacity, linewidth=1.2)
    for path, colour in _paths(points):
        axis.plot(*path.T, color=colour, linewidth=0.6, alpha=0.8)
    _floor(axis, low, high)
    bottom = low[2] if low[2] < -DEEP_M else 0.0
    axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(bottom, high[2]))
    axis.set(xlabel="x (m)", ylabel="y (m)")
    # A label of the axis itself would lie on that of the panel beside.
    axis.text(high[0], high[1], high[2], "z (m)", ha="center", va="bottom")
    axis.set_box_aspect((high[0] - low[0], high[1] - low[1], high[2] - bottom), zoom=0.9)
    step_m = oblique_view.step_m(low, high)
    axis.zaxis.set_major_locator(MultipleLocator(step_m))
    step_m *= np.ceil((high - low)[:2].max() / step_m / MOST_NUMBERS)
    for each in (axis.xaxis, axis.yaxis):
        each.set_major_locator(MultipleLocator(step_m))
    axis.view_init(elev=18, azim=-60)
    axis.set_title("Skeletons and paths of wrists and ankles")


def _floor(axis: Axes, low: NDArray, high: NDArray) -> None:
    xs, ys = oblique_view.grid_m(low, high)
    for x in xs:
        axis.plot([x, x], [low[1], high[1]], [0, 0], color="#cccccc", linewidth=0.5)
    for y in ys:
        axis.plot([low[0], high[0]], [y, y], [0, 0], color="#cccccc", linewidth=0.5)


def _draw_above(axis: Axes, points: Keypoints3D, cameras: list[Camera], skeleton: Skeleton) -> None:
    for ends, colour, opacity in _bones(points, skeleton):
        axis.plot(*ends[:, :2].T, color=colour, alpha=opacity, linewidth=1.0)
    for path, colour in _paths(points):
        axis.plot(*path[:, :2].T, color=colour, linewidth=0.6, alpha=0.8)
    for camera in cameras:
        _draw_camera(axis, camera)
    if len(points.person_id) > 1:
        _name_persons(axis, points)
    for label, colour in (("left", style.LEFT), ("right", style.RIGHT), ("middle", style.MIDDLE)):
        axis.plot([], [], color=colour, label=label)
    style.legend_below(axis, BELOW_MM, ncols=3)
    axis.set(xlabel="x (m)", ylabel="y (m)", title="From above, with the cameras")
    axis.set_aspect("equal", adjustable="datalim")
    axis.margins(0.12)
    axis.grid()


def _name_persons(axis: Axes, points: Keypoints3D) -> None:
    """Write each person's name where the person is last."""
    middle = np.ma.masked_invalid(points.xyz[..., :2]).mean(axis=2).filled(np.nan)
    for person, path in zip(points.person_id, middle, strict=True):
        known = path[np.isfinite(path).all(axis=1)]
        if len(known):
            box = {"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 0.6}
            look: dict = {"textcoords": "offset points", "ha": "center", "fontsize": 7, "bbox": box}
            axis.annotate(str(person), known[-1], (0, NAME_POINTS), **look)


def _draw_camera(axis: Axes, camera: Camera) -> None:
    """Draw a camera, its direction as long in any hall, and its name beyond: there is room."""
    x, y, z = camera.centre_in_world
    forward = camera.cam_from_world[2, :2]
    axis.plot(x, y, "ks", markersize=4)
    look: dict = {"textcoords": "offset points", "ha": "center"}
    arrow = {"arrowstyle": "<-", "shrinkA": 0, "shrinkB": 0, "linewidth": 1.0}
    axis.annotate("", (x, y), tuple(ARROW_POINTS * forward), arrowprops=arrow, **look)
    up = forward[1] >= 0
    right, ahead = ARROW_POINTS * forward
    place = (right, ahead + (AWAY_POINTS if up else -AWAY_POINTS))
    look |= {"va": "bottom" if up else "top", "fontsize": 7}
    axis.annotate(f"{camera.name}\nz = {z:.1f} m", (x, y), place, **look)
