"""A table of checksums by stage; it shows the first stage at which two machines' results differ."""

import csv
import fnmatch
from pathlib import Path

from courtside.study.errors import InputError, StrPath, reading
from courtside.study.execution import files
from courtside.study.provenance import comparison

# In the order of computation. First match wins: pattern of the path below results/.
STAGES = (
    ("artefacts", "external/*"),
    ("networks", "networks/*"),
    ("truth and halls of simulations", "virtual/*.npz"),
    ("clicks of simulations", "virtual/*.csv"),
    ("films", "virtual/*.mp4"),
    ("other recordings", "virtual/*"),
    ("pictures of fixed cameras", "*/static/*"),
    ("pictures of walks", "*/frames/*"),
    ("features", "*/sfm/features.*"),
    ("matches", "*/sfm/matches.*"),
    ("mapping", "*/sfm/*.bin"),
    ("mapping", "*/sfm/*/summary.json"),
    ("adjustment", "*/sfm/*"),
    ("calibration", "*/calibration/*"),
    ("2D keypoints", "*/pose2d*/*"),
    ("device recordings", "*/devices/*"),
    ("clocks", "*/sync/*"),
    ("people", "*/people/*"),
    ("3D keypoints", "*/pose3d*"),
    ("evaluation", "*/evaluation/*"),
    ("all others", "*"),
)
Rows = dict[str, tuple[int, str]]  # size in bytes and SHA-256, by path below results
COLUMNS = ("stage", "name", "bytes", "sha256")
REMAKE = "make the table with --write-checksums"


def stage_of(name: str) -> str:
    """Return the stage that makes a file, by its path below results."""
    return next(stage for stage, pattern in STAGES if fnmatch.fnmatch(name, pattern))


def measure(results: StrPath) -> Rows:
    """Return size and SHA-256 of every file that `comparison` looks at, by path below results."""
    paths = {name: Path(results) / name for name in comparison.names(results)}
    return {name: (path.stat().st_size, files.sha256(path)) for name, path in paths.items()}


def write(path: StrPath, rows: Rows) -> None:
    """Write what `measure` found to a CSV file."""
    order = list(dict(STAGES))
    ranked = sorted(rows, key=lambda name: (order.index(stage_of(name)), name))
    with (
        files.atomic(path) as temporary,
        temporary.open("w", encoding="utf-8", newline="") as stream,
    ):
        writer = csv.writer(stream)
        writer.writerow(COLUMNS)
        writer.writerows([stage_of(name), name, *rows[name]] for name in ranked)


def read(path: StrPath) -> Rows:
    """Read what `write` wrote; an `InputError` says what is wrong with another file."""
    with reading(path, "a table of checksums", REMAKE):
        with Path(path).open(encoding="utf-8", newline="") as stream:
            rows = list(csv.reader(stream))
        if not rows or tuple(rows[0]) != COLUMNS or any(len(row) != len(COLUMNS) for row in rows):
            raise InputError(
                f"{path}: expected columns {', '.join(COLUMNS)}, found "
                f"{', '.join(rows[0] if rows else [])}; {REMAKE}"
            )
        return {name: (int(size), digest) for _, name, size, digest in rows[1:]}


def table(here: Rows, there: Rows) -> tuple[list[str], int]:
    """Return lines for people, and the number of files that differ or that one side lacks.

    The lines give files by stage, and the first stage whose bytes are not the same.
    """
    rows = [["stage", "bit-equal", "other bytes", "only here", "only there"]]
    first, n_different = "", 0
    for stage in dict(STAGES):
        ours = {name for name in here if stage_of(name) == stage}
        theirs = {name for name in there if stage_of(name) == stage}
        equal = sum(here[name] == there[name] for name in ours & theirs)
        counts = [equal, len(ours & theirs) - equal, len(ours - theirs), len(theirs - ours)]
        if ours | theirs:
            rows.append([stage, *map(str, counts)])
        n_different += sum(counts[1:])
        first = first or (stage if counts[1] else "")
    last = f"first stage with other bytes: {first or 'none'}"
    return [*comparison.aligned(rows), last], n_different
