"""Numbers beside published ones: points, a walk, the length of a racket, the paper's table 1."""

from typing import Any

import pandas as pd

from courtside.evaluation.numbers import calibration
from courtside.evaluation.numbers.register import PUBLISHED, Builder, Cut, Number, Source

TABLE_1 = "config/published/badminton_tab01.csv"
RACKET = "figures/badminton_fig12.csv"
RACKETS = ("sfm18", "known8", "dlt8", "paper3", "perfect")  # way and number of clicks
THEIRS = {"8-point": "their8", "SfM": "their_walk"}  # of the published values: part
ROWS = {
    "exact": "project and triangulate again",
    "rounded": "the same, rounded to whole pixels",
    "rounded_published": "the same, rounded to whole pixels of the published width",
    "reprojection": "detections to reprojection, views used",
    "left_out": "detections to reprojection, views left out",
    "truth": "distance to the truth (the error)",
}


def walk(source: Source) -> list[Number]:
    """Return the published errors of calibrations beside our re-enactment and our method.

    At two of the points that were calibrated from, as published, and over the volume. A walk is
    compared at the number of images nearest to the published one.
    """
    build = Builder("published-walk")
    for session in calibration.sessions(source):
        figure = f"{session}/figures/badminton_fig08.csv"
        drawn = source.table(figure)
        for _, row in drawn[drawn["method"] == "published"].iterrows():
            cut = Cut(source, figure, f"{row['quantity']}, published", session)
            if row["quantity"] == "xy_cm_strong":
                name = f"`{session}`: 18 points, no walk"
                _published(build, name, row["median"], cut)
                _again(build, name, source, session, None)
            elif row["quantity"] == "xy_cm":
                n_images = _nearest(source, session, row["n_bridging"])
                theirs = "" if n_images == row["n_bridging"] else f"; theirs: {row['n_bridging']:g}"
                name = f"`{session}`: walk of {n_images:g} images{theirs}"
                _published(build, name, row["median"], cut)
                _again(build, name, source, session, n_images)
    return build.numbers


def _published(build: Builder, name: str, value: float, cut: Cut) -> None:
    build.add(name, "published", value, cut, "median", decimals=1, unit="cm", origin=PUBLISHED)


def _nearest(source: Source, session: str, n_images: float) -> float:
    table = source.table(calibration.TABLE)
    of = table[(table["session"] == session) & (table["method"] == "paper")]["n_bridging"]
    return float(of.iloc[(of - n_images).abs().argmin()])


def _again(build: Builder, name: str, source: Source, session: str, n_images: float | None) -> None:
    table = source.table(calibration.TABLE)
    table = table[(table["session"] == session) & table["in_sample"]]
    table = table[table["click_strength"] == 1]
    ways = {"again": "paper3incremental", "here": "sfm18global"}
    if n_images is None:
        ways = {"again": "dlt18", "here": "known18"}
        table = table[table["n_bridging"].isna()]
    else:
        table = table[table["n_bridging"] == n_images]
    way = table["method"] + table["n_clicks"].astype(str) + table["mapper"].fillna("")
    for part, wanted in ways.items():
        for _, row in table[way == wanted].iterrows():
            where = f"{session}, {wanted}, N = {n_images}, in-sample, click_strength 1"
            cut = Cut(source, calibration.TABLE, where, session)
            shown = {
                f"{part}_xy": ("xy_cm_median", 2, "cm"),
                f"{part}_volume": ("volume_rms_cm_median", 2, "cm"),
            }
            build.add_columns(name, row, shown, cut, n=row["n"], n_failed=row["n_failed"])


def racket(source: Source) -> list[Number]:
    """Return the mean absolute errors of a racket's length, absolute and over perfect cameras."""
    build, table = Builder("racket"), source.table(RACKET)
    of = table[(table["quantity"] == "mean_abs_mm") & table["tips"].isna()]
    theirs = of[of["way"] == "published"]
    for (session, sigma_px), part in of.groupby(["session", "tip_sigma_px"]):
        name = f"`{session}`, ends clicked within {sigma_px:g} px"
        for _, row in theirs.iterrows():
            cut = Cut(source, RACKET, f"mean_abs_mm, tips empty, published, {row['reference']}", "")
            more: dict[str, Any] = {"decimals": 1, "unit": "mm", "origin": PUBLISHED}
            build.add(name, THEIRS[row["reference"]], row["median"], cut, "median", **more)
        _ways(build, name, source, part[part["way"].isin(RACKETS)])
    return build.numbers


def _ways(build: Builder, name: str, source: Source, part: pd.DataFrame) -> None:
    for _, row in part.iterrows():
        where = f"mean_abs_mm, tips empty, {row['session']}, {row['tip_sigma_px']:g} px"
        where += f", way {row['way']}"
        cut = Cut(source, RACKET, where, row["session"])
        shown = {row["way"]: ("mean", 1, "mm"), f"{row['way']}_ratio": ("ratio", 2, "")}
        build.add_columns(name, row, shown, cut, n=row["n"], n_failed=row["n_failed"])


def round_trip(source: Source) -> list[Number]:
    """Return the paper's table 1 and what it leaves out, over all joints, by set of cameras."""
    build = Builder("table-1")
    for file in source.names("*/evaluation/takes/*/round_trip/*.csv"):
        table, parts = source.table(file), file.split("/")
        for _, row in table[table["joint"] == "all"].iterrows():
            where = f"row {row['row']}, joint all, cameras {row['cameras']}"
            name = f"`{parts[0]}/{parts[3]}`, {row['n_cameras']} cameras: {ROWS[row['row']]}"
            cut = Cut(source, file, where, parts[0])
            shown = {part: (part, 2, row["unit"]) for part in ("mean", "sd")}
            build.add_columns(name, row, shown, cut, n=row["n"])
    return build.numbers


def table_1(documents: Source) -> list[Number]:
    """Return the authors' table 1, the mean over their joints, from the repository's copy."""
    table = documents.table(TABLE_1)
    build, cut = Builder("table-1"), Cut(documents, TABLE_1, "all joints", "")
    more: dict[str, Any] = {"unit": "mm", "n": len(table), "origin": PUBLISHED}
    for part, column in (("published", "mean_mm"), ("published_sd", "sd_mm")):
        name = "the authors' table 1, called reprojection error"
        build.add(name, part, table[column].mean(), cut, f"{column}: mean", **more)
    return build.numbers
