"""Numbers of calibrations: a walk against clicked points alone, every hall, and over halls."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from courtside.evaluation.numbers.register import Builder, Cut, Number, Source
from courtside.evaluation.tables import calibration
from courtside.evaluation.tables.calibration import N_REFERENCE
from courtside.statistics import intervals

TABLE = "figures/calibration.csv"
TRIALS = f"in-sample, N = {N_REFERENCE}, click_strength 1"  # which rows of the evaluations count
MAPPER, PUBLISHED_MAPPER = "global", "incremental"  # of the default method, of the published one
WAYS = {  # part: method, mapper, clicks
    "walk18": ("sfm", MAPPER, 18),
    "walk8": ("sfm", MAPPER, 8),
    "walk3": ("sfm", MAPPER, 3),
    "known18": ("known", "", 18),
    "known8": ("known", "", 8),
    "board18": ("known-board", "", 18),
    "dlt18": ("dlt", "", 18),
    "similarity18": ("sim3", MAPPER, 18),
    "paper_global": ("paper", MAPPER, 3),
    "paper": ("paper", PUBLISHED_MAPPER, 3),
}
WORDS = {
    "walk18": f"walk of {N_REFERENCE} images + 18 clicks (default)",
    "walk8": f"walk of {N_REFERENCE} images + 8 clicks",
    "walk3": f"walk of {N_REFERENCE} images + 3 clicks",
    "known18": "18 known points, no walk",
    "known8": "8 known points, no walk",
    "board18": "18 known points, lens from a chessboard",
    "dlt18": "18 known points, linear (DLT)",
    "similarity18": "walk, global mapper, similarity to 18 points",
    "paper_global": "walk, global mapper, the paper's eq 2-5",
    "paper": "walk, incremental mapper, the paper's eq 2-5 (the published method, re-enacted)",
}
CAPTURED = {  # ways of `figures.calibration.conditions`: how the documents call them
    "control points": "walk, 18 points",
    "paper's eq 2-5": "walk, the published method",
}
CAPTURE = ("way", "in_sample", "n", "p05", "median", "p95", "n_failed")  # no settings
OVER_HALLS = ("walk18", "walk8", "walk3", "known18", "board18", "paper")


def trials(
    source: Source, sessions: Sequence[str], n_images: str = str(N_REFERENCE)
) -> pd.DataFrame:
    """Return the trials of some sessions: all ways of `WAYS`, of walks the ones of `n_images`.

    Scored at points that were calibrated from; the volume is the same for all. `part`: the way;
    `hall`, `structure`; `value`: the error over the volume (cm), NaN where the trial failed;
    `points`: its 95 % quantile over the points of the volume.
    """
    parts = []
    for session in sessions:
        names = source.names(f"{session}/evaluation/*-n{n_images}-o*.csv")
        names += source.names(f"{session}/evaluation/known.csv")
        rows = calibration.read([source.folder / name for name in names])
        rows = rows[rows["in_sample"]]
        for part, (method, mapper, n_clicks) in WAYS.items():
            of = calibration.pick(rows, method=method, mapper=mapper, n_clicks=n_clicks)
            parts.append(of.assign(part=part))
    rows = pd.concat(parts, ignore_index=True)
    seed = rows["seed"].astype(object).fillna("").astype(str) if "seed" in rows else ""
    return rows.assign(
        hall=(rows["preset"] + " " + rows["layout"] + " " + seed).str.strip(),
        structure=rows["session"] + " " + rows["offset"].fillna(0).astype(str),
        value=rows["volume_rms_cm"].astype(float),
        points=rows["volume_p95_cm"].astype(float),
    )


def sessions(source: Source) -> list[str]:
    """Return the sessions of the calibration table that vary no condition, in its order."""
    table = source.table(TABLE)
    return list(dict.fromkeys(table.loc[table["condition"].isna(), "session"]))


def label(rows: pd.DataFrame) -> str:
    """Return the label of a session."""
    session, preset, layout = rows[["session", "preset", "layout"]].iloc[0]
    return f"`{session}` ({preset} hall, layout {layout})"


def calibrations(source: Source) -> list[Number]:
    """Return the errors in each hall and over halls, and the difference that the walk makes."""
    build, named = Builder("calibration"), sessions(source)
    rows = trials(source, named)
    for session, of in rows.groupby("session", sort=False):
        cut = Cut(source, f"{session}/evaluation/*.csv", TRIALS, str(session))
        for part, group in of.groupby("part", sort=False):
            _one_way(build, label(of), (part, f"{part}_p95", f"{part}_points"), group, cut)
        _difference(build, label(of), of, cut)
    cut = Cut(source, "*/evaluation/*.csv", TRIALS, " ".join(named))
    _together(build, f"all {rows['hall'].nunique()} halls", rows, cut)
    return build.numbers


def _one_way(
    build: Builder, row: str, names: tuple[str, str, str], of: pd.DataFrame, cut: Cut
) -> dict[str, Any]:
    """Add median, 95 % and points of a way under these names; return how they were counted."""
    found, part = calibration.spread(of["value"]), of["part"].iloc[0]
    count: dict[str, Any] = {"n": found["n"], "n_failed": len(of) - found["n"], "unit": "cm"}
    median, p95, points = names
    where = f"{part}, volume_rms_cm"
    build.add(row, median, found["median"], cut, f"{where}: median of trials", **count)
    build.add(row, p95, found["p95"], cut, f"{where}: 95 % of trials", **count)
    build.add(row, points, of["points"].median(), cut, f"{part}, volume_p95_cm: median", **count)
    return count


def differences(rows: pd.DataFrame, part: str = "walk18") -> pd.DataFrame:
    """Return trials of a way with `value` less that of 18 known points from the same clicks."""
    ours, known = (rows[rows["part"] == name] for name in (part, "known18"))
    pairs = ours.merge(known[["session", "draw", "value"]], on=["session", "draw"])
    return pairs.assign(value=pairs["value_x"] - pairs["value_y"])


def _difference(build: Builder, row: str, rows: pd.DataFrame, cut: Cut) -> None:
    for part in ("walk18", "walk3"):
        pairs = differences(rows, part)
        medians = pairs.groupby("hall")["value"].median()
        if medians.isna().all():
            continue
        low, high = intervals.bootstrap(pairs, np.nanmedian)
        count: dict[str, Any] = {"n": int(pairs["value"].notna().sum()), "unit": "cm"}
        count["n_failed"] = len(pairs) - count["n"]
        name = f"{part}_less_known18"
        where = f"{part} less known18, same clicks"
        build.add(row, name, medians.median(), cut, f"{where}: median over halls", **count)
        build.add(row, f"{name}_from", low, cut, f"{where}: 95 % interval", **count)
        build.add(row, f"{name}_to", high, cut, f"{where}: 95 % interval", **count)


def _together(build: Builder, row: str, rows: pd.DataFrame, cut: Cut) -> None:
    """Add medians over halls, their intervals, and the worst hall's median."""
    for part, of in rows.groupby("part", sort=False):
        medians = of.groupby("hall")["value"].median()
        if part not in OVER_HALLS or medians.isna().all():
            continue
        n = int(of["value"].notna().sum())
        count: dict[str, Any] = {"n": n, "n_failed": len(of) - n, "unit": "cm"}
        where = f"{part}, volume_rms_cm"
        low, high = intervals.bootstrap(of, np.nanmedian)
        build.add(row, str(part), medians.median(), cut, f"{where}: median over halls", **count)
        build.add(row, f"{part}_from", low, cut, f"{where}: 95 % interval", **count)
        build.add(row, f"{part}_to", high, cut, f"{where}: 95 % interval", **count)
        build.add(row, f"{part}_worst", medians.max(), cut, f"{where}: worst hall", **count)
    _difference(build, row, rows, cut)


def ways(source: Source) -> list[Number]:
    """Return every way to calibrate in every hall."""
    build, named = Builder("calibration-ways"), sessions(source)
    rows = trials(source, named)
    for part, words in WORDS.items():
        for session, of in rows[rows["part"] == part].groupby("session", sort=False):
            cut = Cut(source, f"{session}/evaluation/*.csv", TRIALS, str(session))
            row = f"{words}; `{session}`"
            count = _one_way(build, row, ("median", "p95", "points"), of, cut)
            build.add(row, "xy", of["xy_cm"].median(), cut, f"{part}, xy_cm: median", **count)
    return build.numbers


def growth(source: Source) -> list[Number]:
    """Return the errors of the default method by the number of images of the walk."""
    build = Builder("calibration-growth")
    for session in sessions(source):
        rows = trials(source, [session], "*")
        rows = rows[rows["part"] == "walk18"]
        for n_images, of in rows.groupby("n_bridging"):
            where = f"N = {n_images:.0f}, walk18, in-sample, click_strength 1"
            file = f"{session}/evaluation/{MAPPER}-n{n_images:.0f}-o*.csv"
            cut = Cut(source, file, where, session)
            name = f"`{session}`, {of['structure'].nunique()} x {n_images:.0f} images"
            found = calibration.spread(of["value"])
            count: dict[str, Any] = {"n": found["n"], "n_failed": len(of) - found["n"]}
            for part in ("median", "p95"):
                build.add(name, part, found[part], cut, "volume_rms_cm", unit="cm", **count)
            count |= {"unit": "%", "decimals": 0}
            covered = 100 * of["coverage90"].mean()
            build.add(name, "coverage", covered, cut, "coverage90: mean", **count)
    return build.numbers


def strengths(source: Source) -> list[Number]:
    """Return errors and coverage by the scatter of the clicks, where it was varied."""
    build, table = Builder("calibration-strengths"), source.table(TABLE)
    table = table[table["condition"].isna() & table["in_sample"]]
    table = table[table["n_bridging"].isna() | (table["n_bridging"] == N_REFERENCE)]
    key = table["method"] + table["mapper"].fillna("") + table["n_clicks"].astype(str)
    for part in ("walk18", "walk8", "walk3", "known18"):
        of = table[key == "".join(map(str, WAYS[part]))]
        for _, row in of.sort_values(["session", "click_strength"], kind="stable").iterrows():
            strength = f"{row['click_strength']:g}"
            where = f"{row['session']}, {part}, N = 40, in-sample, click_strength {strength}"
            cut = Cut(source, TABLE, where, row["session"])
            name = f"`{row['session']}`, scatter x{strength}"
            count: dict[str, Any] = {"n": row["n"], "n_failed": row["n_failed"]}
            ends = ("median", "p95")
            shown = {f"{part}_{end}": (f"volume_rms_cm_{end}", 2, "cm") for end in ends}
            build.add_columns(name, row, shown, cut, **count)
            more: dict[str, Any] = {**count, "decimals": 0, "unit": "%"}
            covered = 100 * row["coverage90"]
            build.add(name, f"{part}_coverage", covered, cut, "coverage90", **more)
    return build.numbers


def capture(source: Source) -> list[Number]:
    """Return the errors under varied conditions of capture: one hall and walk for each setting."""
    build = Builder("capture")
    for file in source.names("figures/capture_*.csv"):
        table = source.table(file)
        varied = [column for column in table if column not in CAPTURE]
        for _, row in table.iterrows():
            setting = ", ".join(f"{name} {row[name]}" for name in varied)
            way = f"{row['way']}{'' if row['in_sample'] else ' (scored points left out)'}"
            cut = Cut(source, file, f"{setting}, way {way}", f"{file.split('/')[-1][:-4]}-*")
            shown = {part: (part, 2, "cm") for part in ("median", "p95")}
            count: dict[str, Any] = {"n": row["n"], "n_failed": row["n_failed"]}
            words = CAPTURED.get(row["way"], row["way"])
            words += "" if row["in_sample"] else " without the two scored ones"
            build.add_columns(f"{setting}: {words}", row, shown, cut, **count)
    return build.numbers
