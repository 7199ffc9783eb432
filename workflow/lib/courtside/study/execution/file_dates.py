"""Dates of files from which Snakemake concludes wrongly: in the future, or of an exchanged file."""

import contextlib
import itertools
import os
import shlex
import time
from collections.abc import Iterable, Iterator
from datetime import datetime
from pathlib import Path

from courtside.study.errors import InputError, StrPath, few
from courtside.study.execution import checksums, files

SLACK_S = 60.0  # by which the clocks of a computer and of a disk in its network may differ
N_NAMED = 3  # files of a folder in a line


def check_future(named: Iterable[StrPath]) -> None:
    """Check that no file is dated in the future that is named or below a folder that is.

    Those that are missing are left out.

    Snakemake ends a job with an error if what it made is older than what it was made from. An
    `InputError` names the file that is furthest ahead.
    """
    there = [path for path in map(Path, dict.fromkeys(named)) if path.exists()]
    latest_s = time.time() + SLACK_S
    files_there = [(one.stat().st_mtime, str(one)) for one in there if one.is_file()]
    below = (dated for one in there if one.is_dir() for dated in _dated(str(one)))
    late = {dated for dated in itertools.chain(files_there, below) if dated[0] > latest_s}
    if not late:
        return
    when_s, path = max(late)
    raise InputError(
        f"{path}: expected a date in the past, found {_in_words(when_s)} (now: "
        f"{_in_words(time.time())}), as in {len(late) - 1} more; set this computer's clock "
        f"if it is wrong, otherwise give them today's date: {_advice(there)}"
    )


def _dated(folder: str) -> Iterator[tuple[float, str]]:
    """Yield date, s, and path of each file below a folder: one look at each, for there are many."""
    with os.scandir(folder) as every:
        for one in every:
            if one.is_dir(follow_symlinks=False):
                yield from _dated(one.path)
            elif one.is_file():
                yield one.stat().st_mtime, one.path


def check_exchanged(kept: StrPath, apart: Iterable[StrPath]) -> None:
    """Check that no file was exchanged for one that is older than the results since the last run.

    Such a file looks unchanged to Snakemake, which compares dates: results of the other one would
    stay. `kept` is the file of `Checksums` that runs write: of all files that results were made
    from. Of these, files and folders `apart` are not looked at. An `InputError` has one line for
    each folder. New dates of files that are the same are kept, so that they are read once.
    """
    of_runs = checksums.Checksums(kept)
    apart = {Path(path) for path in apart}
    exchanged: dict[Path, list[Path]] = {}
    for path in map(Path, sorted(of_runs.known)):
        if apart.isdisjoint([path, *path.parents]) and _is_exchanged(path, of_runs):
            exchanged.setdefault(path.parent, []).append(path)
    with contextlib.suppress(OSError):
        of_runs.write()
    lines = [
        f"{folder}: expected files as in the last run, or newer than the results, found others of "
        f"an older date ({few([path.name for path in found], N_NAMED)}): the results of the last "
        f"run would stay; give them today's date: {_touching(folder, found)}"
        for folder, found in exchanged.items()
    ]
    if lines:
        raise InputError(*lines)


def _is_exchanged(path: Path, of_runs: checksums.Checksums) -> bool:
    """Say whether a file differs from the one of a run, but is not newer than its results."""
    if not path.is_file():
        return False
    size, stamp_ns, _ = of_runs.known[str(path)]
    now, until_ns = path.stat(), max(stamp_ns, of_runs.until.get(str(path), 0))
    if now.st_mtime_ns > until_ns or (now.st_size, now.st_mtime_ns) == (size, stamp_ns):
        return False
    return not of_runs.confirm(path)


def _touching(folder: Path, found: list[Path]) -> str:
    """Return the command that gives files the present date; if many, all of their folder."""
    few_files = len(found) <= N_NAMED
    if files.WINDOWS:
        named = ", ".join(f"'{path}'" for path in (found if few_files else [folder / "*"]))
        return f"Get-Item -Path {named} | ForEach-Object {{ $_.LastWriteTime = Get-Date }}"
    named = shlex.join(map(str, found)) if few_files else f"{shlex.quote(str(folder))}/*"
    return f"touch -- {named}"


def _advice(there: list[Path]) -> str:
    """Return the command that dates future files today, for PowerShell on Windows."""
    named = [f"'{path}'" for path in there]
    if files.WINDOWS:
        return (
            f"Get-ChildItem -LiteralPath {', '.join(named)} -Recurse -File -Force | Where-Object "
            "LastWriteTime -gt (Get-Date) | ForEach-Object { $_.LastWriteTime = Get-Date }"
        )
    return f"find {' '.join(named)} -newermt now -exec touch {{}} +"


def _in_words(time_s: float) -> str:
    return datetime.fromtimestamp(time_s).strftime("%Y-%m-%d %H:%M")
