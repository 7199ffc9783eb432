"""Expected 3D error of a calibration over the court, from its covariance."""

from collections.abc import Sequence
from itertools import product

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from courtside.calibration.court import quality
from courtside.calibration.court.court import Court
from courtside.calibration.records.covariance import CameraCovariance
from courtside.figures.style import court_plan, style
from courtside.geometry.camera import Camera

COLUMNS, ROWS = 25, 55  # of the grid, along the short and the long side
LEVELS = 14  # of colour, about
PANELS = {"before_cm": "before: ", "sigma_cm": "after: "}
ROOM_M = 3.2  # around the court, for the cameras
LEAST_M = 1e-6  # from the court's centre: a camera nearer than this is above it


def table(
    cameras: list[Camera], covariance: CameraCovariance, court: Court, heights_m: Sequence[float]
) -> pd.DataFrame:
    """Return the expected error over the court; `covariance` contains that of the cameras.

    The error is the root of the trace of a point's covariance from the cameras that show the point,
    NaN where fewer than two do.
    `ValueError` if the covariance is of other cameras.
    """
    xyz = quality.volume(court, heights_m, COLUMNS, ROWS)
    spread = quality.place_covariance(cameras, covariance, xyz)
    sigma = 100 * np.sqrt(np.trace(spread, axis1=1, axis2=2))
    return pd.DataFrame({"x_m": xyz[:, 0], "y_m": xyz[:, 1], "z_m": xyz[:, 2], "sigma_cm": sigma})


def compared(rows: pd.DataFrame, before: pd.DataFrame) -> pd.DataFrame:
    """Return the table of refined cameras with `before_cm`, that of the cameras before."""
    return rows.assign(before_cm=before["sigma_cm"])


def draw(rows: pd.DataFrame, cameras: list[Camera], court: Court, title: str) -> Figure:
    """Draw the table of `table`: one panel per height, one scale of colours.

    With `before_cm` a row of panels above has the error before cameras were refined.
    """
    heights = rows["z_m"].unique()
    columns = [name for name in PANELS if name in rows]
    wide, tall = np.asarray(court.size_m) + 2 * ROOM_M
    each_mm = (style.WIDTH_MM - 30) / len(heights) * tall / wide
    drawing = style.figure(min(160 if len(columns) == 1 else 230, 18 + len(columns) * each_mm))
    axes = drawing.subplots(len(columns), len(heights), sharex=True, sharey=True, squeeze=False)
    levels = _levels(rows[columns].to_numpy())
    for (name, panels), height in product(zip(columns, axes, strict=True), enumerate(heights)):
        axis, part = panels[height[0]], rows[rows["z_m"] == height[1]]
        filled = _draw_height(axis, part, part[name], levels)
        court_plan.draw(axis, court)
        for camera in cameras:
            _point_to(axis, camera, court)
        word = PANELS[name] if len(columns) > 1 else ""
        axis.set_title(f"{word}z = {height[1]:g} m: median {part[name].median():.2f} cm")
        axis.set(xlim=(-ROOM_M, wide - ROOM_M), ylim=(-ROOM_M, tall - ROOM_M))
        axis.set(xlabel="x (m)", ylabel="y (m)")
        axis.label_outer()
        for each in (axis.xaxis, axis.yaxis):
            each.set_major_locator(MaxNLocator(4, integer=True, steps=[1, 2, 5, 10]))
    bar = drawing.colorbar(filled, ax=list(axes.flat), pad=0.01, aspect=30, ticks=levels[::2])
    bar.set_label("expected 3D error (cm)")
    drawing.suptitle(title, fontsize=8)
    return drawing


def _levels(sigma_cm: NDArray) -> NDArray:
    known = sigma_cm[np.isfinite(sigma_cm)]
    low, high = (known.min(), known.max()) if len(known) else (0.0, 1.0)
    return MaxNLocator(LEVELS).tick_values(low, max(high, low + 1e-3))


def _draw_height(
    axis: Axes, part: pd.DataFrame, sigma_cm: pd.Series, levels: NDArray
) -> ContourSet:
    x, y = (part[name].unique() for name in ("x_m", "y_m"))
    values = sigma_cm.to_numpy().reshape(len(y), len(x))
    filled = axis.contourf(x, y, values, levels=levels, cmap="YlGnBu", zorder=0)
    if np.isfinite(values).any() and np.nanmax(values) > np.nanmin(values):
        lines = axis.contour(
            x, y, values, levels=levels[::2], colors="black", linewidths=0.5, zorder=2
        )
        for text in axis.clabel(lines, fontsize=6.5):
            text.set_path_effects([withStroke(linewidth=1.8, foreground="white")])
    return filled


def _point_to(axis: Axes, camera: Camera, court: Court) -> None:
    """Mark at the court's edge the direction of a camera, which stands far outside.

    Above the court's centre it has no direction, and is named there.
    """
    centre = np.asarray(court.size_m) / 2
    away = camera.centre_in_world[:2] - centre
    distance = np.linalg.norm(away)
    text = f"{camera.name}\n{distance:.0f} m"
    look: dict = {"ha": "center", "va": "center", "fontsize": 6.5}
    if distance < LEAST_M:
        axis.text(*centre, text, **look)
        return
    outward = away / distance
    reach = np.min((centre + 0.3) / np.maximum(np.abs(outward), 1e-9))
    tip = centre + reach * outward
    arrow = {"arrowstyle": "-|>", "color": "black", "linewidth": 1.2, "shrinkA": 0, "shrinkB": 0}
    axis.annotate("", tip, tip + 1.1 * outward, arrowprops=arrow, zorder=5)
    axis.text(*(tip + 2.0 * outward), text, **look)
