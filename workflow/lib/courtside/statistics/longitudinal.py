"""Changes of a measure from session to session, and the tables that hold it."""

from collections.abc import Mapping, Sequence
from statistics import NormalDist

import numpy as np
import pandas as pd
import scipy

from courtside.study.errors import InputError, StrPath

# What must not change unnoticed; the definition is checked beside them.
CONDITIONS = ("model", "calibration")
LEVEL = 0.95  # of detectable changes, as is usual
FACTOR = NormalDist().inv_cdf(0.5 + LEVEL / 2)  # of the smallest detectable change of single takes
REAL, WITHIN, UNTOLD, MIXED = "real", "within", "untold", "mixed"
VALUES = [
    "person", "measure", "unit", "session", "order", "model", "calibration", "definition",
    "n_takes", "takes", "value", "sd_takes",
]  # fmt: skip
CHANGES = [
    "measure", "unit", "session", "order", "against", "change", "detectable", "freedom", "verdict",
    "mixed",
]  # fmt: skip
NEEDED = ["person", "measure", "value", "unit"]
KEY = ["session", "take", "model", "calibration", "subject", "measure"]
# Ends of the names of measures that tell of frames and their noise, not of movement.
OF_THE_RECORD = (
    "_distance_measured", "_distance_in_gaps", "_noise_bias", "_noise_bias_most", "_noise_memory",
    "_noise_white_share", "_noise_scale",
)  # fmt: skip
COLUMNS = [
    "session", "take", "model", "calibration", "subject", "measure", "value", "sigma", "unit",
    "definition",
]  # fmt: skip


def of_subject(
    rows: pd.DataFrame,
    subject: str,
    measures: Sequence[str] | None = None,
    *,
    allow_mixed: bool = False,
) -> pd.DataFrame:
    """Return the rows of `read` of one subject, of all measures `of_movement` or those named.

    `allow_mixed` lets values of different networks or kinds of calibration, or of one measure
    defined differently, stand in one table: `changes` marks them. `InputError` if there is no such
    subject or measure, or values are mixed and may not be.
    """
    known = sorted(rows["subject"].unique())
    if subject not in known:
        raise InputError(
            f"subject {subject}: expected one of {known}, found none of that name; correct the name"
        )
    rows = rows[rows["subject"] == subject]
    missing = [name for name in measures or [] if name not in set(rows["measure"])]
    if missing:
        raise InputError(
            f"subject {subject}: expected values of {missing}, found "
            f"{sorted(rows['measure'].unique())}; choose some of these"
        )
    rows = rows[rows["measure"].isin(measures)] if measures else of_movement(rows)
    if not allow_mixed:
        _refuse_mixed(rows, subject)
    return rows


def of_movement(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows without measures that tell of the record, such as the noise of a path."""
    return rows[~rows["measure"].str.endswith(OF_THE_RECORD)]


def _refuse_mixed(rows: pd.DataFrame, subject: str) -> None:
    for name in CONDITIONS:
        if rows[name].nunique() > 1:
            found = rows.groupby(name, sort=True)["session"].unique()
            words = "; ".join(f"{value} in {', '.join(found[value])}" for value in found.index)
            raise InputError(
                f"subject {subject}: expected one {name} over all sessions, found {words}; measure "
                "all with one, or set allow_mixed to have them marked"
            )
    defined = rows.groupby("measure")["definition"].nunique()
    if (defined > 1).any():
        measure = defined.index[defined > 1][0]
        found = sorted(rows.loc[rows["measure"] == measure, "definition"].unique())
        raise InputError(
            f"subject {subject}: expected one definition of {measure}, found {found}; measure all "
            "sessions alike, or set allow_mixed to have them marked"
        )


def over_sessions(rows: pd.DataFrame) -> pd.DataFrame:
    """Average the takes of each session, from rows of `of_subject`.

    `VALUES`, one row per measure, session and way of measuring: mean over the takes and their
    standard deviation. `order` counts sessions as they come, `takes` are joined by +.
    """
    rows = rows.dropna(subset=["value"])
    order = list(dict.fromkeys(rows["session"]))
    keys = ["subject", "measure", "unit", "session", *CONDITIONS, "definition"]
    groups = rows.groupby(keys, sort=False)
    found = groups["value"].agg(n_takes="count", value="mean", sd_takes="std")
    found = found.assign(takes=groups["take"].agg("+".join)).reset_index()
    found = found.rename(columns={"subject": "person"})
    found["order"] = found["session"].map(order.index)
    names = list(dict.fromkeys(rows["measure"]))
    found["place"] = found["measure"].map(names.index)
    return found.sort_values(["place", "order"], kind="stable")[VALUES].reset_index(drop=True)


def errors_of_measurement(
    rows: pd.DataFrame, detectable: pd.DataFrame | None = None
) -> pd.DataFrame:
    """Return each measure's standard error of measurement: sem and freedom, by measure.

    From `detectable` where it has the measure, and else from the takes of `of_subject` within one
    session: NaN where there are none, or where they are all equal, as counts often are: how far
    others may lie from these is unknown, not 0. `detectable` (measure, detectable, freedom) holds
    smallest detectable changes of single takes from a study of repeats.
    """
    keys = ["measure", "session", *CONDITIONS, "definition"]
    own = rows.dropna(subset=["value"]).groupby(keys, sort=False)["value"]
    spread = own.agg(["count", "var"]).reset_index()
    spread["squares"] = (spread["var"] * (spread["count"] - 1)).fillna(0.0)
    spread["freedom"] = spread["count"] - 1
    pooled = spread.groupby("measure", sort=False)[["squares", "freedom"]].sum()
    with np.errstate(invalid="ignore"):
        found = pd.DataFrame({"sem": np.sqrt(pooled["squares"] / pooled["freedom"])})
    found["sem"] = found["sem"].where(found["sem"] > 0)
    found["freedom"] = pooled["freedom"].astype(int)
    if detectable is not None:
        known = detectable[detectable["detectable"] > 0].set_index("measure")
        for measure in found.index.intersection(known.index):
            row = known.loc[measure]
            sem = row["detectable"] / (FACTOR * np.sqrt(2))
            found.loc[measure] = [sem, int(row["freedom"])]
    return found


def changes(values: pd.DataFrame, errors: pd.DataFrame) -> pd.DataFrame:
    """Compare every session of `over_sessions` with the first one, by `errors_of_measurement`.

    `CHANGES`, one row per measure and later value. `detectable` is the smallest detectable change
    of means over so many takes, t SEM sqrt(1/n + 1/n'), with Student's t (1.96 for many degrees of
    freedom): 5 % of those who did not change exceed it. `verdict`: `real` beyond it, `within` it,
    `untold` without repeats or where they are all equal, `mixed` where the way of measuring
    changed, as `mixed` says: such a change may be the network's or the calibration's.

    Repeats within a session do not contain what differs between sessions only (a new calibration,
    another hall): the smallest detectable change is a lower bound then.
    """
    rows = []
    for measure, part in values.groupby("measure", sort=False):
        sem, freedom = errors.loc[measure, ["sem", "freedom"]]
        factor = scipy.special.stdtrit(freedom, 0.5 + LEVEL / 2) if freedom > 0 else np.nan
        first = part.iloc[0]
        for _, row in part.iloc[1:].iterrows():
            change = row["value"] - first["value"]
            detectable = factor * sem * np.sqrt(1 / first["n_takes"] + 1 / row["n_takes"])
            mixed = "; ".join(
                f"{name}: {first[name]} -> {row[name]}"
                for name in (*CONDITIONS, "definition")
                if first[name] != row[name]
            )
            where = [measure, *row[["unit", "session", "order"]], first["session"]]
            verdict = _verdict(change, detectable, mixed)
            rows.append((*where, change, detectable, int(freedom), verdict, mixed))
    return pd.DataFrame(rows, columns=CHANGES)


def _verdict(change: float, detectable: float, mixed: str) -> str:
    if mixed:
        return MIXED
    if not np.isfinite(detectable):
        return UNTOLD
    return REAL if abs(change) > detectable else WITHIN


def read(paths: Sequence[StrPath], labels: Sequence[Mapping[str, str]]) -> pd.DataFrame:
    """Read the summaries of takes into one table of `COLUMNS`; `subject` is the person's pseudonym.

    Each path is a CSV with a row for each person and measure: person, measure, value, unit; sigma
    and definition optional. Its labels: session, take, model, calibration. `InputError` if a column
    is missing or a value stands twice.
    """
    tables = []
    for path, label in zip(paths, labels, strict=True):
        table = pd.read_csv(path, dtype={"person": str, "unit": str, "definition": str})
        missing = [name for name in NEEDED if name not in table]
        if missing:
            raise InputError(
                f"{path}: expected the columns {NEEDED}, missing: {missing}; make the table again"
            )
        tables.append(labelled(table, label))
    rows = pd.concat(tables, ignore_index=True)
    return check_single(rows)


def of_study(table: pd.DataFrame, ways: Sequence[Mapping[str, str]]) -> pd.DataFrame:
    """Return the rows of the table of a study of some takes and ways of measuring, as `read` does.

    `ways` have session, take, calibration, fusion and model, alike in the table. An `InputError` if
    one of them is not in it.
    """
    parts = []
    for way in ways:
        rows = table[(table[list(way)] == pd.Series(way)).all(axis=1)]
        if rows.empty:
            raise InputError(
                f"table of the study: expected measures of {' '.join(way.values())}, found none; "
                "delete it and run the study again"
            )
        parts.append(labelled(rows, way))
    return check_single(pd.concat(parts, ignore_index=True))


def labelled(table: pd.DataFrame, label: Mapping[str, str]) -> pd.DataFrame:
    """Return the rows of one take as `COLUMNS`, with its labels; both arguments as for `read`."""
    rows = table.rename(columns={"person": "subject"}).assign(**label)
    rows = rows.reindex(columns=COLUMNS)
    rows["sigma"] = rows["sigma"].astype(float)
    for name in ("unit", "definition"):
        rows[name] = rows[name].astype(object).where(rows[name].notna(), "")
    return rows


def check_single(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows; raise `InputError` if a value stands twice."""
    twice = rows[rows.duplicated(KEY)]
    if len(twice):
        where = ", ".join(f"{name} {value}" for name, value in twice.iloc[0][KEY].items())
        raise InputError(
            f"measures: expected one value each, found two of {where}; name every take once"
        )
    return rows
