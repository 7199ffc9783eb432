"""Numbers that no study makes: measured by hand or by a benchmark, or published by others."""

import csv
import math
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path

from courtside.evaluation.numbers.register import ORIGINS, STUDY, Number, Source
from courtside.study.errors import InputError, StrPath
from courtside.study.execution.files import atomic

FOLDER = "docs/numbers"  # of their tables, one for each command that writes one, and one by hand
COLUMNS = ("table", "row", "part", "printed", "unit", "sessions", "n", "n_failed", "origin")


def numbers(documents: Source) -> list[Number]:
    """Return the numbers of all tables, in the order of their files.

    `documents` is the repository. An `InputError` where a number says neither the command that
    measured it nor where it is published.
    """
    found = []
    for file in documents.names(f"{FOLDER}/*.csv"):
        rows = documents.texts(file)
        if missing := {*COLUMNS, "command"} - set(rows):
            raise InputError(f"{file}: expected columns {sorted(missing)}, found none; add them")
        found += [
            _number(documents, file, line, row)
            for line, row in enumerate(rows.to_dict("records"), start=2)
        ]
    return found


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
    """Write the table of one command; each row has the values of `COLUMNS`, then the command."""
    with atomic(path) as new, new.open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow([*COLUMNS, "command"])
        table.writerows(rows)


def of_other_sessions(path: StrPath, sessions: Collection[str]) -> list[list[str]]:
    """Return the rows of a table whose sessions are not among these: a new run may keep them."""
    if not Path(path).is_file():
        return []
    with Path(path).open(newline="", encoding="utf-8") as stream:
        before = list(csv.DictReader(stream))
    return [list(row.values()) for row in before if row["sessions"] not in sessions]


def _number(documents: Source, file: str, line: int, row: dict[str, str]) -> Number:
    if row["origin"] not in set(ORIGINS) - {STUDY} or not row["command"]:
        raise InputError(
            f"{file}, line {line}: expected an origin of {ORIGINS[1:]}, and the command or place "
            f"that a number comes from, found {row['origin']!r}, {row['command']!r}; state them"
        )
    counts = {key: int(float(row[key])) if row[key] else None for key in ("n", "n_failed")}
    return Number(
        **{key: row[key] for key in ("table", "row", "part", "printed", "unit", "sessions")},
        **{key: row[key] for key in ("origin", "command")},
        value=_value(row["printed"]),
        source=Path(file).as_posix(),
        selector=f"line {line}",
        n=counts["n"],
        n_failed=counts["n_failed"],
        sha256=documents.sha256(file),
    )


def _value(printed: str) -> float:
    try:
        return float(printed)
    except ValueError:
        return math.nan
