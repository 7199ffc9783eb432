"""Path of the neck over the court, its speed, and joint angles."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.calibration.court.court import Court
from courtside.figures.style import court_plan, style
from courtside.statistics import normal_errors

ROW_MM = 105
ROOM_M = 0.5  # around the path, where it leaves the court
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
    distance, are 90 % intervals from keypoints, network and, where known, cameras.
    """
    people = list(dict.fromkeys(frames.person))
    drawing = style.figure(ROW_MM * max(len(people), 1))
    for row, part in enumerate(drawing.subfigures(len(people), 1, squeeze=False)[:, 0]):
        grid = part.add_gridspec(2, 2, width_ratios=(1.0, 1.6))
        own = frames[frames.person == people[row]]
        measured = summary[summary.person == people[row]].set_index("measure")
        _draw_path(part.add_subplot(grid[:, 0]), own, measured, court, people[row])
        speed = part.add_subplot(grid[0, 1])
        _draw_speeds(speed, own)
        _draw_angles(part.add_subplot(grid[1, 1], sharex=speed), own)
    return drawing


def _draw_path(
    axis: Axes, own: pd.DataFrame, measured: pd.DataFrame, court: Court | None, person: str
) -> None:
    if court is not None:
        court_plan.draw(axis, court)
    x, y = (own[key].to_numpy() for key in ("neck_x_m", "neck_y_m"))
    axis.plot(x, y, color=SPEEDS["neck"], linewidth=0.9, zorder=3)
    known = np.flatnonzero(np.isfinite(x))
    for at, mark, word in (
        zip(known[[0, -1]], "os", ("start", "end"), strict=True) if known.size else ()
    ):
        axis.plot(x[at], y[at], mark, color=SPEEDS["neck"], markersize=4, zorder=4, label=word)
    found = measured.loc["neck_ground_distance"]
    cameras = 0.0 if np.isnan(found.sigma_camera) else found.sigma_camera
    reach = normal_errors.WITHIN_90 * np.hypot(found.sigma, cameras)
    length = f"{found.value:.2f} ± {reach:.2f} m on the ground (90 %)"
    if np.isnan(found.value):
        length = "distance unknown: gaps too long, or errors not known"
    axis.set_title(f"{person}: neck from above\n{length}")
    if known.size and court is not None:
        axis.set_ylim(
            min(0.0, np.min(y[known])) - ROOM_M,
            max(np.max(y[known]), court.size_m[1] / 2) + ROOM_M,
        )
    if known.size:
        axis.legend(loc="upper right", fontsize=7, frameon=True, edgecolor="none")
    axis.set(xlabel="x (m)", ylabel="y (m)")
    axis.set_aspect("equal", adjustable="box" if court else "datalim")


def _band(
    axis: Axes, own: pd.DataFrame, name: str, ends: tuple[str, str], colour: str, label: str
) -> None:
    value, sigma = (own[f"{name}_{end}"].to_numpy() for end in ends)
    reach = normal_errors.WITHIN_90 * sigma
    band = own.time_s, value - reach, value + reach
    axis.fill_between(*band, color=colour, alpha=0.2, linewidth=0)
    axis.plot(own.time_s, value, color=colour, linewidth=0.9, label=label)


def _draw_speeds(axis: Axes, own: pd.DataFrame) -> None:
    for name, colour in SPEEDS.items():
        _band(axis, own, name, ("ground_speed_m_s", "ground_speed_sd_m_s"), colour, NAMES[name])
    axis.set(ylabel="ground speed (m/s)")
    axis.set_ylim(bottom=0)
    axis.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, borderaxespad=0)
    axis.tick_params(labelbottom=False)


def _draw_angles(axis: Axes, own: pd.DataFrame) -> None:
    for name, colour in ANGLES.items():
        _band(axis, own, name, ("deg", "sd_deg"), colour, name.replace("_", " "))
    axis.set(xlabel="time (s)", ylabel="angle (degrees)")
    axis.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3, borderaxespad=0)
