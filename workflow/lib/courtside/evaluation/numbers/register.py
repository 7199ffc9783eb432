"""Numbers of the documents, where each comes from, and the register (CSV) that keeps them."""

import csv
import hashlib
import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

import pandas as pd

from courtside.study.errors import DAMAGED, InputError, StrPath
from courtside.study.execution import files

STUDY, BENCHMARK, BY_HAND, PUBLISHED = "study", "benchmark", "by hand", "published"
ORIGINS = (STUDY, BENCHMARK, BY_HAND, PUBLISHED)
MISSING = "-"  # printed where there is no value
Parts: TypeAlias = Mapping[str, tuple[str, int, str]]  # column, decimals and unit of each part
KEPT = 8  # digits of an exact value
DIGITS = 16  # of a checksum


@dataclass(frozen=True)
class Number:
    """A number of a table: its place there, how it is printed, and what it rests on."""

    table: str
    row: str  # as the table labels it
    part: str  # what it is, unique within the row
    printed: str
    value: float  # NaN: a text, or no value
    unit: str
    source: str  # file below the results, or of the repository
    selector: str  # its rows and column there
    sessions: str
    n: int | None  # values that it is of; None: does not apply
    n_failed: int | None  # trials without a value
    origin: str  # one of `ORIGINS`
    command: str  # that measured a number by hand; where a published one stands
    sha256: str  # of the source, its first digits

    @property
    def name(self) -> str:
        """Return the name that is unique in the register."""
        return "/".join(getattr(self, key) for key in NAMED)


NAMED = ("table", "part", "row")  # make the name, in this order; a row may hold a slash
COLUMNS = ["name", *(field.name for field in fields(Number) if field.name not in NAMED)]


def write(path: StrPath, numbers: Sequence[Number]) -> None:
    """Write a register; an `InputError` where two numbers have one name."""
    names = [number.name for number in numbers]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise InputError(f"{path}: two numbers are called {twice[0]}; name one of them otherwise")
    with Path(path).open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(COLUMNS)
        for number in numbers:
            values = (getattr(number, column) for column in COLUMNS)
            table.writerow([_text(value) for value in values])


def _text(value: object) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return f"{value:.{KEPT}g}" if isinstance(value, float) else str(value)


def read(path: StrPath) -> list[Number]:
    """Read a register; an `InputError` where it is damaged."""
    try:
        with Path(path).open(newline="", encoding="utf-8") as stream:
            return [_number(row) for row in csv.DictReader(stream)]
    except DAMAGED as error:
        raise InputError(
            f"{path}: expected a register of numbers, found {error}; run docs/make_tables.py"
        ) from error


def _number(row: dict[str, str]) -> Number:
    counts = {name: int(row[name]) if row[name] else None for name in ("n", "n_failed")}
    value = float(row["value"]) if row["value"] else math.nan
    texts = {key: row[key] for key in COLUMNS if key not in ("name", "value", *counts)}
    texts |= dict(zip(NAMED, row["name"].split("/", 2), strict=True))
    return Number(**texts, value=value, n=counts["n"], n_failed=counts["n_failed"])


class Source:
    """A folder whose tables numbers are taken from; each is read once.

    `made` are the files of the folder that count, by default all: others are of an older run. A
    file that is missing is an `InputError` that names it.
    """

    def __init__(self, folder: StrPath, made: Collection[str] | None = None) -> None:
        self.folder = Path(folder)
        self.made = made
        self.table = cache(self._table)
        self.sha256 = cache(self._sha256)

    def _sha256(self, pattern: str) -> str:
        """Return the first digits of the checksum of a file, or of all that fit a pattern."""
        each = [files.sha256(self.folder / name) for name in self._matching(pattern)]
        whole = each[0] if len(each) == 1 else hashlib.sha256("".join(each).encode()).hexdigest()
        return whole[:DIGITS]

    def texts(self, name: str) -> pd.DataFrame:
        """Return a table as it is written: all cells are text, empty where nothing stands."""
        return self._table(name, dtype=str, keep_default_na=False)

    def _table(self, name: str, **how: Any) -> pd.DataFrame:
        path = self.folder / name
        if not path.is_file() or not self._counts(name):
            raise InputError(
                f"{path}: expected this table of a full default run, found none; run snakemake"
            )
        try:
            return pd.read_csv(path, **how)
        except DAMAGED as error:
            raise InputError(f"{path}: expected a table, found {error}; delete it") from error

    def names(self, pattern: str) -> list[str]:
        """Return the files that fit a pattern, sorted; an `InputError` where none does."""
        found = self._matching(pattern)
        if not found:
            raise InputError(
                f"{self.folder / pattern}: expected tables of a full default run, found none; run "
                "snakemake"
            )
        return found

    def _matching(self, pattern: str) -> list[str]:
        there = sorted(p.relative_to(self.folder).as_posix() for p in self.folder.glob(pattern))
        return [name for name in there if self._counts(name)]

    def _counts(self, name: str) -> bool:
        return self.made is None or name in self.made


@dataclass(frozen=True)
class Cut:
    """Where numbers are taken from: a source, its file, the rows, and the sessions they are of."""

    source: Source
    file: str
    rows: str
    sessions: str


class Builder:
    """Collects the numbers of one table."""

    def __init__(self, table: str) -> None:
        self.table = table
        self.numbers: list[Number] = []

    def add(
        self,
        row: str,
        part: str,
        value: float,
        cut: Cut,
        column: str,
        *,
        decimals: int = 2,
        unit: str = "",
        n: float | None = None,
        n_failed: float | None = None,
        origin: str = STUDY,
    ) -> None:
        """Add a number: the value of a column in some rows of a source."""
        value = math.nan if value is None else float(value)
        self.numbers.append(
            Number(
                table=self.table,
                row=row,
                part=part,
                printed=printed(value, decimals),
                value=value,
                unit=unit,
                source=cut.file,
                selector=f"{cut.rows}; {column}",
                sessions=cut.sessions,
                n=None if n is None or math.isnan(n) else int(n),
                n_failed=None if n_failed is None or math.isnan(n_failed) else int(n_failed),
                origin=origin,
                command="",
                sha256=cut.source.sha256(cut.file),
            )
        )

    def add_columns(
        self, row: str, values: pd.Series, parts: Parts, cut: Cut, **counts: Any
    ) -> None:
        """Add the columns of one row of a source; `counts` are `n` and `n_failed` of them all."""
        for part, (column, decimals, unit) in parts.items():
            how: dict[str, Any] = {"decimals": decimals, "unit": unit, **counts}
            self.add(row, part, values[column], cut, column, **how)


def listed(cut: Cut, table: str, rows: Mapping[str, pd.Series], parts: Parts) -> list[Number]:
    """Return the numbers of a summary table: `rows` by their labels, all of one source.

    n and n_failed are those of the row, where it has them.
    """
    build = Builder(table)
    for label, row in rows.items():
        counts = {key: row[key] for key in ("n", "n_failed") if key in row}
        own = replace(cut, rows=f"{cut.rows}; {label}")
        build.add_columns(label, row, parts, own, **counts)
    return build.numbers


def printed(value: float, decimals: int) -> str:
    """Return a value as the tables show it: rounded, never minus nothing; `-` where unknown."""
    if math.isnan(value):
        return MISSING
    text = f"{value:.{decimals}f}"
    return text.removeprefix("-") if float(text) == 0 else text


def stale(kept: Iterable[Number], now: Iterable[Number]) -> list[str]:
    """Return a line for every number of a register that would be otherwise: what it would be."""
    old, new = ({number.name: number for number in some} for some in (kept, now))
    lines = []
    for name in [*old, *(name for name in new if name not in old)]:
        before = old[name].printed if name in old else "not in the register"
        after = new[name].printed if name in new else "no longer measured"
        if before != after:
            lines.append(f"{name}: printed {before}, would be {after}")
    return lines
