"""All numbers of the documents: one function for each table of the register."""

import math
import re
from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path

from courtside.evaluation.numbers import (
    calibration,
    devices,
    document_tables,
    footage,
    networks,
    players,
    published,
    register,
    stated,
)
from courtside.evaluation.numbers.register import Number, Source
from courtside.evaluation.numbers.views import VIEWS
from courtside.study.errors import InputError, StrPath

REGISTER = "docs/numbers.csv"
PAGES = "docs/measured"  # the folder of documents
SUMMARY = "summary"  # the first table of the README
SUMMED_UP = {  # what was measured: table, regular expression of its row, what is shown of it
    "cameras from a walk and 18 clicks, six virtual halls: RMS error of 3D points over the court, "
    "up to 3 m high": (
        "halls",
        "^all ",
        "{walk18} cm in the median hall, {walk18_worst} cm in the worst",
    ),
    "the same halls, with the court's painted lines too (other trials): RMS error in the median "
    "hall, in the worst, cm; points in their 90 % ellipsoids": (
        "walk-lines",
        "^the six halls",
        "{both} (without the lines: {clicks})",
    ),
    "joints of two virtual players, four cameras, corrected: median / 95 % of the errors": (
        "players-sessions",
        "^`players-b`",
        "{corrected_median} / {corrected_p95} mm in the median take, "
        "{corrected_median_worst} / {corrected_p95_worst} mm in the worst",
    ),
    "the same joints in their stated 90 % ellipsoids": (
        "held",
        "^joints, `players-b`$",
        "{corrected} % (of errors above 100 mm: {corrected_large} %)",
    ),
    "joints of one real player against a marker system, corrected: median / 90 %": (
        "footage",
        "^real, .* marker system's joints; cameras of the source",
        "{corrected_median} / {corrected_p90} mm",
    ),
    "joints of the real player in their stated 90 % ellipsoids": (
        "markers",
        "^all; cameras of the source",
        "{corrected_coverage_90} %",
    ),
    "knee flexion of the same virtual players: RMS error": (
        "angles",
        "^knee flexion, `players-b`$",
        "{corrected_rmse} degrees",
    ),
    "elbow flexion of the same virtual players: RMS error": (
        "angles",
        "^elbow flexion, `players-b`$",
        "{corrected_rmse} degrees",
    ),
}
MEASURED = (  # of the results of a default run
    calibration.calibrations,
    calibration.ways,
    calibration.growth,
    calibration.strengths,
    calibration.capture,
    players.sessions,
    players.takes,
    players.angles,
    players.measures,
    players.held,
    footage.corrections,
    footage.joints,
    footage.views,
    networks.virtual,
    published.walk,
    published.racket,
    published.round_trip,
    devices.sources,
    devices.body_frames,
)


def numbers(results: StrPath, repository: StrPath, made: Collection[str]) -> list[Number]:
    """Return all numbers, of the results of a full default run and of the repository's tables.

    Only the tables `made` by the default configuration are read (`study.targets.numbers.made`). An
    `InputError` names the first one that is missing.
    """
    source, documents = Source(results, made), Source(repository)
    if not source.folder.is_dir():
        raise InputError(f"{results}: expected a folder of results, found none; run snakemake")
    found = [number for table in MEASURED for number in table(source)]
    found += [*published.table_1(documents), *stated.numbers(documents)]
    return [*found, *summary(found)]


def kept(repository: StrPath) -> list[Number]:
    """Return all numbers as the repository keeps them: register, stated ones, and the summary."""
    found = [*register.read(Path(repository) / REGISTER), *stated.numbers(Source(repository))]
    return [*found, *summary(found)]


def summary(others: Sequence[Number]) -> list[Number]:
    """Return the numbers of the summary; an `InputError` where the other tables lack one.

    Each joins the parts of one row as text; its source and selector are those of the first part.
    """
    found = []
    for label, (table, row, pattern) in SUMMED_UP.items():
        parts = {n.part: n for n in others if n.table == table and re.search(row, n.row)}
        named = [part for part, _ in document_tables.FIELD.findall(pattern)]
        if missing := [part for part in named if part not in parts]:
            raise InputError(
                f"register: expected {missing[0]} in the row {row!r} of the table {table}, found "
                "none; run docs/make_tables.py"
            )
        text, first = document_tables.cell(pattern, label, parts), parts[named[0]]
        shown = replace(first, table=SUMMARY, row=label, part="error", printed=text)
        found.append(replace(shown, value=math.nan, unit=""))
    return found


def write(numbers_: list[Number], repository: StrPath) -> list[str]:
    """Write the register and the tables of the documents; return the files that changed.

    The register keeps what is neither stated nor in the summary: each number stands in one file.
    """
    changed = []
    path = Path(repository) / REGISTER
    before = path.read_text(encoding="utf-8") if path.is_file() else ""
    measured = [one for one in numbers_ if one.table != SUMMARY]
    register.write(path, [one for one in measured if not one.source.startswith(stated.FOLDER)])
    changed += [REGISTER] if path.read_text(encoding="utf-8") != before else []
    for name, text in filled(kept(repository), repository).items():
        document = Path(repository) / name
        if document.read_text(encoding="utf-8") != text:
            document.write_text(text, encoding="utf-8", newline="\n")
            changed.append(name)
    return changed


def documents(repository: StrPath) -> list[str]:
    """Return the paths of the documents with tables, within the repository."""
    pages = sorted((Path(repository) / PAGES).glob("*.md"))
    return ["README.md", *(f"{PAGES}/{page.name}" for page in pages)]


def filled(numbers_: list[Number], repository: StrPath) -> dict[str, str]:
    """Return the documents with their tables of these numbers, by the documents' names."""
    names = documents(repository)
    texts = {name: (Path(repository) / name).read_text(encoding="utf-8") for name in names}
    return {name: document_tables.fill(text, VIEWS, numbers_) for name, text in texts.items()}


def report(results: StrPath, repository: StrPath, made: Collection[str]) -> list[str]:
    """Return a line for every number of the register that these results do not give any more."""
    return register.stale(kept(repository), numbers(results, repository, made))
