"""Files dated in the future, as cameras with a wrong clock write them: Snakemake refuses what they make."""

import time
from datetime import datetime
from pathlib import Path

from courtside.study.errors import InputError

SLACK_S = 60.0  # by which the clocks of a computer and of a disk in its network may differ


def check(folders):
    """Check that no file in some folders is dated in the future.

    Snakemake ends a job with an error if what it made is older than what it was made from.

    Parameters
    ----------
    folders : iterable of str or Path
        Looked into with all that is below them; one that does not exist is left out.

    Raises
    ------
    InputError
        If there is such a file; the line names the one that is furthest ahead.
    """
    folders = [Path(folder) for folder in folders if Path(folder).is_dir()]
    latest_s = time.time() + SLACK_S
    late = [found for folder in folders for found in _dated(folder) if found[0] > latest_s]
    if not late:
        return
    when_s, path = max(late)
    where = " ".join(f"'{folder}'" for folder in folders)
    raise InputError(
        f"{path}: expected a date in the past, found {_in_words(when_s)} (now: {_in_words(time.time())}), "
        f"as in {len(late) - 1} more files; set this computer's clock if it is wrong, otherwise give them "
        f"today's date: find {where} -newermt now -exec touch {{}} +"
    )


def _dated(folder):
    """Yield (date in seconds, path) of all files in a folder."""
    for path in folder.rglob("*"):
        if path.is_file():
            yield path.stat().st_mtime, path


def _in_words(time_s):
    return datetime.fromtimestamp(time_s).strftime("%Y-%m-%d %H:%M")
