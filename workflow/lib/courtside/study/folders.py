"""Writing folders so that a half-written one never looks finished."""

import contextlib
import secrets
import shutil
from pathlib import Path


@contextlib.contextmanager
def atomic_folder(path):
    """Give a new folder beside `path`; rename it to `path` when the block ends well.

    Parameters
    ----------
    path : str or Path
        The folder to write. Missing parent folders are made; one of that name is replaced.

    Yields
    ------
    temporary : Path
        Write here. It is deleted if the block raises, and `path` stays as it was.
    """
    path = Path(path)
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
    old = temporary.with_suffix(".old")
    temporary.mkdir(parents=True)
    try:
        yield temporary
        if path.exists():  # a folder that is not empty cannot be renamed over
            path.rename(old)
        temporary.rename(path)
    finally:
        for rest in (temporary, old):
            shutil.rmtree(rest, ignore_errors=True)
