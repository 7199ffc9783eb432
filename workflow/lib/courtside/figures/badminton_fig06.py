"""Where structure from motion says the walked camera went, by number of bridging images.

The counterpart of [Shishido2020, fig 6].
"""

import textwrap

import numpy as np
import pandas as pd

from courtside.figures import court_plan, style

FIXED = "static/"  # how the names of the fixed cameras' images begin
COLUMNS = 4
FAR_M = 60.0  # from the court's centre: points beyond are not drawn
ROOM_M = 2.5
TEXT_WIDTH = 26  # characters of an outcome in its panel


def table(records):
    """Return what is drawn: n_bridging, kind (fixed, bridging, tie), order, name, x_m, y_m, z_m.

    Parameters
    ----------
    records : dict of int to courtside.records.ties.Record
        By number of bridging images. Without ties there is no frame, and no rows but one with the
        outcome as name.
    """
    parts = []
    for count, record in records.items():
        if record.ties is None:
            rows = {"kind": "outcome", "order": 0, "name": [record.outcome or record.fault]}
            parts.append(pd.DataFrame({"n_bridging": count, **rows}))
            continue
        names, centres = in_order(record)
        kind = np.where(np.char.startswith(names, FIXED), "fixed", "bridging")
        parts.append(_rows(count, kind, names, centres))
        parts.append(_rows(count, "tie", "", record.xyz))
    columns = ["n_bridging", "kind", "order", "name", "x_m", "y_m", "z_m"]
    return pd.concat(parts, ignore_index=True).reindex(columns=columns)


def in_order(record):
    """Return names (V,) and places (V, 3) of registered images: bridging ones by frame, then fixed ones."""
    names = np.asarray(record.images, dtype=str)
    order = np.lexsort([names, np.char.startswith(names, FIXED)])
    return names[order], record.centres[order]


def draw(rows, court, n_images=None):
    """Draw the table of `table`, one panel for each number of bridging images, the largest first.

    Parameters
    ----------
    rows : pandas.DataFrame
    court : courtside.geometry.courts.Court
    n_images : dict of int to int, optional
        How many images there were, fixed ones included, by number of bridging images.
    """
    counts = sorted(rows["n_bridging"].unique(), reverse=True)
    n_rows = -(-len(counts) // COLUMNS)
    low, high = _limits(rows, court)
    columns = min(COLUMNS, len(counts))
    tall = (style.WIDTH_MM / columns - 8) * (high - low)[1] / (high - low)[0] + 14
    drawing = style.figure(min(220, 12 + tall * n_rows))
    axes = drawing.subplots(n_rows, columns, sharex=True, sharey=True, squeeze=False)
    for axis, count in zip(axes.flat, counts, strict=False):
        _draw_panel(axis, rows[rows["n_bridging"] == count], court, (n_images or {}).get(count))
        axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    for axis in axes.flat[len(counts) :]:
        axis.set_visible(False)
    drawing.supxlabel("x (m)", fontsize=8)
    drawing.supylabel("y (m)", fontsize=8)
    handles, labels = _legend(axes.flat[0])
    drawing.legend(handles, labels, loc="outside lower center", ncols=3)
    return drawing


def _rows(count, kind, names, xyz):
    columns = {"n_bridging": count, "kind": kind, "order": np.arange(len(xyz)), "name": names}
    return pd.DataFrame({**columns, "x_m": xyz[:, 0], "y_m": xyz[:, 1], "z_m": xyz[:, 2]})


def _limits(rows, court):
    cameras = rows.loc[rows["kind"].isin(["fixed", "bridging"]), ["x_m", "y_m"]].to_numpy()
    middle = np.asarray(court.size_m) / 2
    cameras = cameras[np.linalg.norm(cameras - middle, axis=1) < FAR_M]
    every = np.concatenate([cameras, [[0, 0]], [court.size_m]])
    return every.min(axis=0) - ROOM_M, every.max(axis=0) + ROOM_M


def _draw_panel(axis, rows, court, n_images):
    court_plan.draw(axis, court)
    count = rows["n_bridging"].iloc[0]
    outcome = rows.loc[rows["kind"] == "outcome", "name"]
    if len(outcome):
        text = textwrap.fill(outcome.iloc[0], TEXT_WIDTH, max_lines=11)
        look = {
            "ha": "center",
            "va": "center",
            "fontsize": 6,
            "transform": axis.transAxes,
            "zorder": 6,
        }
        axis.text(0.5, 0.5, text, bbox={"facecolor": "white", "edgecolor": "#999999"}, **look)
        axis.set_title(f"N = {count}: no result")
        return
    of = {kind: part for kind, part in rows.groupby("kind")}
    ties = of.get("tie", rows[:0])
    look = {"color": "#888888", "markersize": 0.8, "linewidth": 0, "zorder": 2, "rasterized": True}
    axis.plot(ties["x_m"], ties["y_m"], ".", **look)
    path = of.get("bridging", rows[:0])
    axis.plot(
        path["x_m"], path["y_m"], ".-", color=style.LEFT, markersize=3, linewidth=0.8, zorder=3
    )
    fixed = of.get("fixed", rows[:0])
    axis.plot(fixed["x_m"], fixed["y_m"], "s", color=style.RIGHT, markersize=4, zorder=4)
    found = len(path) + len(fixed)
    axis.set_title(f"N = {count}: {found}{f' of {n_images}' if n_images else ''} images")


def _legend(axis):
    looks = [
        (".-", style.LEFT, "bridging images, in order of filming"),
        ("s", style.RIGHT, "fixed cameras"),
        (".", "#888888", "points that tie the images"),
    ]
    handles = [axis.plot([], [], form, color=colour, markersize=4)[0] for form, colour, _ in looks]
    return handles, [words for *_, words in looks]
