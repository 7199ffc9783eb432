"""COLMAP databases as single, finished files: an open one has a write-ahead log beside it."""

import contextlib
import shutil
import sqlite3
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pycolmap

from courtside.study.errors import StrPath, reading
from courtside.study.execution.files import atomic

pycolmap.logging.minloglevel = pycolmap.logging.Level.ERROR.value


@contextlib.contextmanager
def new(path: StrPath, source: StrPath | None = None) -> Iterator[Path]:
    """Yield a database to write; it appears at `path`, complete, when the block succeeds.

    It starts as a copy of the finished database `source`, empty without.
    """
    with atomic(path) as temporary, working_copy(source) as database:
        yield database
        fold(database)
        shutil.copyfile(database, temporary)


@contextlib.contextmanager
def working_copy(source: StrPath | None = None) -> Iterator[Path]:
    """Yield a copy of a finished database that pycolmap may write to; it is deleted in the end."""
    # Windows does not delete what pycolmap may still hold open.
    with tempfile.TemporaryDirectory(prefix="courtside-", ignore_cleanup_errors=True) as folder:
        database = Path(folder) / "database.db"
        if source is None:
            pycolmap.Database.open(database).close()
        else:
            shutil.copyfile(source, database)
            _ids(database, source)
        yield database


def fold(path: StrPath) -> None:
    """Fold the write-ahead log into the database file, and give free pages back."""
    with contextlib.closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA journal_mode=DELETE")
        connection.execute("VACUUM")


def image_ids(path: StrPath) -> dict[str, int]:
    """Return the id of each image by name, in order of ids; `InputError` if a file is damaged."""
    return _ids(path, path)


def _ids(path: StrPath, where: StrPath) -> dict[str, int]:
    with (
        reading(where, "a COLMAP database", "delete it and run the study again"),
        contextlib.closing(pycolmap.Database.open(path)) as database,
    ):
        images = sorted(database.read_all_images(), key=lambda image: image.image_id)
        return {image.name: image.image_id for image in images}
