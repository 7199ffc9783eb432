"""The table of knocks that people show: two poses of a camera, before and after each."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from courtside.records import tables
from courtside.study.errors import StrPath

TURN = ("turn_x_deg", "turn_y_deg", "turn_z_deg")
SIGMA = ("sigma_x_deg", "sigma_y_deg", "sigma_z_deg")
COLUMNS = ("take", "camera", "time_s", *TURN, *SIGMA, "joints_percent", "joints", "taken", "after")


def write(path: StrPath, rows: Sequence[Mapping[str, Any]]) -> None:
    """Write knocks as CSV.

    `take`, `camera`, `time_s` (on the camera's own clock, of the first instant after it), a
    rotation vector from its axes before to those after (x right, y down, z forward) with standard
    deviations, `joints_percent` (change of how far held-out joints disagree), `joints` (better or
    not better by it), `taken` (1: the camera has two poses), `after` (the take after which the
    camera was turned, before this one began; empty for a knock during this take).
    """
    tables.write(path, pd.DataFrame(rows, columns=list(COLUMNS)), float_format="%.6f")


def read(path: StrPath, take: str, camera: str) -> list[tuple[float, np.ndarray]]:
    """Return a camera's knocks that were taken: time, s, and turn (3,), radians."""
    table = tables.read(path, "a table of knocks", _fault)
    table = table[(table["take"] == take) & (table["camera"] == camera) & (table["taken"] == 1)]
    turns = np.radians(table[list(TURN)].to_numpy(float))
    return list(zip(table["time_s"].astype(float), turns, strict=True))


def lines(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return what rows of knocks that are taken say, a line each, of takes in a row the first."""
    found, told = [], set()
    for row in (row for row in rows if row["taken"]):
        if row.get("after"):
            if (row["camera"], row["after"]) in told:
                continue
            told.add((row["camera"], row["after"]))
        turn, sigma = (
            np.linalg.norm([row[column] for column in columns]) for columns in (TURN, SIGMA)
        )
        where = f"knocked at {row['time_s']:.2f} s of take {row['take']}"
        if row.get("after"):
            where = f"turned between takes {row['after']} and {row['take']}"
        found.append(
            f"camera {row['camera']} was {where} by {turn:.2f} +- {sigma:.2f} deg: two poses, "
            "before and after, with which held-out joints disagree by "
            f"{-row['joints_percent']:.0f} % less"
        )
    return found


def _fault(table: pd.DataFrame) -> str:
    return tables.column_fault(table, COLUMNS, ("time_s", *TURN, *SIGMA, "taken"))
