"""Files dated in the future, as cameras with a wrong clock write them."""

import time
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path

from courtside.study.errors import InputError, StrPath
from courtside.study.execution import files

SLACK_S = 60.0  # by which the clocks of a computer and of a disk in its network may differ


def check(named: Iterable[StrPath]) -> None:
    """Check that no file is dated in the future that is named or below a folder that is.

    Those that are missing are left out.

    Snakemake ends a job with an error if what it made is older than what it was made from. An
    `InputError` names the file that is furthest ahead.
    """
    there = [path for path in map(Path, dict.fromkeys(named)) if path.exists()]
    latest_s = time.time() + SLACK_S
    every = (path for one in there for path in ([one] if one.is_file() else one.rglob("*")))
    found = (path for path in every if path.is_file())
    late = {dated for path in found if (dated := (path.stat().st_mtime, path))[0] > latest_s}
    if not late:
        return
    when_s, path = max(late)
    raise InputError(
        f"{path}: expected a date in the past, found {_in_words(when_s)} (now: "
        f"{_in_words(time.time())}), as in {len(late) - 1} more; set this computer's clock "
        f"if it is wrong, otherwise give them today's date: {_advice(there)}"
    )


def _advice(there: list[Path]) -> str:
    """Return the command that dates the files today, for PowerShell on Windows."""
    named = [f"'{path}'" for path in there]
    if files.WINDOWS:
        return (
            f"Get-ChildItem -LiteralPath {', '.join(named)} -Recurse -File -Force | Where-Object "
            "LastWriteTime -gt (Get-Date) | ForEach-Object { $_.LastWriteTime = Get-Date }"
        )
    return f"find {' '.join(named)} -newermt now -exec touch {{}} +"


def _in_words(time_s: float) -> str:
    return datetime.fromtimestamp(time_s).strftime("%Y-%m-%d %H:%M")
