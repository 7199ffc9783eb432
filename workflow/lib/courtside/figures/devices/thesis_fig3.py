"""Figures 3.1 and 3.2 of the thesis: the wrists seen along the trunk, from T-pose to clap.

With the circle that the thesis expects, of radius 1 about the origin, and the arcs that straight
arms can follow: about the subject's own shoulders.
"""

from collections.abc import Iterable

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from courtside.figures.style import source_styles, style

CIRCLE, ARC, TRUE = "#bbbbbb", "#444444", "black"
MM = 1000
NO_ARCS = "no T-pose with a clap after it"
N_COLUMNS = 3
BEYOND = np.radians(12)  # arcs are drawn on by that
LEAST = ((-1.2, 1.2), (-0.3, 1.15))  # of x and z that are shown
ROOM = 0.06
BESIDE = ["shoulder_x", "shoulder_z", "radius", "mean_distance", "p95_distance", "mean_off_circle"]


def table(
    paths: pd.DataFrame, distortion: pd.DataFrame, sources: list[str] | None = None
) -> pd.DataFrame:
    """Return the numbers drawn: each point of the paths with its arc and its wrist's distortion.

    `paths` and `distortion` are of `courtside.kinematics.wrist_arcs`, with `source`; distortion
    also with `unit_m`. All sources by default.
    """
    rows = paths.merge(distortion[["source", "side", *BESIDE]], on=["source", "side"], how="left")
    return rows if sources is None else rows[rows["source"].isin(sources)].reset_index(drop=True)


def draw(
    paths: pd.DataFrame,
    distortion: pd.DataFrame,
    source: str,
    *,
    kinds: dict[str, str] | None = None,
    truth: pd.DataFrame | None = None,
) -> Figure:
    """Draw one source of `table`, the thesis's figure; `kinds` as for `source_styles.kind_of`.

    `truth` are the true wrists in the form of `paths`; its `source` is the one they are compared
    with.
    """
    drawing = style.figure(118)
    axis = drawing.subplots()
    look = source_styles.looks([source], kinds)[source]
    own, off, true = (_of(rows, source) for rows in (paths, distortion, truth))
    _panel(axis, own, off, look, true)
    _names(axis, own)
    axis.set(**_limits([own, true]), ylabel="z, forwards (units)")
    axis.set_xlabel("x, from the right hand to the left (units; 1 is half the wrist span)")
    axis.set_title(f"{source}: {_title(own, off)}")
    _legend(drawing, _marks(look.colour, true))
    return drawing


def draw_all(
    paths: pd.DataFrame,
    distortion: pd.DataFrame,
    *,
    kinds: dict[str, str] | None = None,
    truth: pd.DataFrame | None = None,
) -> Figure:
    """Draw all sources side by side, on equal axes; parameters as for `draw`."""
    looks = source_styles.looks(distortion["source"], kinds)
    n_rows = -(-len(looks) // N_COLUMNS)
    drawing = style.figure(24 + 49 * n_rows)
    share = {"sharex": True, "sharey": True, "squeeze": False}
    axes = drawing.subplots(n_rows, min(N_COLUMNS, len(looks)), **share)
    for axis, (source, look) in zip(axes.ravel(), looks.items(), strict=False):
        own, off = _of(paths, source), _of(distortion, source)
        _panel(axis, own, off, look, _of(truth, source))
        axis.set_title(f"{source}\n{_short(off)}")
        axis.set(**_limits([paths, truth]))
    for axis in axes.ravel()[len(looks) :]:
        axis.set_axis_off()
    for axis in axes[:, 0]:
        axis.set_ylabel("z, forwards (units)")
    shown = axes.ravel()[: len(looks)]
    for axis in shown[-axes.shape[1] :]:
        axis.tick_params(labelbottom=True)
        axis.set_xlabel("x, to the left hand (units)")
    marks = _marks(style.MIDDLE, truth if truth is not None else paths.iloc[:0])
    _legend(drawing, marks)
    return drawing


def _legend(drawing: Figure, marks: list[Line2D]) -> None:
    """Write marks below the figure in two rows; as four columns, six of them are too wide."""
    drawing.legend(handles=marks, loc="outside lower center", ncols=-(-len(marks) // 2))


def _of(rows: pd.DataFrame | None, source: str) -> pd.DataFrame | None:
    return None if rows is None else rows[rows["source"] == source]


def _panel(
    axis: Axes,
    own: pd.DataFrame,
    off: pd.DataFrame,
    look: source_styles.Look,
    true: pd.DataFrame | None,
) -> None:
    turn = np.linspace(-BEYOND, np.pi + BEYOND, 181)
    axis.plot(np.cos(turn), np.sin(turn), color=CIRCLE, linewidth=1.2, zorder=1)
    axis.axhline(0, color="#e5e5e5", linewidth=0.6, zorder=0)
    axis.plot(0, 0, "+", color=CIRCLE, markersize=7, zorder=1)
    for row in off.itertuples():
        axis.plot(*_arc(row), "--", color=ARC, linewidth=0.9, zorder=2)
        axis.plot(row.shoulder_x, row.shoulder_z, "^", color=ARC, markersize=5, zorder=2)
    if true is not None:
        for _, path in true.groupby("side"):
            axis.plot(path["x"], path["z"], color=TRUE, linewidth=0.8, zorder=3)
    for _, path in own.groupby("side"):
        axis.plot(path["x"], path["z"], color=look.colour, linewidth=0.9, zorder=4)
        axis.plot(path["x"], path["z"], ".", color=look.colour, markersize=3, zorder=4)
        # Nothing where the wrist is not known at that time: the path then ends without a mark.
        for end, mark in ((path.head(1), "s"), (path.tail(1), "o")):
            axis.plot(end["x"], end["z"], mark, color=look.colour, mfc="white", ms=6, zorder=5)
    axis.set_aspect("equal")


def _arc(row):
    """Return x and z of a wrist's own arc, from beside the body to slightly beyond the middle."""
    aside = np.clip(-abs(row.shoulder_x) / row.radius, -1, 1)
    turn = np.linspace(-BEYOND, np.arccos(aside) + BEYOND, 91)
    outwards = 1 if row.side == "left" else -1
    x = row.shoulder_x + outwards * row.radius * np.cos(turn)
    return x, row.shoulder_z + row.radius * np.sin(turn)


def _names(axis: Axes, own: pd.DataFrame) -> None:
    for side, path in own.groupby("side"):
        start = path[np.isfinite(path["x"])].head(1)
        for x, z in start[["x", "z"]].to_numpy():
            inwards, ha = (8, "left") if x < 0 else (-8, "right")
            place = {"xytext": (inwards, 0), "textcoords": "offset points"}
            axis.annotate(f"{side} wrist", (x, z), ha=ha, va="center", fontsize=7, **place)


def _limits(tables: Iterable[pd.DataFrame | None]) -> dict[str, tuple[float, float]]:
    known = [rows[["x", "z"]].to_numpy(dtype=float) for rows in tables if rows is not None]
    every = np.concatenate([*known, np.transpose(LEAST)])
    low, high = np.nanmin(every, axis=0) - ROOM, np.nanmax(every, axis=0) + ROOM
    return {"xlim": (low[0], high[0]), "ylim": (low[1], high[1])}


def _title(own: pd.DataFrame, off: pd.DataFrame) -> str:
    if own.empty:
        return NO_ARCS
    time_s = own["time_s"]
    mm = MM * off["mean_distance"] * off["unit_m"]
    pairs = zip(off["side"], off["mean_distance"], mm, strict=True)
    arcs = ", ".join(f"{side} {units:.3f} ({mm:.0f} mm)" for side, units, mm in pairs)
    return (
        f"{time_s.nunique()} frames in {time_s.max() - time_s.min():.2f} s from T-pose to clap\n"
        f"mean distance to the own arc: {arcs}; to the circle: {off['mean_off_circle'].mean():.3f}"
    )


def _short(off: pd.DataFrame) -> str:
    if not off["n"].any():
        return NO_ARCS
    arcs, circle = off["mean_distance"].mean(), off["mean_off_circle"].mean()
    return f"off own arcs {arcs:.3f}, off circle {circle:.3f}"


def _marks(colour: str, true: pd.DataFrame | None) -> list[Line2D]:
    hollow = {"color": colour, "linestyle": "none", "mfc": "white", "ms": 6}
    looks: dict[str, dict] = {
        "wrist, every frame": {"color": colour, "marker": ".", "lw": 0.9, "ms": 4},
        "end of the T-pose": {"marker": "s", **hollow},
        "clap": {"marker": "o", **hollow},
        "shoulder in the T-pose": {"color": ARC, "marker": "^", "linestyle": "none", "ms": 5},
        "own arc, about the shoulder": {"color": ARC, "linestyle": "--", "lw": 0.9},
        "circle of radius 1 about the origin": {"color": CIRCLE, "lw": 1.2},
    }
    if true is not None and len(true):
        looks["truth"] = {"color": TRUE, "lw": 0.8}
    return [Line2D([], [], label=label, **look) for label, look in looks.items()]
