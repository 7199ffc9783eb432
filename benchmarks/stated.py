"""Rows of `docs/numbers/`, which `courtside.evaluation.numbers.stated` reads: joined, written."""

import csv
import sys
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.evaluation.numbers import stated
from courtside.study.errors import StrPath
from courtside.study.execution.files import atomic

FOLDER = stated.FOLDER


def joined(rows: Iterable[Sequence[object]]) -> list[list[object]]:
    """Join rows of one table, label and first word of the part: `alone`, `alone_shape` to one."""
    found: dict[tuple, list[object]] = {}
    for row in rows:
        key = (row[0], row[1], str(row[2]).partition("_")[0])
        if key in found:
            found[key][3] = f"{found[key][3]}; {row[3]}"
        else:
            found[key] = [*row[:2], key[2], *row[3:]]
    return list(found.values())


def write(path: StrPath, rows: Iterable[Sequence[object]]) -> None:
    """Write the table of one command; each row has values of `stated.COLUMNS` and the command."""
    with atomic(path) as new, new.open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow([*stated.COLUMNS, "command"])
        table.writerows(rows)


def of_other_sessions(path: StrPath, sessions: Collection[str]) -> list[list[str]]:
    """Return the rows of a table whose sessions are not among these: a new run may keep them."""
    if not Path(path).is_file():
        return []
    with Path(path).open(newline="", encoding="utf-8") as stream:
        before = list(csv.DictReader(stream))
    return [list(row.values()) for row in before if row["sessions"] not in sessions]
