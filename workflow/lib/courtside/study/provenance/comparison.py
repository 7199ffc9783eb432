"""Two results trees file by file: bit-equal, equal within a stated tolerance, or different."""

import csv
import fnmatch
import json
import math
import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from courtside.study.errors import DAMAGED, StrPath
from courtside.study.execution import files

# Not compared: logs, run times, records of runs.
LEFT_OUT = {"logs", "benchmarks", "run", ".snakemake"}
# First match wins: pattern of the path below results/, relative and absolute tolerance, why. The
# absolute one is in the file's own unit: px of 2D keypoints, m of 3D ones and of cameras, cm of
# most errors.
TOLERANCES = (
    ("external/*", 0.0, 0.0, "pinned by checksum"),
    ("networks/*", 0.0, 0.0, "the same weights in the same order"),
    ("virtual/*.csv", 1e-6, 1e-6, "drawn from seeds; the last digit of sines differs"),
    ("virtual/*.npz", 1e-6, 1e-6, "drawn from seeds; the last digit of sines differs"),
    ("*/pose2d*/*", 0.0, 0.05, "px and scores; sums of a network depend on the processor"),
    ("*/sfm/*", 1e-3, 1e-3, "sums of many threads; feature detection depends on the processor"),
    ("*/calibration/*", 1e-3, 1e-3, "about 1 cm and 2 mrad of a camera 10 m away, 0.1 % of px"),
    ("*/pose3d*/*.mot", 0.0, 0.5, "0.5 degrees, of which 0.01 rad are 2 mm at the end of a limb"),
    ("*/pose3d*/*", 0.0, 2e-3, "2 mm, of 0.05 px and of the cameras"),
    ("*/evaluation/*", 2e-2, 2e-2, "errors are differences: 0.2 mm, or 2 %"),
    ("*/figures/*", 2e-2, 2e-2, "the numbers drawn, as in evaluations"),
    ("figures/*", 2e-2, 2e-2, "likewise, of all sessions"),
    ("*/sync/*", 2e-2, 2e-3, "2 ms, or 2 mm of a wrist, of 0.05 px"),
    ("*/people/*", 0.0, 2e-3, "2 mm of a place, of 0.05 px and of the cameras"),
    ("*/body/*", 2e-2, 2e-3, "2 mm of a joint, and lengths of paths"),
    ("*/motion/*.npz", 0.0, 1e-2, "0.01 rad: 2 mm at the ends of a limb of 0.25 m"),
    ("*/motion/*", 0.0, 0.5, "0.5 degrees, likewise"),
    ("*/views/*", 2e-2, 2e-2, "distances between skeletons, as in evaluations"),
    ("*/kinematics/*", 2e-2, 2e-2, "derivatives of positions"),
    ("*/strokes/*", 2e-2, 2e-2, "times of strokes depend on derivatives of positions"),
    ("*/footwork/*", 2e-2, 2e-2, "times of contacts depend on derivatives of positions"),
    ("*", 1e-4, 1e-4, "all others: the last digit that tables keep"),
)
# Drawings and binary exports whose numbers are in the table beside them.
TABLED = {".pdf", ".png", ".c3d"}
# Files that the processor's last digit changes as a whole, and whose numbers are also in files that
# are compared: films and the pictures that they begin with, recordings (keypoints), COLMAP's
# databases and models (ties, summaries), pages (tables), animations (BVH).
UNREAD = ("*.mp4", "virtual/*/backdrops.npz", "*.bag", "*.db", "*.bin", "*.html", "*.glb")
# These hold computing times, which differ from run to run; the report shows those figures.
TIMED = ("*/figures/growth.*", "report.html")
EQUAL, CLOSE, DIFFERENT, TIMES = "bit-equal", "within tolerance", "different", "holds run times"
OTHER_BYTES, ONLY_HERE, ONLY_THERE = "other bytes", "only here", "only there"
NUMBERS = set("iuf")  # kinds of NumPy
FAULTS = (DIFFERENT, ONLY_HERE, ONLY_THERE)


@dataclass(frozen=True)
class Verdict:
    """How a file compares with its twin."""

    name: str  # below the folder of results
    outcome: str
    largest: float = math.nan  # largest difference of numbers, NaN where there are none to compare


def compare(here: StrPath, there: StrPath) -> list[Verdict]:
    """Return the verdict on every file of two results trees, in the order of their names."""
    ours, theirs = names(here), names(there)
    verdicts = []
    for name in sorted(ours | theirs):
        if name not in ours or name not in theirs:
            verdicts.append(Verdict(name, ONLY_HERE if name in ours else ONLY_THERE))
        else:
            verdicts.append(verdict(name, Path(here) / name, Path(there) / name))
    return verdicts


def names(folder: StrPath) -> set[str]:
    """Return the relative paths of all files below results that a comparison looks at."""
    paths = (path.relative_to(folder) for path in Path(folder).rglob("*") if path.is_file())
    return {
        path.as_posix()
        for path in paths
        if not LEFT_OUT.intersection(path.parts) and path.name != ".snakemake_timestamp"
    }


def stated(name: str) -> tuple[str, float, float, str]:
    """Return the row of `TOLERANCES` of a file, by its name below the folder of results."""
    return next(row for row in TOLERANCES if fnmatch.fnmatch(name, row[0]))


def verdict(name: str, here: Path, there: Path) -> Verdict:
    """Return how one file compares with its twin; `name` below results decides the tolerance."""
    if here.stat().st_size == there.stat().st_size and files.sha256(here) == files.sha256(there):
        return Verdict(name, EQUAL)
    for patterns, outcome in ((TIMED, TIMES), (UNREAD, OTHER_BYTES)):
        if any(fnmatch.fnmatch(name, pattern) for pattern in patterns):
            return Verdict(name, outcome)
    if here.suffix in TABLED:
        return _of_drawing(name, here, there)
    parse = READERS.get(here.suffix)
    if parse is None:
        return Verdict(name, DIFFERENT)
    try:
        ours, theirs = parse(here), parse(there)
    except DAMAGED:
        return Verdict(name, DIFFERENT)
    if set(ours) != set(theirs):
        return Verdict(name, DIFFERENT)
    return _of_values(name, ours, theirs)


def _of_drawing(name: str, here: Path, there: Path) -> Verdict:
    """Return the verdict on the table beside a drawing; equal numbers should be drawn bit-equal."""
    tables = [path.with_suffix(".csv") for path in (here, there)]
    if not all(path.is_file() for path in tables):
        return Verdict(name, DIFFERENT)
    of_table = verdict(Path(name).with_suffix(".csv").as_posix(), *tables)
    outcome = CLOSE if of_table.outcome == CLOSE else DIFFERENT
    return Verdict(name, outcome, of_table.largest)


def _of_values(name: str, ours: dict[Any, Any], theirs: dict[Any, Any]) -> Verdict:
    _, rtol, atol, _ = stated(name)
    close, largest = True, math.nan
    for key, one in ours.items():
        one, other = np.asarray(one), np.asarray(theirs[key])
        if one.shape != other.shape:
            return Verdict(name, DIFFERENT)
        if not {one.dtype.kind, other.dtype.kind} <= NUMBERS:
            close = close and np.array_equal(one, other)
            continue
        close = close and bool(np.allclose(one, other, rtol, atol, equal_nan=True))
        gaps = np.abs(one.astype(float) - other.astype(float))
        gaps = gaps[np.isfinite(gaps)]
        largest = np.fmax(largest, gaps.max()) if gaps.size else largest
    return Verdict(name, CLOSE if close else DIFFERENT, float(largest))


def _from_npz(path: Path) -> dict[Any, Any]:
    with np.load(path, allow_pickle=False) as content:
        return {key: content[key] for key in content.files}


def _from_table(path: Path) -> dict[Any, Any]:
    """Return {(row, column): number or text}; an empty field is NaN, wherever it stands."""
    delimiter = "\t" if path.suffix == ".trc" else ","
    with path.open(encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream, delimiter=delimiter))
    return {(y, x): _value(word) for y, row in enumerate(rows) for x, word in enumerate(row)}


def _from_words(path: Path) -> dict[Any, Any]:
    """Return {place: number or text} of words and, of XML, of tags and what stands between them."""
    words = re.findall(r"[^\s<>]+", path.read_text(encoding="utf-8"))
    return {at: _value(word) for at, word in enumerate(words)}


def _value(word: str) -> float | str:
    try:
        return float(word) if word else math.nan
    except ValueError:
        return word


def _from_tree(content: Any, where: str = "") -> dict[Any, Any]:
    """Return {path of keys: leaf} of nested dictionaries and lists."""
    pairs: Iterable[tuple[Any, Any]]
    if isinstance(content, dict):
        pairs = content.items()
    elif isinstance(content, list):
        pairs = enumerate(content)
    else:
        return {where: math.nan if content is None else content}
    found = {where: type(content).__name__}
    for key, inner in pairs:
        found |= _from_tree(inner, f"{where}/{key}")
    return found


READERS = {
    ".npz": _from_npz,
    ".csv": _from_table,
    ".trc": _from_table,
    ".bvh": _from_words,
    ".mot": _from_words,
    ".osim": _from_words,
    ".txt": _from_words,
    ".json": lambda path: _from_tree(json.loads(path.read_text(encoding="utf-8"))),
    ".toml": lambda path: _from_tree(tomllib.loads(path.read_text(encoding="utf-8"))),
}


def table(verdicts: Iterable[Verdict]) -> list[str]:
    """Return lines for people: files by outcome for each stated tolerance, then each fault."""
    verdicts = list(verdicts)
    outcomes = [EQUAL, CLOSE, OTHER_BYTES, TIMES, DIFFERENT, ONLY_HERE, ONLY_THERE]
    rows = [["files", *outcomes, "largest difference", "tolerance", "because"]]
    for pattern, rtol, atol, why in TOLERANCES:
        group = [each for each in verdicts if stated(each.name)[0] == pattern]
        if group:
            counts = [str(sum(each.outcome == outcome for each in group)) for outcome in outcomes]
            largest = np.fmax.reduce([each.largest for each in group])
            gap = "" if math.isnan(largest) else f"{largest:.3g}"
            allowed = [f"{atol:g}"] * bool(atol) + [f"{rtol:g} of the value"] * bool(rtol)
            rows.append([pattern, *counts, gap, " + ".join(allowed) or "none", why])
    lines = aligned(rows)
    for each in (each for each in verdicts if each.outcome in FAULTS):
        gap = "" if math.isnan(each.largest) else f" by up to {each.largest:.3g}"
        lines.append(f"{each.name}: {each.outcome}{gap}")
    return lines


def aligned(rows: list[list[str]]) -> list[str]:
    """Return lines of cells, each column as wide as its longest cell."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    pairs = [zip(row, widths, strict=True) for row in rows]
    return ["  ".join(cell.ljust(width) for cell, width in row).rstrip() for row in pairs]
