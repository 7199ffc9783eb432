"""Tables in Markdown documents, between markers, filled from a register of numbers.

A table stands between `<!-- table: NAME -->` and `<!-- end -->`. NAME is a view: the columns that
are shown of a table of the register.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from courtside.evaluation.numbers.register import MISSING, Number
from courtside.study.errors import InputError

BLOCK = re.compile(r"^<!-- table: ([\w-]+) -->\n(.*?)^<!-- end -->$", flags=re.M | re.S)
MARK = "<!-- table:"
FIELD = re.compile(r"\{(\w+)(?:\.(\w+))?\}")


@dataclass(frozen=True)
class View:
    """How a table of the register is shown.

    `columns` maps each heading to a pattern. In a pattern, `{row}` is the label of the row,
    `{part}` the printed number of that part, and `{part.n}` another of its columns in the register.
    A cell is empty if no part of its pattern is in the row.
    """

    table: str
    columns: Mapping[str, str]
    rows: str = ""  # regular expression of the labels that are shown; all if empty


def render(view: View, numbers: Sequence[Number]) -> str:
    """Return the lines of a view as Markdown; an `InputError` where the register has no row."""
    rows: dict[str, dict[str, Number]] = {}
    for number in numbers:
        if number.table == view.table and re.search(view.rows, number.row):
            rows.setdefault(number.row, {})[number.part] = number
    if not rows:
        raise InputError(
            f"register: expected rows {view.rows!r} of the table {view.table}, found none; run "
            "docs/make_tables.py"
        )
    known = {part for parts in rows.values() for part in parts}
    for pattern in view.columns.values():
        for part, _ in FIELD.findall(pattern):
            if part != "row" and part not in known:
                raise InputError(f"register: expected {part} in the table {view.table}, found none")
    lines = ["| " + " | ".join(view.columns) + " |", "|" + " --- |" * len(view.columns)]
    for label, parts in rows.items():
        cells = (cell(pattern, label, parts) for pattern in view.columns.values())
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(line.replace("|  |", "| |").replace("|  |", "| |") for line in lines) + "\n"


def cell(pattern: str, label: str, parts: Mapping[str, Number]) -> str:
    """Return a pattern filled with the label and the parts of a row; see `View`."""
    asked = [name for name, _ in FIELD.findall(pattern)]
    if asked and "row" not in asked and not any(name in parts for name in asked):
        return ""

    def fill(match: re.Match) -> str:
        name, column = match.groups()
        if name == "row":
            return label
        if name not in parts:
            return MISSING
        value = getattr(parts[name], column or "printed")
        return MISSING if value is None else str(value)

    return FIELD.sub(fill, pattern)


def names(text: str) -> list[str]:
    """Return the views that a document shows; an `InputError` where a marker is not closed."""
    found = [match.group(1) for match in BLOCK.finditer(text)]
    if len(found) != text.count(MARK):
        raise InputError(
            f"document: expected every {MARK} to be closed by <!-- end -->, found "
            f"{text.count(MARK)} markers and {len(found)} tables; close them"
        )
    return found


def fill(text: str, views: Mapping[str, View], numbers: Sequence[Number]) -> str:
    """Return a document with all its tables written anew."""
    for name in names(text):
        if name not in views:
            raise InputError(f"document: expected a known table, found {name}; correct its marker")

    def block(match: re.Match) -> str:
        name = match.group(1)
        return f"{MARK} {name} -->\n{render(views[name], numbers)}<!-- end -->"

    return BLOCK.sub(block, text)
