"""Write and read the CSV tables of the study: whole files, labels first, 6 significant digits."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from courtside.study.errors import InputError, StrPath, reading
from courtside.study.execution.files import atomic

REMAKE = "delete it and run the study again"
# Columns of names, which are texts even where all of them are digits.
LABELS = ("person", "opponent", "camera", "take", "session", "foot", "source")
DIGITS = 6  # significant, of a number that is not whole
# At least, of a time in seconds and a place in metres: epoch times and coordinates of a survey have
# up to 10 digits before the point.
DECIMALS = 4
RATES = ("_m_s", "_deg_s")  # ends of columns of speeds, which are no times
PLACE = re.compile(r"(^|_)([xyz]|height)_m$")  # columns of places


def column_fault(table: pd.DataFrame, columns: Iterable[str], numbers: Iterable[str]) -> str:
    """Say in a few words which column is missing or no number; nothing if all are as expected."""
    missing = [name for name in columns if name not in table.columns]
    if missing:
        return f"found no column {', '.join(missing)}"
    words = [name for name in numbers if not pd.api.types.is_numeric_dtype(table[name])]
    return f"found {words[0]} that is not a number" if len(table) and words else ""


def write(
    path: StrPath,
    rows: pd.DataFrame,
    labels: Mapping[str, Any] | None = None,
    float_format: str | None = f"%.{DIGITS}g",
    about: str | None = None,
) -> None:
    """Write a table as CSV, whole or not at all.

    `labels` are columns put before the others, the same in every row: session, take, how it was
    measured. `float_format` is that of every number that is not whole, None for the shortest exact
    form; by default, times (columns `*_s`) and places (`*x_m`) have at least `DECIMALS` decimals.
    `about` is a comment for the first line.
    """
    labels = labels or {}
    rows = rows.assign(**labels)
    if float_format == f"%.{DIGITS}g":
        rows = rows.assign(**_long(rows))
    rows = labels_first(rows, labels)
    with (
        atomic(path) as temporary,
        Path(temporary).open("w", encoding="utf-8", newline="\n") as file,
    ):
        if about:
            file.write(f"# {about}\n")
        rows.to_csv(file, index=False, float_format=float_format, lineterminator="\n")


def joined(parts: Iterable[pd.DataFrame], labels: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Return parts one below the other, each with its own `labels` in the first columns."""
    each = [part.assign(**about) for part, about in zip(parts, labels, strict=True)]
    return labels_first(pd.concat(each, ignore_index=True), labels[0])


def labels_first(rows: pd.DataFrame, labels: Iterable[str]) -> pd.DataFrame:
    """Return a table with the columns `labels` before the others."""
    labels = list(labels)
    return rows[[*labels, *(name for name in rows.columns if name not in labels)]]


def _long(rows: pd.DataFrame) -> dict[str, pd.Series]:
    """Return the columns of times and places with over 2 digits before the point, as texts."""
    return {
        name: rows[name].map(_text, na_action="ignore")
        for name in rows.select_dtypes("floating")
        if ((name.endswith("_s") and not name.endswith(RATES)) or PLACE.search(name))
        and np.abs(rows[name]).max() >= 100
    }


def _text(number: float) -> str:
    whole = f"{abs(number) // 1:.0f}"
    return f"{number:.{max(DIGITS, len(whole) + DECIMALS)}g}"


def read(
    path: StrPath,
    what: str,
    fault_of: Callable[[pd.DataFrame], str] = lambda table: "",
    **options: Any,
) -> pd.DataFrame:
    """Read a CSV table that another rule wrote, with options of `pandas.read_csv`.

    `what` names the table with its article: "a frame table". `fault_of` takes the table and returns
    in a few words what is wrong with it, empty if nothing is; without it, all is well. Columns of
    `LABELS` are texts, NaN where empty, unless a `dtype` is among the options. An `InputError` if
    the file is missing or no such table.
    """
    options.setdefault("dtype", dict.fromkeys(LABELS, str))
    with reading(path, what, REMAKE):
        table = pd.read_csv(path, **options)
        fault = fault_of(table)
    if fault:
        raise InputError(f"{path}: expected {what}, {fault}; {REMAKE}")
    return table
