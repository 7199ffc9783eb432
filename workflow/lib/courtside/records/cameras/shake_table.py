"""The table of a fixed camera's shake: where its static picture lies in every frame of a take."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pandas as pd

from courtside.records import tables
from courtside.study.errors import StrPath

# ASSUME: rounding to these places stays far below the measurement noise of each column.
DECIMALS = {
    "frame_idx": 0,
    "time_s": 6,
    "shift_x_px": 4,
    "shift_y_px": 4,
    "rotation_deg": 5,
    "zoom_percent": 4,
    "n_matches": 0,
    "sigma_px": 4,
}
MEASURED = ("shift_x_px", "shift_y_px", "rotation_deg", "zoom_percent", "sigma_px")


def write(path: StrPath, table: pd.DataFrame) -> None:
    """Write a shake table as CSV; a `ValueError` if it does not meet this description.

    One row per frame: `frame_idx` (of the file), `time_s` (on the camera's own clock), `shift_x_px`
    and `shift_y_px` (of the content at the centre of the static picture: right, down),
    `rotation_deg` (of the content about the centre, clockwise as seen), `zoom_percent` (its
    growth), `n_matches` (background corners that agree), `sigma_px` (standard deviation of the
    shift, per axis). Where too few corners agree, all but index, time and number are NaN.
    """
    fault = _fault(table)
    if fault:
        raise ValueError(f"{path}: {fault}")
    table = table.loc[:, list(DECIMALS)].round(DECIMALS)
    table[list(MEASURED)] += 0.0  # no minus before a zero
    tables.write(path, table, float_format=None)


def read(path: StrPath) -> pd.DataFrame:
    """Read a table as `write` describes it; raise `InputError` if the file is no such table."""
    table = tables.read(path, "a table of shake", _fault)
    return table.loc[:, list(DECIMALS)].astype(dict.fromkeys(("time_s", *MEASURED), float))


def read_all(paths: Iterable[StrPath]) -> dict[str, pd.DataFrame]:
    """Read the tables of cameras, by their names: those of the files."""
    return {Path(path).stem: read(path) for path in paths}


def _fault(table: pd.DataFrame) -> str:
    """Return in a few words what is wrong with a table; empty if nothing is."""
    if fault := tables.column_fault(table, DECIMALS, DECIMALS):
        return fault
    if not len(table):
        return "found no frame"
    if not (np.diff(table["frame_idx"]) > 0).all() or not (np.diff(table["time_s"]) > 0).all():
        return "found frames that are not in order"
    values = table[list(MEASURED)].to_numpy(float)
    known = np.isfinite(values)
    if np.isinf(values).any() or (known.any(axis=1) != known.all(axis=1)).any():
        return "found a frame that is measured only in part"
    if (table["sigma_px"] < 0).any() or not (table["n_matches"] >= 0).all():
        return "found sigma_px or n_matches below 0"
    return ""
