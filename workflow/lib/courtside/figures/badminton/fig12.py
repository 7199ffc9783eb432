"""Length of a racket by cameras calibrated in several ways, compared with perfect cameras.

The counterpart of [Shishido2020, fig 12].
"""

from collections import namedtuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from courtside.evaluation.tables import racket
from courtside.figures.style import bars, style

Way = namedtuple("Way", "name words colour")
WAYS = [  # name: method and number of clicks, as evaluations have them
    Way("dlt8", "8-point DLT", style.CYCLE[4]),
    Way("known8", "8-point, non-linear", style.CYCLE[1]),
    Way("paper3", "SfM, paper's eq 2-5", style.CYCLE[5]),
    Way("sfm8", "SfM, 8 control points", style.CYCLE[2]),
    Way("sfm18", "SfM, 18 control points (default)", style.CYCLE[0]),
    Way("perfect", "perfect cameras: the floor", "#777777"),
]
PUBLISHED = {"8-point": (0, 1), "SfM": (2, 4)}  # which of `WAYS` may be compared, first and last
WORDS = {
    "mean_abs_mm": "mean |error|",
    "std_below_mm": "std, frames 1-10",
    "std_above_mm": "std, frames 11-21",
}
AGAINST = [  # reference, clicks of the racket: as differences are drawn
    ("known8", "same", style.CYCLE[1], True),
    ("known8", "anew", style.CYCLE[1], False),
    ("dlt8", "same", style.CYCLE[4], True),
]
BELOW = 10  # frames below the net's height, as published
SHOWN_MM = 70  # to either side of the length
TICKS_MM = [5, 10, 20, 50, 100]
LINEAR_MM = 3  # to either side of no difference
FAR_MM = 300  # what reaches further has ticks at powers of ten alone
WIDTH = 0.11  # of a box, where groups are 1 apart


def draw(numbers: pd.DataFrame, length_m: float) -> Figure:
    """Draw the table of `racket.table` of a racket so long, a column of panels for each session."""
    sessions = list(dict.fromkeys(numbers["session"].dropna()))
    sigmas_px = sorted(numbers["tip_sigma_px"].dropna().unique(), reverse=True)
    drawing = style.figure(115 + 45 * len(sigmas_px))
    of_paper = numbers[numbers["way"] == "published"]
    published = of_paper.pivot(index="quantity", columns="reference", values="median")
    heights = [1.15] * len(sigmas_px) + [1.2, 1.1, 0.8]
    axes = drawing.subplots(
        len(heights), len(sessions), squeeze=False, sharey="row", height_ratios=heights
    )
    for column, session in zip(axes.T, sessions, strict=True):
        of = numbers[numbers["session"] == session]
        layout = of["layout"].iloc[0]
        n_runs = int((of["n"] + of["n_failed"]).max())
        column[0].set_title(f"{session}: layout {layout}, {n_runs} runs", fontweight="bold")
        for axis, sigma_px in zip(column, sigmas_px, strict=False):
            _draw_errors(axis, of[of["tip_sigma_px"] == sigma_px])
            _mark_published(axis, published)
        pairs = of[(of["tip_sigma_px"] == sigmas_px[0]) & of["reference"].notna()]
        _draw_differences(column[-3], pairs, published)
        _draw_run(column[-2], of[of["quantity"] == "length_mm"], 1000 * length_m)
        _draw_volume(column[-1], of[of["quantity"] == "volume_rms_cm"])
    for axis, sigma_px in zip(axes[:, 0], sigmas_px, strict=False):
        axis.set_ylabel(f"tips {sigma_px:g} px: error (mm)")
        _tick_errors(axis)
    _tick_differences(axes[-3, 0])
    axes[-3, 0].set_ylabel("SfM minus 8-point (mm)")
    axes[-2, 0].set_ylabel("length, one run (mm)")
    axes[-1, 0].set_ylabel("volume error (cm)")
    drawing.align_ylabels(axes[:, 0])
    drawing.legend(handles=_legend(), loc="outside lower center", ncols=3, fontsize=6.5)
    return drawing


def _draw_errors(axis: Axes, numbers: pd.DataFrame) -> None:
    rows = numbers[numbers["reference"].isna()]
    for at, name in enumerate(WORDS):
        of = rows[rows["quantity"] == name].set_index("way")
        for way, place in zip(WAYS, at + _places(len(WAYS)), strict=True):
            if way.name in of.index:
                _box(axis, place, of.loc[way.name], way.colour)
        floor = of["median"].get(racket.FLOOR, np.nan)
        reach = [at - 0.42, at + 0.42]
        axis.plot(reach, [floor, floor], color="#777777", linestyle="--", linewidth=0.8, zorder=1)
    bars.plain_log(axis)
    _group_ticks(axis)


def _tick_errors(axis: Axes) -> None:
    high = axis.get_ylim()[1]
    axis.set_yticks(TICKS_MM if high <= FAR_MM else [10, *_powers(high)])


def _tick_differences(axis: Axes) -> None:
    low, high = axis.get_ylim()
    below = [-value for value in reversed(_powers(-low))]
    axis.set_yticks([*below, -10, 0, 10, *_powers(high)])
    axis.set_yticks([-LINEAR_MM, LINEAR_MM], minor=True)


def _powers(most: float) -> list[int]:
    """Return the powers of ten from 100 up to a length, mm."""
    return [100 * 10**at for at in range(9) if 100 * 10**at <= most]


def _places(n_boxes: int) -> NDArray:
    return 1.25 * WIDTH * (np.arange(n_boxes) - (n_boxes - 1) / 2)


def _group_ticks(axis: Axes) -> None:
    axis.set_xticks(range(len(WORDS)), list(WORDS.values()))
    axis.set_xlim(-0.5, len(WORDS) - 0.5)
    axis.tick_params(axis="x", length=0)
    axis.grid(axis="y")


def _box(axis: Axes, place: float, row: pd.Series, colour: str, filled: bool = True) -> None:
    """Draw the quartiles as a box with its median, and the range from 5 to 95 %."""
    axis.vlines(place, row["p05"], row["p95"], color=colour, linewidth=1.0, zorder=2)
    look = {"facecolor": colour if filled else "white", "edgecolor": colour, "linewidth": 0.8}
    axis.bar(place, row["p75"] - row["p25"], WIDTH, row["p25"], zorder=3, **look)
    ends = [place - WIDTH / 2, place + WIDTH / 2]
    ink = "white" if filled else colour
    axis.plot(ends, [row["median"]] * 2, color=ink, linewidth=1.2, zorder=4)


def _mark_published(axis: Axes, published: pd.DataFrame) -> None:
    for at, name in enumerate(WORDS):
        places = at + _places(len(WAYS))
        for family, (first, last) in PUBLISHED.items():
            reach = [places[first] - WIDTH / 2, places[last] + WIDTH / 2]
            _star(axis, reach, np.mean(reach), published.loc[name, family])


def _star(axis: Axes, reach: list[float], at: float, value: float) -> None:
    """Draw a published value as a line with a star."""
    axis.plot(reach, [value, value], color="black", linewidth=0.9, zorder=5)
    axis.plot(at, value, "*", color="black", markersize=7, zorder=6)


def _draw_differences(axis: Axes, numbers: pd.DataFrame, published: pd.DataFrame) -> None:
    places = _places(len(AGAINST)) * 1.6
    for at, name in enumerate(WORDS):
        of = numbers[numbers["quantity"] == name].set_index(["reference", "tips"])
        for (reference, tips, colour, filled), place in zip(AGAINST, at + places, strict=True):
            _box(axis, place, of.loc[(reference, tips)], colour, filled)
        value = published.loc[name, "SfM"] - published.loc[name, "8-point"]
        reach = [at + places[0] - WIDTH, at + places[-1] + WIDTH]
        _star(axis, reach, reach[0], value)
    axis.axhline(0, color="#777777", linestyle="--", linewidth=0.8, zorder=1)
    axis.set_yscale("symlog", linthresh=LINEAR_MM, linscale=1.5)
    axis.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    _group_ticks(axis)


def _draw_run(axis: Axes, numbers: pd.DataFrame, true_mm: float) -> None:
    for way in reversed(WAYS):
        of = numbers[numbers["way"] == way.name].sort_values("frame")
        on_top = way.name == racket.OURS
        axis.plot(of["frame"], of["median"], color=way.colour, linewidth=1.6 if on_top else 0.9)
    axis.axhline(true_mm, color="black", linestyle=":", linewidth=0.8)
    axis.axvline(BELOW + 0.5, color="black", linewidth=0.6)
    where = {"transform": axis.get_xaxis_transform(), "va": "top", "fontsize": 6.5}
    axis.text(BELOW + 0.3, 0.99, "below the net's height", ha="right", **where)
    axis.text(BELOW + 0.7, 0.99, "above", ha="left", **where)
    axis.set(xlim=(0.5, 21.5), ylim=(true_mm - SHOWN_MM, true_mm + SHOWN_MM))
    axis.set_xticks([1, 5, 10, 15, 21])
    axis.set_xlabel("frame")


def _draw_volume(axis: Axes, numbers: pd.DataFrame) -> None:
    of = numbers.set_index("way")
    shown = [way for way in WAYS if way.name in of.index and way.name != racket.FLOOR]
    for place, way in enumerate(shown):
        _box(axis, place * WIDTH * 3, of.loc[way.name], way.colour)
        value = of.loc[way.name, "median"]
        axis.text(place * WIDTH * 3 + WIDTH, value, f"{value:.1f}", va="center", fontsize=6.5)
    axis.set_xlim(-2 * WIDTH, 3 * len(shown) * WIDTH)
    axis.set_xticks([])
    bars.plain_log(axis)
    axis.grid(axis="y")


def _legend() -> list:
    """Return the marks to explain: ways, differences, floor, published values."""
    handles = [Patch(facecolor=way.colour, label=way.words) for way in WAYS]
    hollow = {"facecolor": "white", "edgecolor": style.CYCLE[1]}
    handles.append(Patch(label="difference, racket clicked anew for each", **hollow))
    handles.append(
        Line2D([], [], color="#777777", linestyle="--", label="median of the floor; no difference")
    )
    handles.append(bars.mark("black", marker="*", line="-", label="published"))
    return handles
