"""Where a user says that a person is: `seen` of a session's file, and rows of people.csv."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from courtside.records.user_tables import known, number, table
from courtside.study.errors import InputError, StrPath

COLUMNS = ("take", "subject", "camera", "time_s", "x_px", "y_px")
BOUNDS = ("from_s", "to_s")  # may be left out, as columns or as cells


@dataclass(frozen=True)
class Sighting:
    """A person at a pixel of one camera; times are seconds of this camera's video."""

    subject: str
    camera: str
    time_s: float
    xy: tuple[float, float]  # px of the video, first pixel centre at (0, 0)
    where: str  # what stated it, for messages
    # The part of the take that this holds for; None: as far as nothing else is stated
    from_s: float | None = None
    to_s: float | None = None


def stated(where: str, subject: str, content: Mapping[str, Any]) -> Sighting:
    """Return what an entry of `seen` says, which the session's schema has checked."""
    x, y = content["at_px"]
    return Sighting(subject, content["camera"], float(content["time_s"]), (x, y), where)


def read(
    path: StrPath, take: str, subjects: Sequence[str], cameras: Sequence[str]
) -> list[Sighting]:
    """Read the rows of one take.

    The CSV has the columns take, subject, camera, time_s, x_px, y_px, and may have from_s, to_s.
    An `InputError` if it is no such table, or a row of the take names an unknown subject or camera
    or holds no number.
    """
    found = []
    for line, row in table(path, COLUMNS, BOUNDS):
        if row["take"] != take:
            continue
        where = f"{path}: line {line}"
        subject = known(where, "subject", row["subject"], subjects)
        camera = known(where, "camera", row["camera"], cameras)
        time_s, x, y = (number(where, key, row[key]) for key in COLUMNS[3:])
        start_s, stop_s = (number(where, key, row[key]) if row.get(key) else None for key in BOUNDS)
        if start_s is not None and stop_s is not None and start_s >= stop_s:
            raise InputError(
                f"{where}: expected from_s before to_s, found {start_s} and {stop_s}; correct them"
            )
        low_s = -math.inf if start_s is None else start_s
        if not low_s <= time_s <= (math.inf if stop_s is None else stop_s):
            raise InputError(
                f"{where}: expected time_s from from_s to to_s, found {time_s}; correct it"
            )
        found.append(Sighting(subject, camera, time_s, (x, y), where, start_s, stop_s))
    return found


def every_row(path: StrPath, takes: Collection[str]) -> list[list[str]]:
    """Return the rows of all takes as they are, cells in the order of all columns.

    An `InputError` if one names a take that is not among `takes`.
    """
    order, found = (*COLUMNS, *BOUNDS), []
    for line, row in table(path, COLUMNS, BOUNDS):
        known(f"{path}: line {line}", "take", row["take"], takes)
        found.append([row.get(key, "") for key in order])
    return found
