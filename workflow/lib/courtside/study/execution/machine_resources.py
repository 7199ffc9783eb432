"""Missing resources, reported in one line: disk space, permission to write, memory."""

import errno
import os
import secrets
import shutil
from pathlib import Path

from courtside.study.errors import SPARE_MEMORY, InputError, StrPath
from courtside.study.execution import files

LEAST_FREE_MB = 20  # below, Snakemake's own metadata and logs may not fit
FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
CLOSED = {errno.EROFS, errno.EACCES, errno.EPERM}
# In messages of OpenCV and other C++ libraries.
NO_MEMORY = ("Insufficient memory", "bad_alloc", "bad allocation")
AGAIN = "then give the same command again"


def check(folder: StrPath) -> None:
    """Check, before any work, that a study can write to a folder: an `InputError` if it cannot."""
    folder = Path(folder)
    if not _is_writable(folder):
        raise InputError(
            f"{folder}: expected a folder that can be written to, found it read-only; "
            f"allow it, or choose another with --directory, {AGAIN}"
        )
    free_mb = shutil.disk_usage(folder).free / 1e6
    if free_mb < LEAST_FREE_MB:
        raise InputError(
            f"{folder}: expected at least {LEAST_FREE_MB} MB free on its disk, found {free_mb:.1f} "
            f"MB; free some room, {AGAIN}"
        )


def _is_writable(folder: Path) -> bool:
    if not os.access(folder, os.W_OK | os.X_OK):
        return False
    if not files.WINDOWS:
        return True
    tried = folder / f".tried.{secrets.token_hex(4)}"  # `os.access` says yes to every folder there
    try:
        tried.touch(exist_ok=False)
        tried.unlink()
    except PermissionError:
        return False
    return True


def in_words(error: BaseException | None) -> str | None:
    """Return one line on an error caused by a missing resource, None for any other error.

    The errors before it are examined too, because libraries that clean up fail on a full disk
    again.
    """
    while error is not None:
        line = _of_memory(error) or _of_disk(error)
        if line:
            return line
        error = error.__cause__ or error.__context__
    return None


def _of_memory(error: BaseException) -> str | None:
    text = " ".join(str(error).split())
    if not isinstance(error, MemoryError) and not any(word in text for word in NO_MEMORY):
        return None
    return (
        f"expected enough memory, found none left{text and f' ({text})'}; {SPARE_MEMORY}, {AGAIN}"
    )


def _of_disk(error: BaseException) -> str | None:
    if not isinstance(error, OSError):
        return None
    name = error.filename if isinstance(error.filename, str) else "a result"
    if error.errno in FULL:
        return (
            f"{name}: expected room on the disk, found: {error.strerror}; free or allow some, "
            f"{AGAIN}"
        )
    if error.errno in CLOSED:
        return f"{name}: expected the right to use it, found: {error.strerror}; allow it, {AGAIN}"
    return None
