"""Medians with their 5-95 % ranges."""

from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullFormatter


def draw(axis, x, rows, *, colour, marker="o", filled=True, line="-", label=None):
    """Draw medians with bars from the 5 to the 95 % quantile.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    x : (n,) float
    rows : pandas.DataFrame, length n
        `p05`, `median`, `p95`.
    colour : str
    marker : str
    filled : bool
        Hollow marks otherwise.
    line : str
        Style of the line that joins the medians; "none" for none.
    label : str or None
    """
    axis.vlines(x, rows["p05"], rows["p95"], color=colour, linewidth=1.0, alpha=0.8)
    look = {"markersize": 4.5, "markerfacecolor": colour if filled else "white", "linewidth": 0.9}
    axis.plot(x, rows["median"], marker=marker, linestyle=line, color=colour, label=label, **look)


def draw_level(axis, row, *, colour, line="--", label=None):
    """Draw a level that depends on nothing: a band from the 5 to the 95 % quantile, a line at the median.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    row : mapping
        `p05`, `median`, `p95`.
    colour, line : str
    label : str or None
    """
    axis.axhspan(row["p05"], row["p95"], color=colour, alpha=0.13, linewidth=0, zorder=0)
    axis.axhline(row["median"], color=colour, linestyle=line, linewidth=0.9, label=label, zorder=1)


def ticks_at(axis, values):
    """Put the ticks of a logarithmic x axis at given values only."""
    axis.set_xscale("log")
    axis.set_xticks(values, [f"{value:g}" for value in values])
    axis.set_xticks([], minor=True)


def plain_log(axis):
    """Make the y axis logarithmic, with numbers written out."""
    axis.set_yscale("log")
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.yaxis.set_minor_formatter(NullFormatter())


def mark(colour, *, marker="o", filled=True, line="none", label=None):
    """Return a line for a legend that looks as `draw` draws.

    Parameters
    ----------
    colour, marker : str
    filled : bool
    line : str
    label : str or None
    """
    face = colour if filled else "white"
    look = {"markersize": 4.5, "markerfacecolor": face, "linewidth": 0.9}
    return Line2D([], [], marker=marker, color=colour, linestyle=line, label=label, **look)
