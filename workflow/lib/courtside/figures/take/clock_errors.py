"""Errors of the cameras' clocks against the truth, in ms and in mm at a fast wrist."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.figures.style import bars, style
from courtside.records.devices.clocks import WRIST_M_S
from courtside.statistics import normal_errors

LIMIT_MS = 8.0  # a quarter of a frame at 30 frames per second: 10 cm at such a wrist
FURTHEST_MS = 40.0  # larger errors are marked at the edge, with their number
COLOURS = {"yes": style.CYCLE[0], "no": style.CYCLE[1], "unused": "#888888"}
WORDS = {
    "yes": "90 % interval holds the truth",
    "no": "does not",
    "unused": "not used: the recording does not determine it",
}
LABELS = ["session", "take", "camera", "calibration", "model"]


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Add intervals, and whether they hold the truth, to the tables of `evaluate_clocks`.

    Rows are ordered by label; `holds` is unused for a clock whose status is not `found`.
    """
    rows = rows.sort_values(LABELS, kind="stable").reset_index(drop=True)
    reach = normal_errors.WITHIN_90 * rows["sigma_ms"]
    inside = np.where(rows["worst_error_ms"].abs() <= reach, "yes", "no")
    return rows.assign(
        lower_ms=rows["worst_error_ms"] - reach,
        upper_ms=rows["worst_error_ms"] + reach,
        worst_error_mm=rows["worst_error_ms"] * WRIST_M_S,
        holds=np.where(rows["status"] == "found", inside, "unused"),
    )


def draw(rows: pd.DataFrame) -> Figure:
    """Draw the errors of `table`, one line per camera of a take."""
    drawing = style.figure(40 + 3.8 * len(rows))
    axis = drawing.subplots()
    known = rows.loc[rows["holds"] != "unused", ["lower_ms", "upper_ms"]].abs().to_numpy()
    furthest = known[np.isfinite(known)].max(initial=0.0)
    edge = float(np.clip(1.1 * furthest, 1.5 * LIMIT_MS, FURTHEST_MS))
    axis.axvspan(-LIMIT_MS, LIMIT_MS, color="#eeeeee", linewidth=0, zorder=0)
    axis.axvline(0, color="#999999", linewidth=0.6)
    for holds, colour in COLOURS.items():
        part = rows[rows["holds"] == holds]
        inside = part[part["worst_error_ms"].abs() <= edge]
        axis.hlines(inside.index, inside["lower_ms"], inside["upper_ms"], color=colour)
        face = "white" if holds == "unused" else colour
        axis.plot(inside["worst_error_ms"], inside.index, "o", color=colour, mfc=face, markersize=4)
        for at, row in part.drop(inside.index).iterrows():
            _beyond(axis, at, row["worst_error_ms"], edge, colour)
    axis.set_xlim(-1.02 * edge, 1.02 * edge)
    axis.set_ylim(len(rows) - 0.4, -0.6)
    axis.set_yticks(np.arange(len(rows)), _names(rows), fontsize=6.5)
    axis.set_xlabel("clock less truth, where in the take it is largest (ms)")
    above = axis.secondary_xaxis(
        "top", functions=(lambda ms: WRIST_M_S * ms, lambda mm: mm / WRIST_M_S)
    )
    above.set_xlabel(f"way of a wrist at {WRIST_M_S:g} m/s in that time (mm)")
    drawing.suptitle(_title(rows), fontsize=8)
    there = [holds for holds in COLOURS if (rows["holds"] == holds).any()]
    marks = [bars.mark(COLOURS[h], filled=h != "unused", line="-", label=WORDS[h]) for h in there]
    drawing.legend(handles=marks, loc="outside lower center", ncols=3)
    return drawing


def _beyond(axis: Axes, at: float, error_ms: float, edge: float, colour: str) -> None:
    if not np.isfinite(error_ms):
        return
    side, marker, where = (1, ">", "right") if error_ms > 0 else (-1, "<", "left")
    face = "white" if colour == COLOURS["unused"] else colour
    axis.plot(side * edge, at, marker, color=colour, mfc=face, markersize=4)
    text = f"{error_ms:.0f} ms".replace("-", "\N{MINUS SIGN}")
    look = {"textcoords": "offset points", "va": "center", "fontsize": 6.5, "color": colour}
    axis.annotate(text, (side * edge, at), (-5 * side, 0), ha=where, **look)


def _names(rows: pd.DataFrame) -> list[str]:
    shown = ["session", "take", "camera"]
    shown += [name for name in ("calibration", "model") if rows[name].nunique() > 1]
    return rows[shown].agg(" ".join, axis=1).tolist()


def _title(rows: pd.DataFrame) -> str:
    used = rows[rows["holds"] != "unused"]
    left = len(rows) - len(used)
    if used.empty:
        return f"none of {len(rows)} clocks is determined by its recording"
    held, worst = (used["holds"] == "yes").sum(), used["worst_error_ms"].abs().max()
    close = (used["worst_error_ms"].abs() <= LIMIT_MS).sum()
    title = (
        f"{held} of {len(used)} intervals of 90 % hold the truth ({100 * held / len(used):.0f} %); "
    )
    title += f"largest error {worst:.1f} ms; {close} of {len(used)} within {LIMIT_MS:g} ms (shaded)"
    return title + (f"; {left} not determined" if left else "")
