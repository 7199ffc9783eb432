"""Positions of the walked camera by structure from motion, by number of bridging images.

The counterpart of [Shishido2020, fig 6].
"""

import textwrap

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.calibration.records.tie_points import Record
from courtside.figures.style import court_plan, style
from courtside.records.cameras import image_names

COLUMNS = 4
FAR_M = 60.0  # from the court's centre: what lies beyond does not widen the panels
SHOWN = 3  # percentile of the points that tie: the panels reach from there to its counterpart
ROOM_M = 1.5
LARGEST_MM = 75  # width of a panel
LOOKS: dict[str, tuple[str, dict]] = {  # kind of point: words, look
    "bridging": (
        "bridging images, in order of filming",
        {"marker": ".", "linewidth": 0.8, "color": style.LEFT, "markersize": 2.5, "zorder": 3},
    ),
    "fixed": (
        "fixed cameras",
        {"marker": "s", "linewidth": 0, "color": style.RIGHT, "markersize": 4, "zorder": 4},
    ),
    "tie": (
        "points that tie the images",
        {"marker": "o", "linewidth": 0, "color": "#999999", "markersize": 1.2, "zorder": 0}
        | {"markeredgewidth": 0, "rasterized": True},
    ),
}
TEXT_WIDTH = 26  # characters of an outcome in its panel


def table(records: dict[int, Record]) -> pd.DataFrame:
    """Return the positions drawn: of fixed cameras, bridging images and ties.

    `records` are by number of bridging images. A record without ties has no frame: its single row
    has the outcome as its name.
    """
    parts = []
    for count, record in records.items():
        if record.ties is None:
            rows = {"kind": "outcome", "order": 0, "name": [record.outcome or record.fault]}
            parts.append(pd.DataFrame({"n_bridging": count, **rows}))
            continue
        names = np.asarray(record.images, dtype=str)
        order = np.lexsort([names, image_names.are_static(names)])  # bridging by frame, then fixed
        names, centres = names[order], record.centres[order]
        kind = np.where(image_names.are_static(names), "fixed", "bridging")
        parts.append(_rows(count, kind, names, centres))
        parts.append(_rows(count, "tie", "", record.xyz))
    columns = ["n_bridging", "kind", "order", "name", "x_m", "y_m", "z_m"]
    return pd.concat(parts, ignore_index=True).reindex(columns=columns)


def draw(
    rows: pd.DataFrame, court: Court, n_images: dict[int, int] | None = None, mapper: str = ""
) -> Figure:
    """Draw the table of `table`, one panel for each number of bridging images, the largest first.

    `n_images` are the images, fixed ones included, by number of bridging images; `mapper` is the
    one of structure from motion.
    """
    counts = sorted(rows["n_bridging"].unique(), reverse=True)
    columns = min(COLUMNS, len(counts))
    n_rows = -(-len(counts) // columns)
    low, high = _limits(rows, court)
    width = min(style.WIDTH_MM / columns - 10, LARGEST_MM)
    drawing = style.figure(min(225, 22 + n_rows * (8 + width * (high - low)[1] / (high - low)[0])))
    axes = drawing.subplots(n_rows, columns, sharex=True, sharey=True, squeeze=False)
    for axis, count in zip(axes.flat, counts, strict=False):
        _draw_panel(axis, rows[rows["n_bridging"] == count], court, (n_images or {}).get(count))
        axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="x (m)", ylabel="y (m)")
        axis.label_outer()
    for axis in axes.flat[len(counts) :]:
        axis.set_visible(False)
    for axis in axes.flat[len(counts) - columns : len(counts)]:
        axis.xaxis.set_tick_params(labelbottom=True)
        axis.set_xlabel("x (m)")
    marks = [
        Line2D([], [], label=words, **{**look, "markersize": 4}) for words, look in LOOKS.values()
    ]
    drawing.legend(handles=marks, loc="outside lower center", ncols=3)
    if mapper:
        drawing.suptitle(f"{mapper} mapper")
    return drawing


def _rows(count: int, kind: str | NDArray, names: str | NDArray, xyz: NDArray) -> pd.DataFrame:
    columns = {"n_bridging": count, "kind": kind, "order": np.arange(len(xyz)), "name": names}
    return pd.DataFrame({**columns, "x_m": xyz[:, 0], "y_m": xyz[:, 1], "z_m": xyz[:, 2]})


def _limits(rows: pd.DataFrame, court: Court) -> tuple[NDArray, NDArray]:
    xy = rows[["x_m", "y_m"]].to_numpy()
    near = np.linalg.norm(xy - np.asarray(court.size_m) / 2, axis=1) < FAR_M
    ties = near & (rows["kind"] == "tie")
    every = np.concatenate([xy[near & ~ties], [[0, 0]], [court.size_m]])
    if ties.any():
        every = np.concatenate([every, np.percentile(xy[ties], [SHOWN, 100 - SHOWN], axis=0)])
    return every.min(axis=0) - ROOM_M, every.max(axis=0) + ROOM_M


def _draw_panel(axis: Axes, rows: pd.DataFrame, court: Court, n_images: int | None) -> None:
    court_plan.draw(axis, court, colour="black", least_pt=0.4)
    count = rows["n_bridging"].iloc[0]
    outcome = rows.loc[rows["kind"] == "outcome", "name"]
    if len(outcome):
        text = textwrap.fill(outcome.iloc[0], TEXT_WIDTH, max_lines=11)
        look = {"ha": "center", "va": "center", "fontsize": 6, "zorder": 6}
        look["transform"] = axis.transAxes
        axis.text(0.5, 0.5, text, bbox={"facecolor": "white", "edgecolor": "#999999"}, **look)
        axis.set_title(f"N = {count}: no result")
        return
    for kind, (_, look) in LOOKS.items():
        part = rows[rows["kind"] == kind]
        axis.plot(part["x_m"], part["y_m"], **look)
    found = (rows["kind"] != "tie").sum()
    axis.set_title(f"N = {count}: {found}{f' of {n_images}' if n_images else ''} images")
