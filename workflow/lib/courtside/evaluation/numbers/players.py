"""Numbers of virtual players: joints, joint angles, paths, speeds, clocks; raw and corrected."""

from typing import Any

import numpy as np
import pandas as pd

from courtside.evaluation.numbers.register import Builder, Cut, Number, Source
from courtside.evaluation.tables.calibration import pick
from courtside.evaluation.tables.players import STAGES as STAGE_OF
from courtside.evaluation.tables.players import furthest
from courtside.study.methods import STAGE_WORDS

TABLE, ANGLES, HELD = (f"figures/{name}.csv" for name in ("players", "angles", "reliability"))
STAGES = tuple(STAGE_WORDS.values())
OURS = "all-robust"  # the default rule, all cameras of a take
NETWORK = "blazepose-heavy-flip"  # the default network
FUSIONS = {  # of a set of cameras and a rule
    "all-robust": "all cameras",
    "all-dlt": "all cameras, plain DLT",
    "all-unsteady": "all cameras, shake left as it is",
    "three-robust": "3 cameras",
    "halfbody": "3 cameras, the paper's half bodies (re-enacted)",
    "three-dlt": "3 cameras, plain DLT",
    "two-robust": "2 cameras",
    "two-dlt": "2 cameras, plain DLT",
    "two-unsteady": "2 cameras, shake left as it is",
}


def words(fusion: str) -> str:
    """Return what a set of cameras and a rule is called; its own name where it has no other."""
    return FUSIONS.get(fusion, f"`{fusion}`")


PER_STAGE = {  # part: column, decimals, unit
    "median": ("median_mm", 0, "mm"),
    "p95": ("p95_mm", 0, "mm"),
    "coverage": ("coverage_90_percent", 0, "%"),
    "missing": ("missing_percent", 1, "%"),
    "shift": ("bias_mm", 0, "mm"),
    "unshifted": ("unbiased_median_mm", 0, "mm"),
    "unshifted_p95": ("unbiased_p95_mm", 0, "mm"),
}


def takes(source: Source) -> list[Number]:
    """Return the errors of joints of every take and rule: raw, filtered and corrected."""
    build, table = Builder("players"), source.table(TABLE)
    table = table.assign(
        order=table["fusion"].map({f: i for i, f in enumerate(FUSIONS)}).fillna(len(FUSIONS))
    )
    key = ["session", "take", "calibration", "model", "order", "fusion"]
    for (session, take, calibration, model, _, fusion), of in table.groupby(key, sort=True):
        row = f"`{session}/{take}`: {words(fusion)}"
        row += "" if model == NETWORK else f" ({model})"
        for _, one in of.iterrows():
            where = f"{session}/{take}, {calibration}, {model}, {fusion}, stage {one['stage']}"
            cut = Cut(source, TABLE, where, session)
            shown = {f"{one['stage']}_{part}": how for part, how in PER_STAGE.items()}
            build.add_columns(row, one, shown, cut, n=one["n"])
    return build.numbers


def sessions(source: Source) -> list[Number]:
    """Return the errors of joints by session: the median take and the worst, default rule."""
    build, table = Builder("players-sessions"), source.table(TABLE)
    table = table[table["fusion"] == OURS]
    for (session, calibration, model), of in table.groupby(["session", "calibration", "model"]):
        n_takes = of["take"].nunique()
        takes_ = f"{n_takes} takes" if n_takes > 1 else f"take `{of['take'].iloc[0]}`"
        row = f"`{session}`, {takes_}, calibration `{calibration}`, network `{model}`"
        for stage in STAGES:
            one = of[of["stage"] == stage]
            if len(one):
                cut = Cut(source, TABLE, f"{session}, {model}, {OURS}, stage {stage}", session)
                _of_session(build, row, stage, one, cut)
    return build.numbers


def _of_session(build: Builder, row: str, stage: str, of: pd.DataFrame, cut: Cut) -> None:
    count: dict[str, Any] = {"n": of["n"].sum(), "decimals": 0}
    for part in ("median", "p95", "unshifted", "unshifted_p95"):
        column = PER_STAGE[part][0]
        values = of[column]
        build.add(row, f"{stage}_{part}", values.median(), cut, f"{column}: median take", **count)
        worst = values.max()
        build.add(row, f"{stage}_{part}_worst", worst, cut, f"{column}: worst take", **count)
    held = np.average(of["coverage_90_percent"], weights=of["n"])
    build.add(row, f"{stage}_coverage", held, cut, "coverage_90_percent: mean by n", **count)
    least = of["coverage_90_percent"].min()
    build.add(row, f"{stage}_least", least, cut, "coverage_90_percent: least take", **count)


def angles(source: Source) -> list[Number]:
    """Return the errors of joint angles: every session, default rule, takes weighted with n."""
    build, table = Builder("angles"), source.table(ANGLES)
    table = table[table["fusion"] == OURS]
    for (angle, session, model), of in table.groupby(["angle", "session", "model"], sort=False):
        row = f"{str(angle).replace('_', ' ')}, `{session}`" + (
            "" if model == NETWORK else f" ({model})"
        )
        for stage in STAGES:
            one = of[(of["stage"] == stage) & (of["n"] > 0)]
            if len(one):
                where = f"{session}, {model}, {OURS}, {angle}, stage {stage}"
                _of_angle(build, row, stage, one, Cut(source, ANGLES, where, session))
    order = {name: at for at, name in enumerate(ORDER)}
    build.numbers.sort(key=lambda number: order.get(number.row.split(",")[0], len(order)))
    return build.numbers


ORDER = [
    *("knee flexion", "hip flexion", "elbow flexion", "shoulder elevation"),
    *("trunk lean", "trunk lean forward"),
]


def _of_angle(build: Builder, row: str, stage: str, of: pd.DataFrame, cut: Cut) -> None:
    count: dict[str, Any] = {"n": of["n"].sum()}
    weights = of["n"]
    for part in ("bias", "rmse"):
        values = of[f"{part}_deg"]
        mean = np.average(values, weights=weights)
        mean = mean if part == "bias" else np.sqrt(np.average(values**2, weights=weights))
        more: dict[str, Any] = {**count, "decimals": 1, "unit": "degrees"}
        build.add(row, f"{stage}_{part}", mean, cut, f"{part}_deg, by n", **more)
    held = np.average(of["within_90_percent"], weights=weights)
    count = {**count, "decimals": 0, "unit": "%"}
    build.add(row, f"{stage}_coverage", held, cut, "within_90_percent, by n", **count)


GROUPS = {  # of the counts of stated errors, by their names: what is counted
    ("all", "limbs"): "joints",
    ("measure", "angle"): "joint angles",
    ("measure", "speed"): "speeds of neck, centre and mass",
    ("measure", "distance"): "distances of these",
}
LARGE_MM = ("100", "300")  # groups of joints by the size of the error: above 100 mm


def held(source: Source) -> list[Number]:
    """Return what 90 % ellipsoids hold of joints by session and network, intervals of measures."""
    build, table, part = Builder("held"), source.table(HELD), "held_90_percent"
    table = table[table["stage"].isin(STAGE_OF)].fillna({"model": ""})
    table = table.assign(group=table["group"].astype(str))
    for (by, group), words_ in GROUPS.items():
        own = table[(table["by"] == by) & (table["group"] == group)]
        own = own if by == "all" else own[own["session"] == "all"]
        for _, row in own[own["n"] > 0].iterrows():
            session, model, stage = row["session"], row["model"], STAGE_OF[row["stage"]]
            cut = Cut(source, HELD, f"{session} {model}, {row['stage']}, {by} {group}", session)
            name = f"{words_}, " + ("all sessions" if session == "all" else f"`{session}`")
            name += "" if model in ("", NETWORK) else f" ({model})"
            build.add(name, stage, row[part], cut, part, n=row["n"], decimals=1, unit="%")
            large = pick(table, session=session, model=model, stage=row["stage"], by="error")
            large = large[large["group"].isin(LARGE_MM)]
            if group == "limbs" and len(large):
                share = np.average(large[part], weights=large["n"])
                more: dict[str, Any] = {"n": large["n"].sum(), "decimals": 0, "unit": "%"}
                build.add(name, f"{stage}_large", share, cut, f"{part}, errors", **more)
    return build.numbers


CLOCKS = {  # part: column, decimals, unit
    "clock": ("clock_error_ms", 1, "ms"),
    "clocks_within": ("n_clocks_within", 0, ""),
    "clocks": ("n_clocks", 0, ""),
}
PATHS = {
    "speed": ("speed_rmse_m_s", 2, "m/s"),
    "held": ("speed_within_90_percent", 0, "%"),
    "far": ("distance_error_percent", 1, "%"),
}


def measures(source: Source) -> list[Number]:
    """Return the errors of speeds, distances and clocks by take and cameras, the worst person."""
    build, table = Builder("players-measures"), source.table(TABLE)
    # Views are left out after the clocks were found: those of fewer cameras are not their own.
    table = table[(table["fusion"] == OURS) & table["clock_error_ms"].notna()]
    for file in source.names(f"*/evaluation/takes/*/kinematics/*/*-robust/{NETWORK}.csv"):
        parts, rows = file.split("/"), source.table(file)
        session, take, fusion = parts[0], parts[3], parts[6]
        row = f"`{session}/{take}`: {words(fusion)}"
        for point, of in rows.groupby("point", sort=False):
            for part, (column, decimals, unit) in PATHS.items():
                cut = Cut(source, file, f"{point}, furthest person", session)
                value = of[column].min() if part == "held" else furthest(of[column])
                more: dict[str, Any] = {"decimals": decimals, "unit": unit, "n": of["n"].sum()}
                build.add(row, f"{point}_{part}", value, cut, column, **more)
        same = (table["session"] == session) & (table["take"] == take) & (table["fusion"] == fusion)
        for _, one in table[same].iterrows():
            cut = Cut(source, TABLE, f"{session}/{take}, {fusion}, raw", session)
            build.add_columns(row, one, CLOCKS, cut)
    return build.numbers
