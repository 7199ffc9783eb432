"""Path of the neck over the court, its speed, and joint angles."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from courtside.calibration.court.court import Court
from courtside.figures.style import court_plan, style, windows
from courtside.statistics import normal_errors

ROW_MM = 105
ROOM_M = 0.5  # around the path, where it leaves the court
CELL_M = 0.25  # of the floor, whose time is shown of a long take
SPEEDS = {"neck": style.CYCLE[0], "mass": style.CYCLE[1]}
NAMES = {"neck": "neck", "mass": "centre of mass"}
ANGLES = {
    "left_knee_flexion": style.LEFT,
    "right_knee_flexion": style.RIGHT,
    "trunk_lean": style.MIDDLE,
}


def table(frames: pd.DataFrame) -> pd.DataFrame:
    """Return the numbers drawn: the columns of `courtside.exports.measures.frames` in use."""
    drawn = ["time_s", "person", "neck_x_m", "neck_y_m"]
    drawn += [f"{name}_ground_speed_{end}" for name in SPEEDS for end in ("m_s", "sd_m_s")]
    drawn += [f"{name}_{end}" for name in ANGLES for end in ("deg", "sd_deg")]
    return frames[drawn]


def draw(frames: pd.DataFrame, summary: pd.DataFrame, court: Court | None) -> Figure:
    """Draw each person in a row: the neck's path from above, speeds and angles over time.

    `frames` and `summary` are of `courtside.exports.measures`. Bands, and the limits of the
    distance, are 90 % intervals from keypoints, network and, where known, cameras. Of a take of
    minutes there are the time in each part of the floor, and medians and ranges of windows.
    """
    people = list(dict.fromkeys(frames.person))
    window_s = windows.length_s(frames.time_s.to_numpy())
    drawing = style.figure(ROW_MM * max(len(people), 1))
    for row, part in enumerate(drawing.subfigures(len(people), 1, squeeze=False)[:, 0]):
        grid = part.add_gridspec(2, 2, width_ratios=(1.0, 1.6))
        own = frames[frames.person == people[row]]
        measured = summary[summary.person == people[row]].set_index("measure")
        plan = part.add_subplot(grid[:, 0])
        _draw_path(plan, own, measured, court, people[row], window_s)
        speed = part.add_subplot(grid[0, 1])
        _draw_speeds(speed, own, window_s)
        _draw_angles(part.add_subplot(grid[1, 1], sharex=speed), own, window_s)
    return drawing


def _draw_path(
    axis: Axes,
    own: pd.DataFrame,
    measured: pd.DataFrame,
    court: Court | None,
    person: str,
    window_s: int,
) -> None:
    if court is not None:
        court_plan.draw(axis, court)
    x, y = (own[key].to_numpy() for key in ("neck_x_m", "neck_y_m"))
    known = np.flatnonzero(np.isfinite(x))
    if window_s and known.size:
        _draw_time(axis, own.iloc[known])
    else:
        axis.plot(x, y, color=SPEEDS["neck"], linewidth=0.9, zorder=3)
    for at, mark, word in (
        zip(known[[0, -1]], "os", ("start", "end"), strict=True) if known.size else ()
    ):
        axis.plot(x[at], y[at], mark, color=SPEEDS["neck"], markersize=4, zorder=4, label=word)
    found = measured.loc["neck_ground_distance"]
    cameras = 0.0 if np.isnan(found.sigma_camera) else found.sigma_camera
    reach = normal_errors.WITHIN_90 * np.hypot(found.sigma, cameras)
    digits = normal_errors.decimals(reach) if reach > 0 else 2
    length = f"{found.value:.{digits}f} ± {reach:.{digits}f} m on the ground (90 %)"
    if np.isnan(found.value):
        length = "distance unknown: gaps too long, or errors not known"
    axis.set_title(f"{person}: neck from above\n{length}")
    if known.size and court is not None:
        axis.set_ylim(
            min(0.0, np.min(y[known])) - ROOM_M,
            max(np.max(y[known]), court.size_m[1] / 2) + ROOM_M,
        )
    if known.size:
        axis.legend(loc="best", fontsize=7, frameon=True, edgecolor="none")
    axis.set(xlabel="x (m)", ylabel="y (m)")
    axis.set_aspect("equal", adjustable="box" if court else "datalim")


def _draw_time(axis: Axes, known: pd.DataFrame) -> None:
    """Draw how long the neck was above each cell of the floor; the paths would cover each other."""
    x, y = known.neck_x_m.to_numpy(), known.neck_y_m.to_numpy()
    step_s = float(np.median(np.diff(known.time_s))) if len(known) > 1 else np.nan
    edges = [
        np.arange(np.floor(way.min() / CELL_M), np.floor(way.max() / CELL_M) + 2) * CELL_M
        for way in (x, y)
    ]
    seconds = np.histogram2d(x, y, edges)[0].T * step_s
    look: dict = {"cmap": "Blues", "norm": LogNorm(), "zorder": 1.5}
    image = axis.pcolormesh(*edges, np.where(seconds > 0, seconds, np.nan), **look)
    where = f"time in each {CELL_M:g} m square (s)"
    axis.get_figure(root=False).colorbar(image, ax=axis, location="bottom", label=where)


def _band(
    axis: Axes,
    own: pd.DataFrame,
    name: str,
    ends: tuple[str, str],
    *,
    colour: str,
    label: str,
    window_s: int,
) -> None:
    value, sigma = (own[f"{name}_{end}"].to_numpy() for end in ends)
    if window_s:
        windows.draw(axis, own.time_s.to_numpy(), value, window_s, colour=colour, label=label)
        return
    reach = normal_errors.WITHIN_90 * sigma
    band = own.time_s, value - reach, value + reach
    axis.fill_between(*band, color=colour, alpha=0.2, linewidth=0)
    axis.plot(own.time_s, value, color=colour, linewidth=0.9, label=label)


def _draw_speeds(axis: Axes, own: pd.DataFrame, window_s: int) -> None:
    for name, colour in SPEEDS.items():
        look: dict = {"colour": colour, "label": NAMES[name], "window_s": window_s}
        _band(axis, own, name, ("ground_speed_m_s", "ground_speed_sd_m_s"), **look)
    each = ":\nmedian and 5 to 95 %" if window_s else ""
    axis.set(ylabel=f"ground speed (m/s){each}")
    axis.set_ylim(bottom=0)
    axis.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, borderaxespad=0)
    axis.tick_params(labelbottom=False)


def _draw_angles(axis: Axes, own: pd.DataFrame, window_s: int) -> None:
    for name, colour in ANGLES.items():
        look: dict = {"colour": colour, "label": name.replace("_", " "), "window_s": window_s}
        _band(axis, own, name, ("deg", "sd_deg"), **look)
    each = f": median and 5 to 95 % of each {window_s} s" if window_s else ""
    axis.set(xlabel=f"time (s){each}", ylabel="angle (degrees)")
    axis.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3, borderaxespad=0)
