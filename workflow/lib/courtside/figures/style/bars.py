"""Medians with their 5-95 % ranges, their marks in legends, and the axes that they stand on."""

from collections.abc import Iterable, Mapping, Sequence

import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogFormatter
from numpy.typing import NDArray


def draw(
    axis: Axes,
    x: NDArray,
    rows: pd.DataFrame,
    *,
    colour: str,
    marker: str = "o",
    filled: bool = True,
    line: str = "-",
    label: str | None = None,
) -> None:
    """Draw medians with bars from the 5 to the 95 % quantile.

    `rows` have `p05`, `median` and `p95` at each of `x` (n,). `line` is the style of the line that
    joins the medians, "none" for none; marks that are not `filled` are hollow.
    """
    axis.vlines(x, rows["p05"], rows["p95"], color=colour, linewidth=1.0, alpha=0.8)
    look = {"markersize": 4.5, "markerfacecolor": colour if filled else "white", "linewidth": 0.9}
    axis.plot(x, rows["median"], marker=marker, linestyle=line, color=colour, label=label, **look)


def draw_level(axis: Axes, row: Mapping, *, colour: str, line: str = "--") -> None:
    """Draw a level as a band from the 5 to the 95 % quantile and a line at the median.

    `row` has `p05`, `median` and `p95`.
    """
    axis.axhspan(row["p05"], row["p95"], color=colour, alpha=0.13, linewidth=0, zorder=0)
    axis.axhline(row["median"], color=colour, linestyle=line, linewidth=0.9, zorder=1)


def sizes(rows: pd.DataFrame) -> str:
    """Return in words what bars are and of how many trials, with and without a result."""
    total = rows["n"] + rows["n_failed"]
    upto = f" to {total.max()}" if total.nunique() > 1 else ""
    return f"median and 5-95 % of {total.min()}{upto} trials"


def ticks_at(axis: Axes, values: Sequence[float]) -> None:
    """Put the ticks of a logarithmic x axis at given values only."""
    axis.set_xscale("log")
    axis.set_xticks(values, [f"{value:g}" for value in values])
    axis.set_xticks([], minor=True)


def plain_log(axis: Axes, which: str = "y") -> None:
    """Make the y or x axis logarithmic, with numbers written out; few decades have more numbers."""
    axis.set(**{f"{which}scale": "log"})
    scale = axis.yaxis if which == "y" else axis.xaxis
    scale.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    scale.set_minor_formatter(LogFormatter(minor_thresholds=(1, 0.4)))


def name_rows(axis: Axes, names: Sequence[str]) -> None:
    """Name the rows of an axis, 0 at the top."""
    axis.set_yticks(range(len(names)), [name.replace("_", " ") for name in names])
    axis.set_ylim(len(names) - 0.5, -0.5)


def named(axes: Iterable[Axes]) -> dict[str, Artist]:
    """Return what axes draw under a label, by label, each once: of several the last."""
    pairs = [pair for axis in axes for pair in zip(*axis.get_legend_handles_labels(), strict=True)]
    return {label: handle for handle, label in pairs}


def mark(
    colour: str,
    *,
    marker: str = "o",
    filled: bool = True,
    line: str = "none",
    label: str | None = None,
) -> Line2D:
    """Return a line for a legend that looks as `draw` draws."""
    face = colour if filled else "white"
    look = {"markersize": 4.5, "markerfacecolor": face, "linewidth": 0.9}
    return Line2D([], [], marker=marker, color=colour, linestyle=line, label=label, **look)
