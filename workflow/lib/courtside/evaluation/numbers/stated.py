"""Numbers that no study makes: measured by hand or by a benchmark, or published by others."""

import math
from pathlib import Path

from courtside.evaluation.numbers.register import ORIGINS, STUDY, Number, Source
from courtside.study.errors import InputError

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
