"""Smoothness of the wrists against accuracy, source by source: the thesis's finding as numbers."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from courtside.figures.style import bars, source_styles, style
from courtside.records import tables
from courtside.study.errors import StrPath

TAKE = ["session", "take"]
ALIGNMENT = "body_frame"
SINGLE_REACH = -1.41  # SPARC of one minimum-jerk reach (Balasubramanian et al. 2012)
TRUE = "black"
MM = 1000
PANELS = {
    "median_error_mm": "median error of all joints against the truth (mm)",
    "distortion_mm": "mean distance of the wrists to their own arcs (mm)",
}


def table(
    distortion: pd.DataFrame, errors: pd.DataFrame | None = None, truth: pd.DataFrame | None = None
) -> pd.DataFrame:
    """Put smoothness beside accuracy, one row for each take and source.

    `distortion` is of `courtside.kinematics.wrist_arcs`, with session, take, source, unit_m and
    sparc; `errors` are of `courtside.evaluation.sources`, with session, take and source, of the
    takes with a truth; `truth` has the form of `distortion`, of the true wrists: source is the one
    that they are compared with.
    """
    key = [*TAKE, "source"]
    mm = MM * distortion["mean_distance"] * distortion["unit_m"]
    groups = distortion.assign(distortion_mm=mm).groupby(key, sort=False)
    rows = groups["sparc"].agg(sparc="mean", sparc_low="min", sparc_high="max")
    rows = rows.assign(distortion_mm=groups["distortion_mm"].mean()).reset_index()
    if errors is None:
        rows = rows.assign(median_error_mm=np.nan)
    else:
        whole = errors[(errors["alignment"] == ALIGNMENT) & (errors["joint"] == "all")]
        beside = whole[[*key, "median_mm"]].rename(columns={"median_mm": "median_error_mm"})
        rows = rows.merge(beside, on=key, how="left")
    if truth is None:
        return rows.assign(sparc_true=np.nan)
    true = truth.groupby(key)["sparc"].mean().rename("sparc_true").reset_index()
    return rows.merge(true, on=key, how="left")


def read(
    distortion_csv: Sequence[StrPath],
    labels: Sequence[dict[str, str]],
    errors_csv: Sequence[StrPath] = (),
    truth_csv: Sequence[StrPath] = (),
) -> pd.DataFrame:
    """Read the tables of several takes into one of `table`.

    `labels` are session and take of each take; the other files have both as columns.
    """
    pairs = zip(distortion_csv, labels, strict=True)
    distortion = pd.concat(
        [tables.read(path, "a table of distortion").assign(**label) for path, label in pairs]
    )
    return table(distortion, _read(errors_csv), _read(truth_csv))


def _read(paths: Sequence[StrPath]) -> pd.DataFrame | None:
    found = [tables.read(path, "a table of errors") for path in paths]
    return pd.concat(found, ignore_index=True) if found else None


def draw(rows: pd.DataFrame, *, kinds: dict[str, str] | None = None) -> Figure:
    """Draw smoothness over the error (with a truth) and over the distortion (with a clap).

    `rows` are of `table`, `kinds` as for `courtside.figures.style.source_styles.kind_of`.
    """
    shown = [name for name in PANELS if rows[name].notna().any()] or list(PANELS)[1:]
    looks = source_styles.looks(rows["source"], kinds)
    drawing = style.figure(95)
    axes = drawing.subplots(1, len(shown), sharey=True, squeeze=False)[0]
    for axis, name in zip(axes, shown, strict=True):
        axis.axhline(SINGLE_REACH, color="#bbbbbb", linewidth=0.8, zorder=0)
        for source, look in looks.items():
            own = rows[rows["source"] == source].dropna(subset=[name])
            axis.vlines(own[name], own["sparc_low"], own["sparc_high"], color=look.colour, lw=0.8)
            axis.plot(own[name], own["sparc"], look.marker, color=look.colour, markersize=5)
            axis.plot(own[name], own["sparc_true"], "_", color=TRUE, markersize=9, mew=1.2)
        axis.set_xlim(left=0)
        axis.set_xlabel(PANELS[name])
    axes[0].set_ylabel("SPARC of the wrists' speed\n(nearer to 0 is smoother)")
    arrow = {"arrowstyle": "->", "color": "#aaaaaa", "linewidth": 0.8}
    text = {"xycoords": "axes fraction", "fontsize": 7, "color": "#777777"}
    axes[0].annotate(
        "smooth and accurate", (0.01, 0.99), xytext=(0.09, 0.9), arrowprops=arrow, **text
    )
    marks = source_styles.marks(looks)
    marks.append(bars.mark("#bbbbbb", marker="", line="-", label="one minimum-jerk reach"))
    if rows["sparc_true"].notna().any():
        marks.append(bars.mark(TRUE, marker="_", label="the true wrists, same time"))
    drawing.legend(handles=marks, loc="outside lower center", ncols=4)
    return drawing
