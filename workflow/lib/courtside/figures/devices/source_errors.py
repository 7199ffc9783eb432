"""Errors of each source by joint, errors of joint angles, and the parts of the errors."""

from collections.abc import Iterable

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from courtside.figures.style import bars, source_styles, style

SHOWN = {  # alignments of `courtside.evaluation.sources`, from none to the most complete
    "body_frame": "unaligned\n(body frame of the T-pose)",
    "root_relative": "root-relative\n(middle of the hips laid on top)",
    "procrustes_frame": "Procrustes\n(similarity for each frame)",
}
FORMS = {"fixed": "frame of the T-pose", "following": "frame that follows the trunk"}
PARTS = {  # none is the colour of a source
    "origin": "#cccccc",
    "scale": "#c9b7e0",
    "rotation": "#8c6bb1",
    "time": "#a6772f",
    "remainder": "#333333",
}
VALUES = {
    "origin": "shift {:.0f} mm",
    "scale": "scale {:.3f}",
    "rotation": "turn {:.1f}°",
    "time": "time {:+.0f} ms",
}
ANGLES = ("knee_flexion", "hip_flexion", "elbow_flexion", "shoulder_elevation", "trunk_lean")
STAGES = {"source": "none", "model": None}  # fill of the mark; None: the source's colour
MS = 1000
ORDER = ("wrist", "elbow", "shoulder", "hip", "knee", "ankle")


def table(errors: pd.DataFrame, angles: pd.DataFrame, parts: pd.DataFrame) -> pd.DataFrame:
    """Return the drawn numbers in one table: errors by joint, of joint angles, and parts.

    `errors` and `parts` are tables of `courtside.evaluation.sources` with a column `source`, parts
    also with `frame`; `angles` of `courtside.evaluation.kinematics` with `source` and `stage`.
    """
    errors = errors[errors["alignment"].isin(SHOWN)].assign(table="errors")
    angles = angles[angles["angle"].isin(ANGLES)].assign(table="angles")
    rows = pd.concat([errors, angles, parts.assign(table="parts")], ignore_index=True)
    return rows.set_index("table").reset_index()


def draw(
    errors: pd.DataFrame,
    angles: pd.DataFrame,
    parts: pd.DataFrame,
    *,
    kinds: dict[str, str] | None = None,
) -> Figure:
    """Draw errors, below them angles, then parts (see `table`); `kinds` as for `source_styles`."""
    looks = source_styles.looks(errors["source"], kinds)
    joints = _joints(errors["joint"])
    heights = [26 + (2.5 + 1.2 * len(looks)) * len(joints), 22 + 4 * len(looks)]
    heights.append(24 + 14 * len(looks))
    drawing = style.figure(sum(heights))
    above, middle, below = drawing.subfigures(3, 1, height_ratios=heights)
    _draw_errors(above, errors, looks, joints)
    _draw_angles(middle, angles, looks)
    _draw_parts(below, parts, looks)
    return drawing


def _joints(names: Iterable[str]) -> list[str]:
    """Return the joints in drawing order: from the hands down, both sides together, all last."""

    def rank(name: str) -> tuple[int, str, str]:
        part = name.split("_", 1)[-1]
        return (ORDER.index(part) if part in ORDER else len(ORDER), part, name)

    return [*sorted(set(names) - {"all"}, key=rank), "all"]


def _draw_errors(
    part: FigureBase, errors: pd.DataFrame, looks: dict[str, source_styles.Look], joints: list[str]
) -> None:
    axes = part.subplots(1, len(SHOWN), sharex=True, sharey=True)
    step = 0.8 / len(looks)
    for axis, (alignment, words) in zip(axes, SHOWN.items(), strict=True):
        rows = errors[errors["alignment"] == alignment]
        for number, (source, look) in enumerate(looks.items()):
            own = rows[rows["source"] == source].set_index("joint").reindex(joints)
            y = np.arange(len(joints)) + (number - (len(looks) - 1) / 2) * step
            axis.hlines(y, own["median_mm"], own["p95_mm"], color=look.colour, linewidth=0.9)
            axis.plot(own["median_mm"], y, look.marker, color=look.colour, markersize=3.5)
        axis.set_title(words)
        axis.axhline(len(joints) - 1.5, color="#bbbbbb", linewidth=0.6)
        axis.grid(axis="x")
        bars.plain_log(axis, "x")  # sources differ by more than a hundred times
    bars.name_rows(axes[0], joints)
    axes[len(SHOWN) // 2].set_xlabel(
        "distance to the truth (mm): median, line to the 95 % quantile"
    )
    marks = source_styles.marks(looks)
    part.legend(handles=marks, loc="outside upper center", ncols=min(4, len(marks)))


def _draw_angles(
    part: FigureBase, angles: pd.DataFrame, looks: dict[str, source_styles.Look]
) -> None:
    axes = part.subplots(1, len(ANGLES), sharey=True)
    for axis, angle in zip(axes, ANGLES, strict=True):
        rows = angles[angles["angle"] == angle].set_index(["source", "stage"])["rmse_deg"]
        for y, (source, look) in enumerate(looks.items()):
            known = [rows.get((source, stage), np.nan) for stage in STAGES]
            axis.plot(known, [y, y], color=look.colour, linewidth=0.6)
            for x, fill in zip(known, STAGES.values(), strict=True):
                face = fill or look.colour
                axis.plot(x, y, look.marker, color=look.colour, markerfacecolor=face, markersize=4)
        axis.set_title(angle.replace("_", " "))
        axis.margins(x=0.1)
        axis.set_xlim(left=0)
        axis.grid(axis="x")
    axes[0].set_ylim(len(looks) - 0.5, -0.5)
    _name_sources(axes[0], looks)
    axes[len(ANGLES) // 2].set_xlabel(
        "root mean square error of joint angles (degrees): source (hollow), skeletal model (filled)"
    )


def _name_sources(axis: Axes, looks: dict[str, source_styles.Look]) -> None:
    axis.set_yticks(np.arange(len(looks)), list(looks))
    for tick, look in zip(axis.get_yticklabels(), looks.values(), strict=True):
        tick.set_color(look.colour)


def _draw_parts(
    part: FigureBase, parts: pd.DataFrame, looks: dict[str, source_styles.Look]
) -> None:
    axes = part.subplots(1, len(FORMS), sharey=True, sharex=True)
    for axis, (form, words) in zip(axes, FORMS.items(), strict=True):
        rows = parts[parts["frame"] == form]
        for y, source in enumerate(looks):
            own = rows[rows["source"] == source].set_index("part")
            _draw_bar(axis, y, own)
        axis.set_title(words)
        axis.set_xlim(0, 100)
        axis.set_xlabel("share of the mean squared error (%)")
    _name_sources(axes[0], looks)
    axes[0].set_ylim(len(looks) - 0.3, -0.5)
    marks = [
        bars.mark(colour, marker="s", label=name.replace("origin", "place of the origin"))
        for name, colour in PARTS.items()
    ]
    part.legend(handles=marks, loc="outside lower center", ncols=len(marks))


def _draw_bar(axis: Axes, y: float, own: pd.DataFrame) -> None:
    """Draw one source's parts as a bar, with the sizes of error and corrections below it."""
    known = "all" in own.index and np.isfinite(own.loc["all", "mean_square_mm2"])
    if not known:
        axis.text(1, y, "no error known", va="center", fontsize=6.5)
        return
    start = 0.0
    for name, colour in PARTS.items():
        width = own.loc[name, "percent"]
        axis.barh(y - 0.12, width, 0.42, left=start, color=colour, linewidth=0)
        start += width
    values = own["value"].mul(pd.Series({"time": MS}), fill_value=1)
    values["time"] = np.round(values["time"]) + 0.0  # no -0
    fitted = [form.format(values[name]) for name, form in VALUES.items()]
    size = np.sqrt(own.loc["all", "mean_square_mm2"])
    text = f"{size:.0f} mm rms; {', '.join(fitted[:2])}\n{', '.join(fitted[2:])}"
    axis.text(0.5, y + 0.13, text.replace("-", "−"), va="top", fontsize=6, linespacing=1.05)
