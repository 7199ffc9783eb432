"""Effect of the recording conditions on the error of a calibration."""

import re

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.evaluation.tables import calibration
from courtside.figures.style import bars, style

METHODS = {  # [method, mapper, clicks]: as the study names them; None: all points of the court
    "control points": ("sfm", "global", None),
    "paper's eq 2-5": ("paper", "global", 3),  # of the same structure from motion
}
WORDS = {
    "speed_kmh": "walking speed (km/h)",
    "baseline_deg": "angle between the fixed cameras (°)",
    "width_px": "picture width (px)",
    "size_px": "picture size (px)",
    "stabiliser": "stabiliser",
    "n_bridging": "N =",
}
MARKERS = "osv^D"
DODGE = 0.12  # of the distance between neighbouring settings


def table(
    rows: pd.DataFrame, x: str, group: str | None = None, n_bridging: int | None = None
) -> pd.DataFrame:
    """Return the spread of the volume error by setting, from rows of `calibration.tidy`.

    Trials with the scored points left out, if the way (a key of `METHODS`) can do without them. `x`
    and `group` are the columns of the settings that vary; only trials with `n_bridging` images
    count, if it is given.
    """
    if n_bridging is not None:
        rows = rows[rows["n_bridging"] == n_bridging]
    settings = [x] if group is None else [x, group]
    parts = []
    for way, (method, mapper, clicks) in METHODS.items():
        clicks = clicks or rows["n_clicks"].max()
        of = calibration.pick(rows, method=method, mapper=mapper, n_clicks=clicks)
        of = of[of[x].notna()]
        of = of[of["in_sample"] == of["in_sample"].min()] if len(of) else of
        found = calibration.summary(of, ["in_sample", *settings], "volume_rms_cm")
        parts.append(found.assign(way=way))
    columns = ["way", "in_sample", *settings, "n", "p05", "median", "p95", "n_failed"]
    return pd.concat(parts, ignore_index=True)[columns]


def draw(numbers: pd.DataFrame, x: str, group: str | None = None, title: str = "") -> Figure:
    """Draw the table of `table` (same `x` and `group`), one panel for each way to calibrate."""
    drawing = style.figure(82)
    axes = drawing.subplots(1, len(METHODS), sharey=True, sharex=True)
    settings = sorted(numbers[x].unique(), key=_place)
    for axis, way in zip(axes, METHODS, strict=True):
        part = numbers[numbers["way"] == way]
        _draw_way(axis, part, settings, x, group)
        scored = "in-sample" if part["in_sample"].any() else "scored points left out"
        axis.set_title(f"{way} ({scored})")
        axis.set_xticks(range(len(settings)), [_words(value) for value in settings])
        bars.plain_log(axis)
        axis.set_xlabel(WORDS.get(x, x))
        axis.set_xlim(-0.5, len(settings) - 0.5)
        axis.grid(axis="y")
    axes[0].set_ylabel("error over the volume, RMS (cm)")
    low, high = axes[0].get_ylim()
    axes[0].set_ylim(low, high * (high / low) ** 0.18)  # room for the counts of failures
    if group is not None:
        handles, labels = axes[0].get_legend_handles_labels()
        drawing.legend(handles, labels, loc="outside lower center", ncols=len(MARKERS))
    text = bars.sizes(numbers)
    drawing.suptitle(f"{title}: {text}" if title else text, fontsize=8)
    return drawing


def _draw_way(axis: Axes, part: pd.DataFrame, settings: list, x: str, group: str | None) -> None:
    values = [None] if group is None else sorted(part[group].unique())
    for at, value in enumerate(values):
        rows = part if group is None else part[part[group] == value]
        rows = rows.sort_values(x, key=lambda column: column.map(_place))
        place = np.array([settings.index(each) for each in rows[x]], dtype=float)
        place += DODGE * (at - (len(values) - 1) / 2)
        label = None if group is None else f"{WORDS.get(group, group)} {_words(value)}"
        known = rows["median"].notna().to_numpy()
        colour, marker = (looks[at % len(looks)] for looks in (style.CYCLE, MARKERS))
        look: dict = {"colour": colour, "marker": marker, "label": label}
        bars.draw(axis, place[known], rows[known], filled=not rows["in_sample"].any(), **look)
        for each, (_, row) in zip(place, rows.iterrows(), strict=True):
            _count(axis, each, row, at, colour)


def _count(axis: Axes, place: float, row: pd.Series, line: int, colour: str) -> None:
    """Write near the panel's top how many trials failed."""
    if not row["n_failed"]:
        return
    text = f"{int(row['n_failed'])} of {int(row['n'] + row['n_failed'])} failed"
    where = {"transform": axis.get_xaxis_transform(), "ha": "center", "va": "top", "fontsize": 6}
    axis.text(round(place), 0.995 - 0.05 * line, text, color=colour, **where)


def _place(value: str | float) -> float:
    """Return the sort key of a setting: a number, or the first number of a text."""
    if not isinstance(value, str):
        return float(value)
    number = re.search(r"\d+(\.\d+)?", value)
    return float(number.group()) if number else 0.0


def _words(value: str | float | bool) -> str:
    if isinstance(value, bool | np.bool_):
        return "on" if value else "off"
    return f"{value:g}" if isinstance(value, int | float | np.number) else str(value)
