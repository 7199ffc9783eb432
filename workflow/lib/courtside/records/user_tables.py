"""Read CSV tables that people write or change: every fault is told with its line."""

import csv
import math
import re
from collections.abc import Collection, Sequence
from pathlib import Path

from courtside.study.errors import InputError, StrPath, reading


def lines(path: StrPath, advice: str) -> list[tuple[int, list[str]]]:
    """Return (line number, cells) of every line of a CSV, cells stripped.

    The `advice` says what to do with a file that cannot be read.
    """
    kinds = (OSError, UnicodeDecodeError, csv.Error)
    with (
        reading(path, "a readable CSV file", advice, kinds=kinds),
        Path(path).open(newline="", encoding="utf-8-sig") as stream,
    ):
        cells = csv.reader(stream, strict=True)
        return [(cells.line_num, [cell.strip() for cell in row]) for row in cells]


def table(
    path: StrPath, columns: Sequence[str], more: Sequence[str] = ()
) -> list[tuple[int, dict[str, str]]]:
    """Return (line number, row) of every row of a CSV, cells stripped.

    The header has the `columns`, and perhaps `more`, in any order; an `InputError` otherwise. What
    spreadsheets add is left out: empty lines, and empty cells beyond the last name of a column.
    """
    rows = [one for one in lines(path, "save it again as CSV (UTF-8)") if any(one[1])]
    header = list(rows[0][1]) if rows else []
    while header and not header[-1]:
        header.pop()
    known = {*columns, *more}
    if len(set(header)) < len(header) or not set(columns) <= set(header) <= known:
        perhaps = f" and perhaps {','.join(more)}" if more else ""
        mend = "correct the first line"
        if len(header) == 1 and columns[0] in re.split(r"[;\t]", header[0]):
            mend = "save it with commas between the cells, and points in numbers"
        raise InputError(
            f"{path}: expected the columns {','.join(columns)}{perhaps} with commas between, found "
            f"{','.join(header)[:80] or 'an empty file'}; {mend}"
        )
    found, width = [], len(header)
    for line, row in rows[1:]:
        cells = row if any(row[width:]) else row[:width]
        if len(cells) != width:
            raise InputError(
                f"{path}: line {line}: expected {width} cells, found {len(cells)}; correct it"
            )
        found.append((line, dict(zip(header, cells, strict=True))))
    return found


def known(where: str, what: str, name: str, names: Collection[str]) -> str:
    """Return a name; an `InputError` if it is none of `names`."""
    if name not in names:
        raise InputError(
            f"{where}: expected a {what} of {', '.join(names)}, found {name[:40]!r}; correct it or "
            "delete the line"
        )
    return name


def number(
    where: str, key: str, text: str, only: float | None = None, wanted: str = "a finite number"
) -> float:
    """Return a cell as a number; an `InputError` if it is not finite, or not the `only` one."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or only not in (None, value):
        raise InputError(f"{where}: expected {key} as {wanted}, found {text[:40]!r}; correct it")
    return value
