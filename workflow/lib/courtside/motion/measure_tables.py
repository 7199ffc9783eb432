"""Measures of many takes in one long table, each value with where it comes from."""

import numpy as np
import pandas as pd

from courtside.study.errors import InputError

LABELS = ["session", "take", "model", "calibration"]
NEEDED = ["person", "measure", "value", "unit"]
COLUMNS = [
    "session", "date", "take", "model", "calibration", "subject", "measure", "value", "sigma", "unit",
    "definition",
]  # fmt: skip
KEY = ["session", "take", "model", "calibration", "subject", "measure"]
HIPS = ("left_hip", "right_hip")


def read(paths, labels):
    """Read the summaries of takes into one table.

    Parameters
    ----------
    paths : sequence of str or Path
        CSV with a row for each person and measure: person, measure, value, unit; sigma and definition where
        there are such.
    labels : sequence of dict, one for each path
        session, take, model, calibration; date (year-month-day) where known.

    Returns
    -------
    rows : pandas.DataFrame
        `COLUMNS`; `subject` is the person's pseudonym.

    Raises
    ------
    InputError
        If a column is missing or a value stands twice.
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


def labelled(table, label):
    """Return rows of one take with its labels, in the columns of `COLUMNS`.

    Parameters
    ----------
    table : pandas.DataFrame
        person, measure, value, unit; sigma and definition where there are such.
    label : dict
        As for `read`.
    """
    rows = table.rename(columns={"person": "subject"}).assign(**label)
    rows = rows.reindex(columns=COLUMNS)
    rows["sigma"] = rows["sigma"].astype(float)
    for name in ("date", "unit", "definition"):
        rows[name] = rows[name].astype(object).where(rows[name].notna(), "")
    return rows


def check_single(rows):
    """Return the rows; raise `InputError` if a value stands twice."""
    twice = rows[rows.duplicated(KEY)]
    if len(twice):
        where = ", ".join(f"{name} {value}" for name, value in twice.iloc[0][KEY].items())
        raise InputError(
            f"measures: expected one value each, found two of {where}; name every take once"
        )
    return rows


def of_joints(points, label):
    """Measure every joint of a take in ways that do not depend on where somebody stands or faces.

    Parameters
    ----------
    points : Keypoints3D
        Filtered: noise lengthens a path.
    label : dict
        As for `read`, without model.

    Returns
    -------
    rows : pandas.DataFrame
        `COLUMNS`: mean height above the floor (mm), mean speed (m/s, between neighbouring frames), and mean
        distance to the middle of the hips (mm), over the frames that have them.
    """
    names = list(map(str, points.joints))
    middle = points.xyz[:, :, [names.index(hip) for hip in HIPS]].mean(axis=2, keepdims=True)
    step_m = np.linalg.norm(np.diff(points.xyz, axis=1), axis=-1)
    found = {
        ("height", "mm"): 1000 * points.xyz[..., 2],
        ("speed", "m/s"): step_m / np.diff(points.time_s)[:, None],
        ("reach", "mm"): 1000 * np.linalg.norm(points.xyz - middle, axis=-1),
    }
    rows = [
        (str(person), f"{joint}_{what}_mean", _mean(values[at, :, place]), unit)
        for at, person in enumerate(points.person_id)
        for place, joint in enumerate(names)
        for (what, unit), values in found.items()
    ]
    table = pd.DataFrame(rows, columns=["person", "measure", "value", "unit"])
    return labelled(table, {**label, "model": points.model})


def _mean(values):
    known = values[np.isfinite(values)]
    return known.mean() if len(known) else np.nan
