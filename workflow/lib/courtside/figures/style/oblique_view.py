"""Oblique view from above, in parallel projection: skeletons, paths, court and cameras to scale."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.figures.style import style
from courtside.figures.style.stick_figure import Stick
from courtside.geometry.camera import Camera

ROOM_M = 0.2  # around what is shown
AXIS_M = 0.5  # length of the axes drawn
MOST_STEPS = 50  # lines of a grid on the floor
FLOOR = "#bbbbbb"


@dataclass(frozen=True)
class Sight:
    """The direction from which a scene is drawn.

    The azimuth of the observer is from the world's x axis towards y, the elevation above the floor.
    """

    azimuth_deg: float = -62.0
    elevation_deg: float = 16.0

    def seen(self, xyz: NDArray) -> NDArray:
        """Return points (..., 3) m of the world on the drawing, (..., 2) m: right and up."""
        azimuth, elevation = np.radians([self.azimuth_deg, self.elevation_deg])
        right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        level, up = np.cos(elevation), np.sin(elevation)
        towards = np.array([np.cos(azimuth) * level, np.sin(azimuth) * level, up])
        return np.asarray(xyz, dtype=float) @ np.column_stack([right, np.cross(towards, right)])


def line(axis: Axes, sight: Sight, xyz: NDArray, form: str = "-", **look: Any) -> None:
    """Draw a path (n, 3) m; `form` and `look` are matplotlib's."""
    axis.plot(*sight.seen(xyz).T, form, **look)


def figures(axis: Axes, sight: Sight, xyz: NDArray, stick: Stick) -> None:
    """Draw stick figures (P, K, 3) m, each line in the colour of its side."""
    for person in xyz:
        for start, stop in stick.bones:
            colour = style.side_colour(stick.joints[start], stick.joints[stop])
            look: dict = {"color": colour, "linewidth": 1.4, "solid_capstyle": "round"}
            line(axis, sight, person[[start, stop]], zorder=3, **look)


def floor(
    axis: Axes, sight: Sight, low: NDArray, high: NDArray, court: Court | None = None
) -> None:
    """Draw the floor in a rectangle (corners in metres): the court's lines, or a grid."""
    low, high = np.asarray(low)[:2], np.asarray(high)[:2]
    corners = np.array([low, (high[0], low[1]), high, (low[0], high[1]), low])
    for x, y in [np.transpose(corners), *_painted(low, high, court)]:
        x, y = np.clip(x, low[0], high[0]), np.clip(y, low[1], high[1])
        line(axis, sight, np.column_stack([x, y, 0 * x]), color=FLOOR, linewidth=0.6, zorder=1)


def _painted(low: NDArray, high: NDArray, court: Court | None) -> NDArray:
    """Return the centre lines of painted lines, (2, 2) each: x of both ends, y of both ends."""
    if court is None:
        xs, ys = grid_m(low, high)
        grid = [((x, x), (low[1], high[1])) for x in xs]
        return np.array(grid + [((low[0], high[0]), (y, y)) for y in ys])
    x0, y0, x1, y1 = np.asarray(court.lines_m).T
    across = x1 - x0 > y1 - y0
    middle_x, middle_y = (x0 + x1) / 2, (y0 + y1) / 2
    x = np.where(across, [x0, x1], middle_x)
    y = np.where(across, middle_y, [y0, y1])
    lines = np.stack([x.T, y.T], axis=1)
    inside = [
        (ends.max(axis=1) >= low).all() and (ends.min(axis=1) <= high).all() for ends in lines
    ]
    return lines[inside]


def step_m(low: NDArray, high: NDArray) -> float:
    """Return the distance of the lines of a grid: 1 m, in a very wide box 10 m and so on."""
    return float(10.0 ** max(0.0, np.ceil(np.log10(np.max(high - low) / MOST_STEPS))))


def grid_m(low: NDArray, high: NDArray) -> list[NDArray]:
    """Return where the lines of a grid are along x and along y, between two corners, m."""
    step = step_m(low, high)
    pairs = zip(low[:2], high[:2], strict=True)
    return [np.arange(np.ceil(a / step) * step, b + 1e-9, step) for a, b in pairs]


def net(axis: Axes, sight: Sight, court: Court | None) -> None:
    """Draw the outline of a court's net, if it has one."""
    if court is None or court.net is None:
        return
    (x0, x1), y, top = court.net["x_m"], court.net["y_m"], court.net["post_height_m"]
    x, z = [x0, x0, (x0 + x1) / 2, x1, x1], [0, top, court.net["mid_height_m"], top, 0]
    xyz = np.column_stack([x, np.full(5, y), z])
    line(axis, sight, xyz, color="#999999", linewidth=0.8, zorder=2)


def camera(axis: Axes, sight: Sight, one: Camera, depth_m: float) -> None:
    """Draw a camera as its viewing pyramid of height `depth_m`, with its name."""
    width, height = one.size
    pixels = np.array([[0, 0], [width, 0], [width, height], [0, height]], dtype=float)
    in_cam = np.column_stack([(pixels - one.K[:2, 2]) / np.diag(one.K)[:2], np.ones(4)]) * depth_m
    corners = one.centre_in_world + in_cam @ one.cam_from_world[:, :3]
    look: dict = {"color": "black", "linewidth": 0.7, "zorder": 4}
    for corner in corners:
        line(axis, sight, np.stack([one.centre_in_world, corner]), **look)
    line(axis, sight, corners[[0, 1, 2, 3, 0]], **look)
    place = sight.seen(one.centre_in_world)
    look = {"textcoords": "offset points", "ha": "center", "va": "top", "fontsize": 7}
    axis.annotate(one.name, place, (0, -4), **look)


def limits(xyz: NDArray, percentiles: tuple[float, float] = (0, 100)) -> tuple[NDArray, NDArray]:
    """Return the corners (3,), (3,) m of the box on half metres that holds the known points."""
    known = np.reshape(xyz, (-1, 3))
    known = known[np.isfinite(known).all(axis=1)]
    low, high = np.percentile(known if len(known) else np.zeros((1, 3)), percentiles, axis=0)
    return np.floor(2 * (low - ROOM_M)) / 2, np.ceil(2 * (high + ROOM_M)) / 2


def finish(axis: Axes, sight: Sight, corner: NDArray) -> None:
    """Finish a drawing to scale without a frame, with the world's axes at a corner on the floor."""
    origin = np.array([*np.asarray(corner, dtype=float)[:2], 0.0])
    for name, along in zip("xyz", AXIS_M * np.eye(3), strict=True):
        ends = np.stack([origin, origin + along])
        line(axis, sight, ends, color="black", linewidth=1.0, zorder=4)
        words = f"z ({AXIS_M:g} m)" if name == "z" else name
        place = sight.seen(origin + 1.25 * along)
        axis.text(*place, words, fontsize=6, ha="center", va="center")
    axis.set_aspect("equal")
    axis.set_axis_off()
