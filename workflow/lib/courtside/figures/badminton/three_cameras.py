"""Errors of joints with two, three and four cameras, by the paper's half-body rule and by ours."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator
from numpy.typing import NDArray

from courtside.evaluation.tables import players
from courtside.figures.style import bars, style
from courtside.records.keypoints import skeleton

BLOCK = ["session", "take", "calibration", "model"]  # what has panels of its own
SETS = {"limbs": "12 limb joints", "right half": "right half", "left half": "left half"}
JOINTS = (*skeleton.JOINTS[6:], *skeleton.JOINTS[:6])  # the half that the paper speaks of first
POINTS = {"neck": "neck", "centre": "centre of gravity"}
ROWS = (*SETS, *JOINTS, *POINTS)
NOTHING_MM = 1.0, 1000.0  # limits of the axis when nobody was placed
# What the paper calls stable, or fairly so, with the two cameras that see the right half.
CLAIMED = ("right half", *(joint for joint in JOINTS if joint.startswith("right_")), *POINTS)
PANELS = {"pose3d": "as triangulated (raw)", "pose3d_corrected": "filtered, joint offsets removed"}
NO_OFFSETS = "no estimate of\njoint offsets"
WAYS = {  # fusion: words, colour, mark, filled
    "two-dlt": ("plain, as in the paper", "#777777", "o", False),
    "two-robust": ("fused with weights", "#777777", "o", True),
    "halfbody": ("the paper's half-body rule", "#D55E00", "s", True),
    "three-robust": ("fused with weights", "#56B4E9", "^", True),
    "all-robust": ("fused with weights, all of the session", "#0072B2", "D", True),
}
SPREAD = 0.72  # of the distance between rows that the marks of one row share
BAND = "#f0f0f0"
MM_PER_ROW = 5.8
LEGEND_MM = 3.5  # a line
POINT_COLUMNS = {"point": "joint", "position_median_mm": "median_mm", "position_p95_mm": "p95_mm"}
NUMBERS = ["n", "missing_percent", "median_mm", "p95_mm"]


def table(errors: pd.DataFrame, kinematics: pd.DataFrame) -> pd.DataFrame:
    """Put the errors of joints and of body points together, one row each.

    Several persons are pooled; for neck and centre, which are measured on the skeletons of the last
    stage (here called `kinematics`), the person with the larger median counts. `errors` and
    `kinematics` are of `players.read`; kinematics may be empty.
    """
    errors = players.together(errors)
    points = kinematics.reindex(columns=[*BLOCK, "fusion", "person", "n", *POINT_COLUMNS])
    points = points.rename(columns=POINT_COLUMNS)
    points = points.sort_values("median_mm", ascending=False, kind="stable")
    points = points.drop_duplicates([*BLOCK, "fusion", "joint"]).assign(stage="kinematics")
    rows = pd.concat([errors, points] if len(points) else [errors], ignore_index=True)
    rows = rows[rows["joint"].isin(ROWS)]
    place = rows["joint"].map({joint: at for at, joint in enumerate(ROWS)})
    keys = [*BLOCK, "fusion", "stage", "joint"]
    rows = rows.assign(place=place).sort_values([*keys[:-1], "place"], kind="stable")
    columns = [*keys, "person", *NUMBERS]
    return rows.reindex(columns=columns).assign(claimed=rows["joint"].isin(CLAIMED))


def draw(rows: pd.DataFrame, cameras: dict[str, Sequence[str]]) -> Figure:
    """Draw medians with lines to the 95 % quantiles, raw beside corrected, and missing joints.

    Each take, calibration and network of `table` gets panels of its own; `cameras` are those of
    each fusion that `WAYS` names, for the legend.
    """
    blocks = list(rows.groupby(BLOCK, sort=False))
    ways = [way for way in WAYS if (rows["fusion"] == way).any()]
    height_mm = 6 + MM_PER_ROW * len(ROWS)
    drawing = style.figure(14 + LEGEND_MM * len(ways) + (height_mm + 14) * len(blocks))
    parts = np.atleast_1d(drawing.subfigures(len(blocks), 1))
    shown = rows[rows["fusion"].isin(ways) & rows["stage"].isin([*PANELS, "kinematics"])]
    limits = 0.7 * shown["median_mm"].min(), 1.2 * shown["p95_mm"].max()
    limits = limits if np.isfinite(limits).all() else NOTHING_MM
    for part, (key, block) in zip(parts, blocks, strict=True):
        axes = part.subplots(1, 3, sharey=True, width_ratios=[4, 4, 1.6])
        for axis, (stage, heading) in zip(axes[:2], PANELS.items(), strict=True):
            stages = [stage] if stage == "pose3d" else [stage, "kinematics"]
            _errors(axis, block[block["stage"].isin(stages)], ways)
            if stage not in set(block["stage"]):
                heading = "filtered"
                axis.text(0.5, 0.5, NO_OFFSETS, transform=axis.transAxes, ha="center")
            axis.set(title=heading, xlabel="distance from the truth (mm)")
            bars.plain_log(axis, "x")
            axis.set_xlim(*limits)
            axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.xaxis.set_minor_locator(NullLocator())
        _missing(axes[2], block[block["stage"] == "pose3d"], ways)
        _names(axes)
        part.suptitle(_title(key, block), fontsize=7)
    _explain(drawing, ways, cameras)
    return drawing


def _errors(axis: Axes, rows: pd.DataFrame, ways: list[str]) -> None:
    for way in ways:
        part, place = _mark(axis, rows, ways, way, "median_mm")
        colour = WAYS[way][1]
        axis.hlines(place, part["median_mm"], part["p95_mm"], color=colour, linewidth=0.9)
        axis.plot(part["p95_mm"], place, "|", color=colour, markersize=3)


def _mark(
    axis: Axes, rows: pd.DataFrame, ways: list[str], way: str, column: str
) -> tuple[pd.DataFrame, NDArray]:
    """Mark a column of one fusion; return its rows by joint, and their places."""
    part = rows[rows["fusion"] == way].set_index("joint").reindex(ROWS)
    place = np.arange(len(ROWS)) + SPREAD * ((ways.index(way) + 0.5) / len(ways) - 0.5)
    _, colour, marker, filled = WAYS[way]
    look = {"color": colour, "mfc": colour if filled else "white", "markersize": 3.2}
    axis.plot(part[column], place, marker, **look)
    return part, place


def _missing(axis: Axes, rows: pd.DataFrame, ways: list[str]) -> None:
    for way in ways:
        _mark(axis, rows, ways, way, "missing_percent")
    most = rows["missing_percent"].max()
    axis.set(title="missing", xlabel="of frames (%)")
    axis.set_xlim(-0.5, max(5.0, 1.1 * most) if np.isfinite(most) else 5.0)


def _names(axes: Sequence[Axes]) -> None:
    words = {**SETS, **{joint: joint.replace("_", " ") for joint in JOINTS}, **POINTS}
    axes[0].set_yticks(np.arange(len(ROWS)), [words[joint] for joint in ROWS])
    axes[0].set_ylim(len(ROWS) - 0.4, -0.6)
    for axis in axes:
        axis.grid(axis="x")
        for at, joint in enumerate(ROWS):
            if joint in CLAIMED:
                axis.axhspan(at - 0.5, at + 0.5, color=BAND, linewidth=0, zorder=0)
        for at in (len(SETS), len(ROWS) - len(POINTS)):
            axis.axhline(at - 0.5, color="#999999", linewidth=0.6)


def _title(key: tuple[str, str, str, str], rows: pd.DataFrame) -> str:
    session, take, calibration, model = key
    n = rows.loc[rows["joint"].isin(JOINTS), "n"].max()
    title = f"{session}, take {take}, {calibration}, {model}; a joint's mark: up to {n:.0f} values"
    stage = "pose3d_corrected" if "pose3d_corrected" in set(rows["stage"]) else "pose3d"
    two = rows[(rows["fusion"] == "two-robust") & rows["stage"].isin([stage, "kinematics"])]
    two = two.dropna(subset=["median_mm"]).set_index("joint")
    words = {**SETS, **POINTS}
    found = [
        f"{words[joint]} {two['median_mm'][joint]:.0f} ({two['p95_mm'][joint]:.0f})"
        for joint in ("right half", "left half", *POINTS)
        if joint in two.index
    ]
    what = f"2 cameras, fused with weights, {PANELS[stage]}; median (95 % quantile) in mm"
    return f"{title}\n{what}:\n{', '.join(found)}" if found else title


def _explain(drawing: Figure, ways: list[str], cameras: dict[str, Sequence[str]]) -> None:
    marks = []
    for way in ways:
        words, colour, marker, filled = WAYS[way]
        label = f"{len(cameras[way])} cameras ({', '.join(cameras[way])}), {words}"
        marks.append(bars.mark(colour, marker=marker, filled=filled, label=label))
    title = "mark: median; line: to the 95 % quantile; "
    title += "shaded: stable with two cameras, says the paper"
    look = {"fontsize": 7, "title": title, "title_fontsize": 7}
    drawing.legend(handles=marks, loc="outside lower center", **look)
