"""Bland-Altman plots of two networks; limits of agreement and smallest detectable changes."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.figures.style import style
from courtside.statistics.agreement import REPEATS
from courtside.study.errors import StrPath

COLOURS = {"yes": "#009E73", "unsure": "#E69F00", "no": "#D55E00"}
WORDS = {
    "yes": "may be exchanged",
    "unsure": "unsure, by the 95 % intervals of the limits",
    "no": "not to be exchanged",
}
MARKERS = "os^Dv<>P*X"  # one for each subject
BAND = "#dddddd"
TEXT = ("subject", "unit", "definition", "definitions_differ", "verdict", "sentence")
SHOWN = 4
FURTHEST = 8.0  # smallest detectable changes: limits beyond are cut off


def read(pairs_csv: StrPath, table_csv: StrPath) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Read the two tables of `courtside.statistics.agreement`, with missing text as empty text."""
    tables = [pd.read_csv(path, dtype=dict.fromkeys(TEXT, str)) for path in (pairs_csv, table_csv)]
    for table in tables:
        for name in set(TEXT) & set(table):
            table[name] = table[name].astype(object).fillna("")
    return tables[0], tables[1]


def choose(table: pd.DataFrame, count: int = SHOWN) -> list[str]:
    """Choose measures of a table of `agreement.compare`, evenly from best to worst agreement."""
    known = table[table["verdict"].isin(COLOURS)]
    ratio = (np.maximum(-known["lower"], known["upper"]) / known["detectable"]).fillna(0)  # 0 / 0
    order = known.assign(ratio=ratio).sort_values("ratio", kind="stable")["measure"]
    at = np.unique(np.linspace(0, len(order) - 1, min(count, len(order))).round().astype(int))
    return order.iloc[at].tolist()


def draw(pairs: pd.DataFrame, table: pd.DataFrame, networks: tuple[str, str]) -> Figure:
    """Draw differences against means of some measures (`choose`), and the limits of all.

    `pairs` and `table` are of `courtside.statistics.agreement`.
    """
    known = table[table["verdict"].isin(COLOURS)]
    measures = choose(table)
    drawing = style.figure(80 + 3.4 * len(known))
    above, below = drawing.subfigures(2, 1, height_ratios=[62, 18 + 3.4 * len(known)])
    axes = above.subplots(1, len(measures), squeeze=False)[0]
    for axis, measure in zip(axes, measures, strict=True):
        row = known[known["measure"] == measure].iloc[0]
        _differences(axis, pairs[pairs["measure"] == measure], row)
    axes[0].set_ylabel(f"{networks[1]}\nless {networks[0]}")
    above.supxlabel("mean of the two networks", fontsize=8)
    _all_limits(below.subplots(), known)
    return drawing


def _differences(axis: Axes, part: pd.DataFrame, row: pd.Series) -> None:
    part = part.dropna(subset=["first", "second"])
    detectable = row["detectable"]
    axis.axhspan(-detectable, detectable, color=BAND, linewidth=0, zorder=0)
    days = part.groupby(REPEATS, sort=True)
    # Those with enough repeats to count have more of them than all others.
    counted = days.size().sort_values().index[::-1][: int(row["n"] - row["freedom"])]
    subjects = sorted(set(part["subject"]))
    for day, own in days:
        mean, difference = (own["first"] + own["second"]) / 2, own["second"] - own["first"]
        look = {"color": "#444444", "markersize": 2.8}
        look["markerfacecolor"] = "#444444" if day in counted else "white"
        axis.plot(mean, difference, MARKERS[subjects.index(day[0]) % len(MARKERS)], **look)
    colour = COLOURS[row["verdict"]]
    axis.axhline(row["bias"], color="black", linewidth=0.8)
    for name in ("lower", "upper"):
        axis.axhline(row[name], color=colour, linestyle="--", linewidth=1.0)
    furthest = (part["second"] - part["first"]).abs().max()
    reach = max(1.35 * max(detectable, -row["lower"], row["upper"]), 1.05 * furthest)
    axis.set_ylim(-reach, reach)
    axis.set_title(f"{_words(row['measure'])} ({row['unit'] or '1'})", fontsize=7)
    axis.tick_params(labelsize=7)


def _words(measure: str) -> str:
    words = measure.replace("_", " ")
    half = words.rfind(" ", 0, 18)
    return words if len(words) <= 18 or half < 0 else f"{words[:half]}\n{words[half + 1 :]}"


def _all_limits(axis: Axes, known: pd.DataFrame) -> None:
    place = np.arange(len(known))
    axis.axvspan(-1, 1, color=BAND, linewidth=0, zorder=0)
    axis.axvline(0, color="#999999", linewidth=0.6)
    for name, colour in COLOURS.items():
        at = np.flatnonzero(known["verdict"] == name)
        part = known.iloc[at]
        unit = part["detectable"].to_numpy()
        axis.hlines(
            at, part["lower_from"] / unit, part["upper_to"] / unit, color=colour, linewidth=0.5
        )
        axis.hlines(at, part["lower"] / unit, part["upper"] / unit, color=colour, linewidth=2.2)
        label = f"{WORDS[name]}: {len(part)}"
        axis.plot(part["bias"] / unit, at, "o", color=colour, markersize=3, label=label)
    ends = known[["lower", "upper"]].div(known["detectable"], axis=0).abs().to_numpy()
    reach = min(max(2.0, 1.15 * ends.max(initial=1.0)), FURTHEST)
    axis.set_xlim(-reach, reach)
    _mark_beyond(axis, known, reach)
    labels = known["measure"].str.replace("_", " ") + np.where(
        known["definitions_differ"] != "", " *", ""
    )
    axis.set_yticks(place, labels, fontsize=6)
    axis.set_ylim(len(known) - 0.4, -0.6)
    axis.set_xlabel("difference, in smallest detectable changes of the network in use")
    axis.figure.legend(loc="outside lower center", ncols=3)


def _mark_beyond(axis: Axes, known: pd.DataFrame, reach: float) -> None:
    """Mark limits beyond the ends of the axis with arrows."""
    for end, side, marker in (("lower", -1, "<"), ("upper", 1, ">")):
        at = np.flatnonzero(side * known[end] / known["detectable"] > reach)
        colours = [COLOURS[verdict] for verdict in known["verdict"].iloc[at]]
        look: dict = {"marker": marker, "c": colours, "s": 14, "clip_on": False}
        axis.scatter(np.full(len(at), side * reach), at, **look)
