"""COLMAP databases as single, finished files: an open one keeps part of itself in a log beside it."""

import contextlib
import shutil
import sqlite3
import tempfile
from pathlib import Path

import pycolmap

from courtside.study.errors import reading
from courtside.study.execution.files import atomic

pycolmap.logging.minloglevel = pycolmap.logging.Level.ERROR.value


@contextlib.contextmanager
def new(path, source=None):
    """Give a database to write; it appears at `path`, complete, when the block ends well.

    Parameters
    ----------
    path : str or Path
    source : str or Path, optional
        A finished database to start from; empty without.

    Yields
    ------
    temporary : Path
    """
    with atomic(path) as temporary, working_copy(source) as database:
        yield database
        fold(database)
        shutil.copyfile(database, temporary)


@contextlib.contextmanager
def working_copy(source=None):
    """Give a copy of a finished database that pycolmap may write to; it is deleted in the end."""
    with tempfile.TemporaryDirectory(prefix="courtside-") as folder:
        database = Path(folder) / "database.db"
        if source is None:
            pycolmap.Database.open(database).close()
        else:
            shutil.copyfile(source, database)
            _ids(database, source)
        yield database


def fold(path):
    """Fold the write-ahead log into the database file, and give free pages back."""
    with contextlib.closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA journal_mode=DELETE")
        connection.execute("VACUUM")


def image_ids(path):
    """Return the id of each image by name, in the order of the ids; `InputError` where a file is damaged."""
    return _ids(path, path)


def _ids(path, where):
    with (
        reading(where, "a COLMAP database", "delete it and run the study again"),
        contextlib.closing(pycolmap.Database.open(path)) as database,
    ):
        images = sorted(database.read_all_images(), key=lambda image: image.image_id)
        return {image.name: image.image_id for image in images}
