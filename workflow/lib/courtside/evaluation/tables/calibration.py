"""The calibration table: errors over sessions, calibrations and numbers of pictures."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.evaluation import calibration
from courtside.statistics import intervals
from courtside.study.errors import StrPath

N_REFERENCE = 40  # images of the walk of the default method
TEXT = ("session", "preset", "layout", "condition", "mapper", "method", "outcome")
CHOICE = ["method", "n_clicks", "in_sample"]
STRUCTURE = ["session", "condition", "mapper", "n_bridging", "offset"]
# The uses of a structure from motion without a result, if no other structure of the table has one.
USED = [(method, 18, in_sample) for method in ("sfm", "sim3") for in_sample in (True, False)]
USUAL = pd.DataFrame([*USED, ("paper", 3, True)], columns=CHOICE)


def read(paths: Sequence[StrPath], *, click_strength: float | None = 1.0) -> pd.DataFrame:
    """Read evaluation tables, of structures from motion and of known points, into one (`tidy`).

    Trials of one `click_strength`; None: of all.
    """
    tables = [pd.read_csv(path, dtype=dict.fromkeys(TEXT, str)) for path in paths]
    rows = tidy(pd.concat(tables, ignore_index=True))
    return rows if click_strength is None else pick(rows, click_strength=click_strength)


def tidy(rows: pd.DataFrame) -> pd.DataFrame:
    """Give every trial one row, also those of a structure from motion without a result.

    In the evaluations' tables such a structure has one row per draw, without a method. Here that
    row is repeated for each choice of method, clicks and scored points. No text is missing.
    """
    rows = rows.copy()
    for column in TEXT:
        rows[column] = rows[column].astype(object).fillna("").astype(str) if column in rows else ""
    for column in ("n_bridging", "offset", "in_sample"):
        if column not in rows:
            rows[column] = np.nan
    if "click_strength" not in rows:
        rows["click_strength"] = 1.0
    empty = (rows["method"] == "").to_numpy()
    done, failed = rows[~empty].copy(), rows[empty]
    done["in_sample"] = done["in_sample"].astype(str) == "True"
    done["n_clicks"] = done["n_clicks"].astype(int)
    if failed.empty:
        return done.reset_index(drop=True)
    choices = done.loc[done["mapper"] != "", CHOICE].drop_duplicates()
    failed = failed.drop(columns=CHOICE, errors="ignore")
    failed = failed.merge(choices if len(choices) else USUAL, how="cross")
    whole = [failed.dropna(axis=1, how="all"), done] if len(done) else [failed]
    return pd.concat(whole, ignore_index=True)[list(rows.columns)]


def pick(rows: pd.DataFrame, **values: object) -> pd.DataFrame:
    """Return the rows in which the named columns have these values."""
    there = np.ones(len(rows), dtype=bool)
    for column, value in values.items():
        there &= (rows[column] == value).to_numpy(dtype=bool)
    return rows[there]


def spread(values: NDArray | pd.Series) -> pd.Series:
    """Return the number of finite values and their 5, 50 and 95 % quantiles, as a Series."""
    known = np.asarray(values, dtype=float)
    known = known[np.isfinite(known)]
    low, middle, high = np.quantile(known, [0.05, 0.5, 0.95]) if len(known) else (np.nan,) * 3
    return pd.Series({"n": len(known), "p05": low, "median": middle, "p95": high})


def summary(rows: pd.DataFrame, by: list[str], value: str) -> pd.DataFrame:
    """Return the spread of one column of trials by group: n, p05, median, p95 and n_failed.

    Rows of `tidy` are grouped by the columns `by`; missing values form a group. n_failed counts
    trials without a value.
    """
    columns = [*by, "n", "p05", "median", "p95", "n_failed"]
    found = [
        (*key, *(counts := spread(group[value])), len(group) - counts["n"])
        for key, group in rows.groupby(by, dropna=False, sort=True)
    ]
    return pd.DataFrame(found, columns=columns).astype({"n": int, "n_failed": int})


def structures_of(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the structures from motion behind trials (of `tidy`), one row each.

    session, condition, mapper, n_bridging, offset; `solved_share`: 1 if any of these trials has a
    result, else 0; `registered_share` of its images; neighbour_deg_median and neighbour_deg_max.
    """
    about = ["n_registered", "n_images", "neighbour_deg_median", "neighbour_deg_max"]
    of_walk = rows[rows["mapper"] != ""].reindex(columns=[*STRUCTURE, *about, "volume_rms_cm"])
    solved = of_walk["volume_rms_cm"].notna().astype(float)
    found = of_walk.assign(solved_share=solved).groupby(STRUCTURE, as_index=False)
    found = found.agg({**dict.fromkeys(about, "first"), "solved_share": "max"})
    return found.assign(registered_share=found["n_registered"] / found["n_images"])


def against(rows: pd.DataFrame, reference: pd.DataFrame, on: list[str]) -> NDArray:
    """Return the paired differences of the volume error from a reference; NaN where one is missing.

    Both tables are of `tidy`. Columns `on` make a pair; at most one row of `reference` has the same
    values.
    """
    own, other = (table[[*on, "volume_rms_cm"]] for table in (rows, reference))
    both = own.merge(other, on=on, how="left", suffixes=("", "_known"), validate="many_to_one")
    return (both["volume_rms_cm"] - both["volume_rms_cm_known"]).to_numpy(dtype=float)


def upper_limit(trials: pd.DataFrame) -> float:
    """Return the 95 % upper confidence limit of a mean, one-sided, of trials of `bootstrap`."""
    return intervals.bootstrap(trials, np.nanmean, level=0.9)[1]


SEEDS = ["seed", "walk_seed"]  # sessions of one condition that differ in these only are pooled
METHOD = ["method", "mapper", "n_clicks", "in_sample", "click_strength"]
LABELS = ["session", "preset", "layout", "condition"]
# Columns of an evaluation table that are not settings of a session.
OTHERS = {
    *LABELS, *METHOD, *calibration.COLUMNS, "n_bridging", "offset", "draw", "n_registered",
    "n_images", "n_fixed_registered", "n_points3d", "reprojection_px", "tie_residual_px",
    "neighbour_deg_median", "neighbour_deg_max",
}  # fmt: skip


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Summarise trials.

    One row per session, method, mapper, clicks, in-sample or not, strength of click errors, and
    number of bridging images; and one for all sessions of a condition together if they differ in
    their seeds only (session: `all N`). Differences of the volume error are paired:
    `vs_reference_...` to `N_REFERENCE` images (same draw and offset), `vs_known_...` to calibration
    from all known points (same session, draw and choice of scored points). `rows` are of `tidy`.
    """
    usual = rows[rows["n_bridging"] == N_REFERENCE]
    to_reference = against(rows, usual, ["session", *METHOD, "offset", "draw"])
    known = rows[rows["method"] == "known"]
    most = known.groupby("session")["n_clicks"].transform("max")
    to_known = against(
        rows, known[known["n_clicks"] == most], ["session", "in_sample", "click_strength", "draw"]
    )
    rows = rows.assign(vs_reference=to_reference, vs_known=to_known)
    settings = [name for name in rows if name not in OTHERS | {"vs_reference", "vs_known"}]
    keys = [*LABELS, *settings, *METHOD, "n_bridging"]
    groups = [
        {**dict(zip(keys, key, strict=True)), **_row(group)}
        for key, group in rows.groupby(keys, dropna=False, sort=True)
    ]
    pooled = [key for key in keys if key not in ("session", *SEEDS)]
    for key, group in rows[rows["condition"] != ""].groupby(pooled, dropna=False, sort=True):
        count = group["session"].nunique()
        if count > 1:
            groups.append(
                {"session": f"all {count}", **dict(zip(pooled, key, strict=True)), **_row(group)}
            )
    return pd.DataFrame(groups)[list(groups[0])]


def _row(group: pd.DataFrame) -> dict:
    structures = structures_of(group)
    volume, xy = spread(group["volume_rms_cm"]), spread(group["xy_cm"])
    return {
        "n": int(volume["n"]),
        "n_failed": int(len(group) - volume["n"]),
        "n_structures": len(structures),
        "solved_share": structures["solved_share"].mean(),
        "registered_share": structures["registered_share"].mean(),
        "volume_rms_cm_median": volume["median"],
        "volume_rms_cm_p95": volume["p95"],
        "xy_cm_median": xy["median"],
        "xy_cm_p95": xy["p95"],
        "predicted_volume_cm_median": group["predicted_volume_cm"].median(),
        "coverage90": group["coverage90"].mean(),
        "squared_ratio_median": group["squared_ratio"].median(),
        **_differences(group, "vs_reference"),
        **_differences(group, "vs_known"),
    }


def _differences(group: pd.DataFrame, name: str) -> dict:
    hall = group["session"]
    if "seed" in group:  # walks through one hall share it; each other session is a hall
        hall = group["seed"].astype(object).where(group["seed"].notna(), hall)
    structure = group["session"] + " " + group["offset"].fillna(0).astype(str)
    trials = group.assign(hall=hall, structure=structure, value=group[name])
    found = spread(group[name])
    return {
        f"{name}_n": int(found["n"]),
        f"{name}_mean_cm": group[name].mean(),
        f"{name}_upper_cm": upper_limit(trials),
        f"{name}_p95_cm": found["p95"],
    }
