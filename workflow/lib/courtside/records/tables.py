"""Writing and reading the CSV tables of the study: whole files, labels first, floats to 6 digits."""

from pathlib import Path

import pandas as pd

from courtside.study.errors import InputError, reading
from courtside.study.execution.files import atomic

REMAKE = "delete it and run the study again"


def write(path, rows, labels=None, float_format="%.6g", about=None):
    """Write a table as CSV, whole or not at all.

    Parameters
    ----------
    path : str or Path
    rows : pandas.DataFrame
    labels : dict of str to str or number, optional
        Columns put before the others, the same in every row: session, take, how it was measured.
    float_format : str
        Of every number that is not whole.
    about : str, optional
        A comment for the first line.
    """
    labels = labels or {}
    rows = rows.assign(**labels)
    columns = [*labels, *(name for name in rows.columns if name not in labels)]
    with atomic(path) as temporary, Path(temporary).open("w", encoding="utf-8") as file:
        if about:
            file.write(f"# {about}\n")
        rows[columns].to_csv(file, index=False, float_format=float_format, lineterminator="\n")


def read(path, what, fault_of, **options):
    """Read a CSV table that another rule wrote.

    Parameters
    ----------
    path : str or Path
    what : str
        What the table is, with its article: "a frame table".
    fault_of : callable
        Takes the table; says in a few words what is wrong with it, and nothing where it is right.
    **options
        Of `pandas.read_csv`.

    Returns
    -------
    table : pandas.DataFrame

    Raises
    ------
    InputError
        If the file is missing or no such table.
    """
    with reading(path, what, REMAKE):
        table = pd.read_csv(path, **options)
        fault = fault_of(table)
    if fault:
        raise InputError(f"{path}: expected {what}, {fault}; {REMAKE}")
    return table
