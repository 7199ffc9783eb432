"""Strokes laid over one another in phase: wrist and trunk around the time of the stroke."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.figures.style import bars, style
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.statistics import normal_errors
from courtside.strokes import signals

BEFORE_S, AFTER_S, STEP_S = 0.8, 0.6, 0.02
FEWEST = 3  # strokes of a band
A_ROW = 4  # entries of the legend
HEIGHT_MM, EMPTY_MM = 130, 20
KINDS = {True: "overhead strokes", False: "low strokes"}
LINES = {
    "reach_m": "wrist from waist (m)",
    "wrist_m_s": "wrist (m/s)",
    "trunk_m_s": "trunk (m/s)",
}


def table(strokes: pd.DataFrame, points: Keypoints3D) -> pd.DataFrame:
    """Return each stroke's lines: `person`, `stroke` from 1, `overhead`, `phase_s`, `LINES`."""
    phase = np.arange(-BEFORE_S, AFTER_S + STEP_S / 2, STEP_S)
    parts = []
    for at, person in enumerate(map(str, points.person_id)):
        own = strokes[strokes.person == person]
        if not len(own):
            continue
        found = signals.of_person(points, at)
        for number, stroke in enumerate(own.itertuples(), 1):
            arm = found.arms[stroke.hand]
            lines = (arm.reach * found.size_m, arm.speed(found.rate_hz), found.trunk.speed)
            values = {
                name: np.interp(stroke.time_s + phase, found.time_s, line, np.nan, np.nan)
                for name, line in zip(LINES, lines, strict=True)
            }
            known = {"person": person, "stroke": number, "overhead": bool(stroke.overhead)}
            parts.append(pd.DataFrame({**known, "phase_s": phase, **values}))
    columns = ["person", "stroke", "overhead", "phase_s", *LINES]
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=columns)


def draw(rows: pd.DataFrame) -> Figure:
    """Draw overhead and low strokes side by side: each, their mean and a band for one more.

    Without any stroke one sentence says so in place of panels.
    """
    if rows.empty:
        drawing = style.figure(EMPTY_MM)
        drawing.text(0.5, 0.5, "No stroke was found in this take.", ha="center", va="center")
        return drawing
    drawing = style.figure(HEIGHT_MM)
    axes = drawing.subplots(len(LINES), len(KINDS), sharex=True, sharey="row")
    people = list(dict.fromkeys(rows.person))
    look = {person: style.line_look(at) for at, person in enumerate(people)}
    for column, (overhead, words) in enumerate(KINDS.items()):
        own = rows[rows.overhead == overhead]
        n_strokes = len(own.groupby(["person", "stroke"]))
        axes[0, column].set_title(f"{words}, n = {n_strokes}", loc="left")
        axes[-1, column].set_xlabel("time from the stroke (s)")
        for axis, name in zip(axes[:, column], LINES, strict=True):
            axis.axvline(0, color=style.MIDDLE, linewidth=0.8, linestyle=":")
            for person, part in own.groupby("person", sort=False):
                _draw_lines(axis, part, name, look[person], str(person))
    for axis, words in zip(axes[:, 0], LINES.values(), strict=True):
        axis.set_ylabel(words)
        axis.set_ylim(bottom=0)
    axes[0, 0].set_xlim(-BEFORE_S - STEP_S, AFTER_S + STEP_S)
    named = dict(sorted(bars.named(axes.ravel()).items()))
    drawing.legend(named.values(), named, loc="outside upper right", ncols=min(len(named), A_ROW))
    return drawing


def _draw_lines(
    axis: Axes, part: pd.DataFrame, name: str, look: dict[str, str], person: str
) -> None:
    """Draw a person's strokes; their mean where all are known: else it jumps where one ends."""
    wide = part.pivot(index="phase_s", columns="stroke", values=name)
    each = axis.plot(wide.index, wide, **look, linewidth=0.5, alpha=0.6)
    each[0].set_label(f"{person}: each stroke")
    n_strokes = wide.shape[1]
    if n_strokes < 2:
        return
    middle = wide.mean(axis=1, skipna=False)
    if middle.notna().any():
        axis.plot(wide.index, middle, **look, linewidth=1.6, label=f"{person}: mean of all")
    if n_strokes >= FEWEST:
        reach = normal_errors.one_more(n_strokes, 0.9) * wide.std(axis=1, skipna=False)
        low, high = middle - reach, middle + reach
        axis.fill_between(wide.index, low, high, color=look["color"], alpha=0.15, lw=0)
