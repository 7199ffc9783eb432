"""Error by number of bridging images, and what the X_o/Y_o error does not show.

The counterpart of [Shishido2020, fig 8].
"""

from collections import namedtuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from courtside.evaluation.tables import calibration
from courtside.figures.style import bars, style

Series = namedtuple("Series", "label method mapper n_clicks in_sample colour marker")
# [Shishido2020, sec 3.2]: mean of the X_o and Y_o errors, cm, and degrees between neighbours, by N.
PUBLISHED: dict[str, dict[float, float]] = {
    "xy_cm": {300: 4.3, 20: 229.5},
    "xy_cm_below": {150: 10, 75: 10},
    "xy_cm_strong": {np.nan: 2.2},
    "neighbour_deg_median": {40: 6.0, 20: 12.0},
}
MAPPERS = {"global": style.CYCLE[0], "incremental": style.CYCLE[1]}
BY_CLICKS = [(style.CYCLE[0], "o"), (style.CYCLE[5], "^"), (style.CYCLE[2], "v")]
Level = namedtuple("Level", "method rank words colour line marker")
LEVELS = [  # rank: of the number of clicks, the largest first
    Level("known", 0, "known points", style.CYCLE[6], "--", "D"),
    Level("known", 1, "known points", style.CYCLE[3], ":", "p"),
    Level("dlt", 0, "DLT", style.CYCLE[4], "-.", "h"),
]
STRONG = 2.3  # where the strong calibrations stand, in units of the largest N
ERRORS = {
    "xy_cm": "error of $X_o$ and $Y_o$, mean (cm)",
    "volume_rms_cm": "error over the volume, RMS (cm)",
}
DODGE = 0.045  # of the logarithm of N, between series
WALK_DEG = {"a": 90.0}  # what a walk from one fixed camera to the other turns, by layout
PUBLISHED_LAYOUT = "a"  # [Shishido2020, sec 3.1, fig 3(a)]


def table(rows: pd.DataFrame, layout: str) -> pd.DataFrame:
    """Return the numbers drawn, from rows of `calibration.tidy` of one session.

    For quantities other than `ERRORS` n counts structures from motion. The method `published` holds
    the paper's values, in sessions of its layout only.
    """
    keys = ["method", "mapper", "n_clicks", "in_sample", "n_bridging"]
    parts = [calibration.summary(rows, keys, name).assign(quantity=name) for name in ERRORS]
    found = calibration.structures_of(rows)
    for name in ("solved_share", "registered_share", "neighbour_deg_median", "neighbour_deg_max"):
        part = calibration.summary(found, ["mapper", "n_bridging"], name)
        if name.endswith("share"):  # few structures: a mean, but no meaningful quantiles
            means = found.groupby(["mapper", "n_bridging"])[name].mean()
            part = part.assign(median=means.to_numpy(), p05=np.nan, p95=np.nan)
        parts.append(part.assign(quantity=name))
    columns = ["quantity", *keys, "n", "p05", "median", "p95", "n_failed"]
    parts += [_published()] if layout == PUBLISHED_LAYOUT else []
    return pd.concat(parts, ignore_index=True)[columns]


def _published() -> pd.DataFrame:
    values = [(name, *pair) for name, of in PUBLISHED.items() for pair in of.items()]
    rows = pd.DataFrame(values, columns=["quantity", "n_bridging", "median"])
    return rows.assign(method="published", mapper="", in_sample=True)


def _series(numbers: pd.DataFrame) -> list[Series]:
    """Return the `Series` to draw against the number of bridging images, the paper's own first."""
    name = "paper's eq 2-5, incremental"
    paper = Series(name, "paper", "incremental", 3, True, style.CYCLE[1], "s")
    found = [paper] if len(calibration.pick(numbers, method="paper", mapper="incremental")) else []
    ours = calibration.pick(numbers, method="sfm", mapper="global")
    clicks = sorted(ours["n_clicks"].dropna().astype(int).unique(), reverse=True)
    for count, look in zip(clicks, BY_CLICKS, strict=False):
        for in_sample in (False, True):
            if len(calibration.pick(ours, n_clicks=count, in_sample=in_sample)):
                name = f"control points, {count} clicks"
                found.append(Series(name, "sfm", "global", count, in_sample, *look))
    return found


def levels(numbers: pd.DataFrame, quantity: str) -> list[tuple[str, pd.DataFrame, Level]]:
    """Return the strong calibrations to draw: label, rows with a result, look.

    Rows with the scored points left out come first.
    """
    of = numbers[(numbers["quantity"] == quantity) & numbers["method"].isin(["known", "dlt"])]
    clicks = sorted(of["n_clicks"].dropna().astype(int).unique(), reverse=True)
    found = []
    for level in LEVELS:
        if level.rank >= len(clicks):
            continue
        rows = calibration.pick(of, method=level.method, n_clicks=clicks[level.rank])
        rows = rows.dropna(subset=["median"]).sort_values("in_sample")
        if len(rows):
            found.append((f"{level.words}, {clicks[level.rank]} clicks", rows, level))
    return found


def draw(numbers: pd.DataFrame, title: str, layout: str = "") -> Figure:
    """Draw the table of `table`, for `WALK_DEG` also the angles of an evenly divided walk."""
    drawing = style.figure(165)
    places = [["xy_cm", "volume_rms_cm"], ["solved", "angle"]]
    axes = drawing.subplot_mosaic(places, height_ratios=[1.55, 1])
    axes["volume_rms_cm"].sharey(axes["xy_cm"])  # before drawing: limits are then those of both
    for quantity, words in ERRORS.items():
        _draw_errors(axes[quantity], numbers, quantity)
        axes[quantity].set_ylabel(words)
    _mark_published(axes["xy_cm"], numbers)
    for name in ("xy_cm", "volume_rms_cm", "angle"):
        bars.plain_log(axes[name])
    for quantity, form, size in (("solved_share", "o-", 4), ("registered_share", "x:", 8)):
        _draw_mappers(axes["solved"], numbers, quantity, form, factor=100, size=size)
    axes["solved"].set(ylim=(-5, 105), ylabel="solved, registered (%)")
    _draw_angles(axes["angle"], numbers, layout)
    counts = sorted(numbers["n_bridging"].dropna().astype(int).unique())
    for axis in axes.values():
        bars.ticks_at(axis, counts)
        axis.set(xlabel="bridging images N", xlim=(counts[0] / 1.3, counts[-1] * 1.3))
        axis.grid(axis="y")
    for name in ERRORS:
        axes[name].set_xlim(right=counts[-1] * STRONG * 1.25)
        axes[name].set_xticks([*counts, STRONG * counts[-1]], [*map(str, counts), "strong"])
    handles = _legend(numbers)
    drawing.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=6.5)
    drawing.suptitle(f"{title}; {_sizes(numbers)}", fontsize=8)
    return drawing


def _sizes(numbers: pd.DataFrame) -> str:
    """Return the number of trials behind a mark, in words: of walks, and of points alone."""
    of = numbers[numbers["quantity"] == "xy_cm"]
    words = []
    for what, methods in {"walks": ["sfm"], "points alone (strong)": ["known", "dlt"]}.items():
        mine = of[of["method"].isin(methods)]
        total = (mine["n"] + mine["n_failed"]).astype(int)
        if len(mine):
            count = " to ".join(map(str, sorted({total.min(), total.max()})))
            words.append(f"{what}: {count} trials per mark")
    return ", ".join(words) or "no trials"


def _draw_errors(axis: Axes, numbers: pd.DataFrame, quantity: str) -> None:
    of = numbers[numbers["quantity"] == quantity]
    beside = STRONG * numbers["n_bridging"].max()
    for at, (_, rows, level) in enumerate(levels(numbers, quantity)):
        bars.draw_level(axis, rows.iloc[0], colour=level.colour, line=level.line)
        for back, (_, row) in enumerate(rows.iterrows()):
            x = np.array([beside * np.exp(1.3 * DODGE * (2 * at + back - 2.5))])
            look = {"colour": level.colour, "marker": level.marker, "filled": not row["in_sample"]}
            bars.draw(axis, x, row.to_frame().T, line="none", **look)
    shown = _series(numbers)
    for at, each in enumerate(shown):
        keys = ("method", "mapper", "n_clicks", "in_sample")
        rows = calibration.pick(of, **{key: getattr(each, key) for key in keys}).sort_values(
            "n_bridging"
        )
        x = rows["n_bridging"] * np.exp(DODGE * (at - (len(shown) - 1) / 2))
        lost = rows["median"].isna()
        where = {"transform": axis.get_xaxis_transform(), "linestyle": "none", "markersize": 4}
        axis.plot(x[lost], 0.015 + 0 * x[lost], marker="x", color=each.colour, **where)
        joined = not each.in_sample or each._replace(in_sample=False) not in shown
        look = {"colour": each.colour, "marker": each.marker, "filled": not each.in_sample}
        bars.draw(axis, x[~lost], rows[~lost], line="-" if joined else "none", **look)


def _mark_published(axis: Axes, numbers: pd.DataFrame) -> None:
    of = calibration.pick(numbers, method="published")
    kinds = ("xy_cm", "xy_cm_below", "xy_cm_strong")
    exact, below, strong = (calibration.pick(of, quantity=kind) for kind in kinds)
    look = {"color": "black", "linestyle": "none", "markersize": 8, "zorder": 6}
    axis.plot(exact["n_bridging"], exact["median"], "*", **look)
    axis.plot(below["n_bridging"], below["median"], marker=r"$\downarrow$", **look)
    beside = STRONG * numbers["n_bridging"].max() * np.exp(-8 * DODGE)
    axis.plot(np.full(len(strong), beside), strong["median"], "*", **look)


def _draw_angles(axis: Axes, numbers: pd.DataFrame, layout: str) -> None:
    for quantity, form in (("neighbour_deg_median", "o-"), ("neighbour_deg_max", "^:")):
        _draw_mappers(axis, numbers, quantity, form)
    of = calibration.pick(numbers, method="published", quantity="neighbour_deg_median")
    axis.plot(of["n_bridging"], of["median"], "*", color="black", markersize=8, zorder=6)
    if layout in WALK_DEG:
        counts = np.sort(numbers["n_bridging"].dropna().unique())
        axis.plot(counts, WALK_DEG[layout] / (counts + 1), color="#999999", linewidth=0.9, zorder=0)
    axis.set_ylabel("angle between neighbours (°)")


def _draw_mappers(
    axis: Axes,
    numbers: pd.DataFrame,
    quantity: str,
    form: str,
    *,
    factor: float = 1,
    size: float = 4,
) -> None:
    for at, (mapper, colour) in enumerate(MAPPERS.items()):
        rows = calibration.pick(numbers, quantity=quantity, mapper=mapper).dropna(subset=["median"])
        rows = rows.sort_values("n_bridging")
        x = rows["n_bridging"] * np.exp(DODGE * (at - 0.5))
        axis.plot(x, factor * rows["median"], form, color=colour, markersize=size, linewidth=1)


def _legend(numbers: pd.DataFrame) -> list[Line2D]:
    """Return the marks to explain: series, strong calibrations, published values, lower panels."""
    named = {each.label: each for each in _series(numbers)}
    handles = [bars.mark(e.colour, marker=e.marker, label=label) for label, e in named.items()]
    for label, _, level in levels(numbers, "xy_cm"):
        handles.append(bars.mark(level.colour, marker=level.marker, line=level.line, label=label))
    grey = "#555555"
    handles += [
        bars.mark(grey, label="filled: scored points left out"),
        bars.mark(grey, filled=False, label="hollow: in-sample"),
        bars.mark(grey, marker="x", label="no result"),
    ]
    if (numbers["method"] == "published").any():
        handles.append(bars.mark("black", marker="*", label="published"))
        handles.append(bars.mark("black", marker=r"$\downarrow$", label="published: below"))
    for mapper, colour in MAPPERS.items():
        if (numbers["mapper"] == mapper).any():
            label = f"{mapper} mapper: solved; median angle"
            handles.append(bars.mark(colour, line="-", label=label))
    handles.append(bars.mark(grey, marker="x", line=":", label="the same: registered images"))
    handles[-1].set_markersize(8)
    handles.append(bars.mark(grey, marker="^", line=":", label="the same: largest angle"))
    return handles
