"""Run time of each step by number of bridging images."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from courtside.figures.style import bars, style
from courtside.study.errors import StrPath
from courtside.study.methods import VARIANT, Variant

ONCE = "once per session"
MARKERS = "osv^Dx"
DODGE = 0.05  # of the logarithm of N, between choices of images


def table(paths: Sequence[StrPath]) -> pd.DataFrame:
    """Read benchmark files `{step}/{mapper}-n{N}-o{offset}.tsv`; other names are steps done once.

    The seconds and memory are means if a file has several runs.
    """
    rows = []
    for path in map(Path, paths):
        runs = pd.read_csv(path, sep="\t", na_values="-")
        of: dict = {"mapper": ONCE, "n_bridging": np.nan, "offset": np.nan}
        if VARIANT.fullmatch(path.stem):
            found = Variant.parse(path.stem)
            of = {"mapper": found.mapper, "n_bridging": found.n_images, "offset": found.offset}
        rows.append({"step": path.parent.name, **of, "seconds": runs["s"].mean()})
        rows[-1]["max_rss_mb"] = pd.to_numeric(runs["max_rss"], errors="coerce").mean()
    keys = ["step", "mapper", "n_bridging", "offset"]
    return pd.DataFrame(rows).sort_values(keys, ignore_index=True)


def exponents(rows: pd.DataFrame) -> pd.DataFrame:
    """Return for each step and mapper of `table` the power law through the seconds.

    step, mapper, exponent, factor_s (seconds at N = 1), n; NaN for fewer than two numbers of
    images.
    """
    laws = []
    for (step, mapper), group in rows[rows["mapper"] != ONCE].groupby(["step", "mapper"]):
        law = np.full(2, np.nan)
        if group["n_bridging"].nunique() > 1:
            law = np.polyfit(np.log(group["n_bridging"]), np.log(group["seconds"]), 1)
        laws.append((step, mapper, law[0], np.exp(law[1]), len(group)))
    return pd.DataFrame(laws, columns=["step", "mapper", "exponent", "factor_s", "n"])


def draw(rows: pd.DataFrame, title: str = "") -> Figure:
    """Draw the table of `table` with its power laws."""
    drawing = style.figure(95)
    axis = drawing.subplots()
    laws, middle = exponents(rows), rows["offset"].max() / 2
    looks = zip(laws.itertuples(), style.CYCLE * 2, MARKERS * 2, strict=False)
    for law, colour, marker in looks:
        of = rows[(rows["step"] == law.step) & (rows["mapper"] == law.mapper)]
        label = f"{law.step}, {law.mapper}"
        if np.isfinite(law.exponent):
            label += f": N$^{{{law.exponent:.2f}}}$ (n = {law.n})"
            ends = np.array([of["n_bridging"].min(), of["n_bridging"].max()])
            axis.plot(ends, law.factor_s * ends**law.exponent, color=colour, linewidth=0.9)
        x = of["n_bridging"] * np.exp(DODGE * (of["offset"] - middle))
        axis.plot(x, of["seconds"], marker, color=colour, markersize=4.5, label=label)
    once = rows[rows["mapper"] == ONCE].groupby("step")["seconds"].sum()
    for (step, seconds), line in zip(once.items(), ("--", ":"), strict=False):
        axis.axhline(
            seconds, color="#777777", linestyle=line, linewidth=0.9, label=f"{step}, {ONCE}"
        )
    counts = sorted(rows["n_bridging"].dropna().astype(int).unique())
    bars.ticks_at(axis, counts)
    bars.plain_log(axis)
    axis.set(xlabel="bridging images N", ylabel="time (s)", title=title)
    axis.grid(axis="y")
    drawing.legend(*axis.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return drawing
