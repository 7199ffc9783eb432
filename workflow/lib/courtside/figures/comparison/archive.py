"""The measures of one subject over sessions, with the smallest detectable change."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.figures.style import bars, style

N_COLUMNS = 3
LEVEL = 3  # names of more sessions are written aslant
BAND = "#dddddd"
LOOKS = {  # verdict: colour, marker, filled, words
    "first": ("black", "o", True, "first session"),
    "within": ("#666666", "o", True, "within the smallest detectable change"),
    "real": ("#D55E00", "o", True, "real change"),
    "untold": ("#666666", "o", False, "untold: no repeats, or all equal"),
    "mixed": ("#CC79A7", "D", False, "measured in another way: not to be compared"),
}
BESIDE = ["change", "detectable", "freedom", "verdict", "mixed"]


def table(values: pd.DataFrame, changes: pd.DataFrame) -> pd.DataFrame:
    """Put changes beside values, both of `courtside.statistics.longitudinal`.

    The first value of a measure has the verdict `first` and no change.
    """
    beside = pd.DataFrame(index=values.index, columns=BESIDE, dtype=object)
    for measure, part in values.groupby("measure", sort=False):
        own = changes.loc[changes["measure"] == measure, BESIDE]
        beside.loc[part.index[1:]] = own.to_numpy(dtype=object)
        beside.loc[part.index[0], ["verdict", "mixed"]] = "first", ""
    numbers = beside[["change", "detectable"]].astype(float)
    freedom = pd.to_numeric(beside["freedom"]).astype("Int64")
    beside = beside.assign(**numbers, freedom=freedom)
    return pd.concat([values, beside], axis=1)


def draw(rows: pd.DataFrame, subject: str) -> Figure:
    """Draw every measure of `table` in its own panel, sessions from left to right."""
    measures = list(dict.fromkeys(rows["measure"]))
    n_rows = -(-len(measures) // N_COLUMNS)
    drawing = style.figure(24 + 44 * n_rows)
    axes = drawing.subplots(n_rows, N_COLUMNS, squeeze=False).ravel()
    sessions = rows[["order", "session"]].drop_duplicates().sort_values("order")
    for axis, measure in zip(axes, measures, strict=False):
        part = rows[rows["measure"] == measure]
        _panel(axis, part)
        axis.set_title(f"{measure.replace('_', ' ')} ({part['unit'].iloc[0] or '1'})")
        axis.set_xticks(sessions["order"], sessions["session"], fontsize=6.5)
        axis.tick_params(axis="x", rotation=25 if len(sessions) > LEVEL else 0)
        axis.set_xlim(sessions["order"].min() - 0.4, sessions["order"].max() + 0.4)
    for axis in axes[len(measures) :]:
        axis.set_axis_off()
    marks = [
        bars.mark(colour, marker=marker, filled=filled, label=words)
        for verdict, (colour, marker, filled, words) in LOOKS.items()
        if (rows["verdict"] == verdict).any()
    ]
    drawing.legend(handles=marks, loc="outside lower center", ncols=3)
    drawing.suptitle(f"subject {subject}", fontsize=8)
    return drawing


def _panel(axis: Axes, part: pd.DataFrame) -> None:
    first, later = part.iloc[0], part.iloc[1:]
    banded = later[np.isfinite(later["detectable"]) & (later["verdict"] != "mixed")]
    for _, row in banded.iterrows():
        at = [row["order"] - 0.35, row["order"] + 0.35]
        low, high = first["value"] - row["detectable"], first["value"] + row["detectable"]
        axis.fill_between(at, low, high, color=BAND, linewidth=0, zorder=0)
    axis.axhline(first["value"], color="#999999", linewidth=0.6, zorder=0.5)
    for verdict, (colour, marker, filled, _) in LOOKS.items():
        own = part[part["verdict"] == verdict]
        look = {"fmt": marker, "color": colour, "markersize": 4.5, "linewidth": 0.8}
        look["markerfacecolor"] = colour if filled else "white"
        axis.errorbar(own["order"], own["value"], yerr=own["sd_takes"], **look)
