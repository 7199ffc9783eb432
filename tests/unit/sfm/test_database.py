"""Databases are single files that are complete or not there."""

import shutil
import sqlite3
from contextlib import closing

import pycolmap
import pytest

from courtside.sfm import database
from fixtures.cameras import sfm_made


def camera():
    return pycolmap.Camera(model="PINHOLE", width=64, height=48, params=[50, 50, 32, 24])


def n_cameras(path):
    with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as connection:
        return connection.execute("SELECT COUNT(*) FROM cameras").fetchone()[0]


def test_a_new_database_is_one_complete_file(tmp_path):
    path = tmp_path / "new.db"
    with database.new(path) as temporary:
        with pycolmap.Database.open(temporary) as opened:
            opened.write_camera(camera())
        assert not path.exists()
    assert [p.name for p in tmp_path.iterdir()] == ["new.db"]
    assert n_cameras(path) == 1


def test_a_failed_block_leaves_nothing(tmp_path):
    with pytest.raises(RuntimeError, match="on purpose"), database.new(tmp_path / "new.db") as made:
        raise RuntimeError("on purpose")
    assert list(tmp_path.iterdir()) == [] and not made.exists()


def test_a_database_that_grows_from_another_leaves_that_alone(tmp_path):
    first, second = tmp_path / "first.db", tmp_path / "second.db"
    with database.new(first) as temporary, pycolmap.Database.open(temporary) as opened:
        opened.write_camera(camera())
    before = first.read_bytes()
    with database.new(second, first) as temporary, pycolmap.Database.open(temporary) as opened:
        opened.write_camera(camera())
    assert first.read_bytes() == before
    assert (n_cameras(first), n_cameras(second)) == (1, 2)
    assert {p.name for p in tmp_path.iterdir()} == {"first.db", "second.db"}


def test_a_working_copy_is_gone_in_the_end(tmp_path):
    sfm_made.synthetic(tmp_path / "first.db", n_points=20, n_images=3)
    before = (tmp_path / "first.db").read_bytes()
    with database.working_copy(tmp_path / "first.db") as copy:
        with pycolmap.Database.open(copy) as opened:
            opened.write_camera(camera())
        assert (n_cameras(copy), n_cameras(tmp_path / "first.db")) == (2, 1)
    assert not copy.exists() and not copy.parent.exists()
    assert (tmp_path / "first.db").read_bytes() == before


def test_what_is_in_the_log_is_folded_into_the_file(tmp_path):
    path = tmp_path / "one.db"
    opened = pycolmap.Database.open(path)
    opened.write_camera(camera())
    names = {p.name for p in tmp_path.iterdir()}
    assert "one.db-wal" in names  # or there is nothing to test
    for name in names:  # as left by a process that was killed
        shutil.copyfile(tmp_path / name, tmp_path / name.replace("one", "two"))
    opened.close()
    database.fold(tmp_path / "two.db")
    left = {p.name for p in tmp_path.iterdir() if p.name.startswith("two")}
    assert left == {"two.db"} and n_cameras(tmp_path / "two.db") == 1


def test_image_ids_come_in_order(tmp_path):
    sfm_made.synthetic(tmp_path / "first.db", n_points=20, n_images=12)
    found = database.image_ids(tmp_path / "first.db")
    assert list(found.values()) == list(range(1, 13))
    assert list(found) == [f"camera000001_frame{at:06d}.png" for at in range(12)]
