"""Matches: of one wall many, of two walls none, and no more than was asked for."""

import sqlite3
from contextlib import closing

import numpy as np
import pycolmap
import pytest

from courtside.sfm import database, features, matching
from fixtures.cameras import sfm_made


@pytest.fixture(scope="module")
def wall(tmp_path_factory):
    root = tmp_path_factory.mktemp("wall")
    features.extract(root / "f.db", root, sfm_made.wall(root), **sfm_made.EXTRACTION)
    return root


def pairs(names):
    return [(a, b) for at, a in enumerate(names) for b in names[at + 1 :]]


def test_related_pictures_match_and_unrelated_do_not(wall, tmp_path):
    walk = [f"walk/{at:03d}.png" for at in range(4)]
    related = pairs(["static/side.png", *walk])
    unrelated = [("static/other.png", name) for name in walk]
    found = matching.match(wall / "f.db", tmp_path / "m.db", related + unrelated, seed=0)
    assert list(found) == related + unrelated
    assert min(found[pair] for pair in related) > 50
    assert {found[pair] for pair in unrelated} == {0}
    assert [p.name for p in tmp_path.iterdir()] == ["m.db"]


def test_matched_places_are_the_same_spot_of_the_wall(wall, tmp_path):
    a, b = "walk/000.png", "walk/002.png"
    matching.match(wall / "f.db", tmp_path / "m.db", [(a, b)], seed=0)
    ids = database.image_ids(tmp_path / "m.db")
    with closing(pycolmap.Database.open(tmp_path / "m.db")) as opened:
        first, second = (opened.read_keypoints(ids[name])[:, :2] - 0.5 for name in (a, b))
        matched = opened.read_two_view_geometry(ids[a], ids[b]).inlier_matches

    def on_wall(xy, at):
        matrix = [[1, 0.01 * at, -30.0 - 12 * at], [0, 1, -40 - 3 * at], [2e-4 * at, 0, 1]]
        spot = np.column_stack([xy, np.ones(len(xy))]) @ np.linalg.inv(matrix).T
        return spot[:, :2] / spot[:, 2:]

    off = on_wall(first[matched[:, 0]], 0) - on_wall(second[matched[:, 1]], 2)
    distance = np.linalg.norm(off, axis=1)
    assert np.median(distance) < 0.3
    assert np.mean(distance < 2) > 0.95


def test_pairs_that_were_not_asked_for_are_not_there(wall, tmp_path):
    wanted = [("walk/002.png", "walk/000.png")]  # in any order
    found = matching.match(wall / "f.db", tmp_path / "m.db", wanted, seed=0)
    assert found[wanted[0]] > 50
    with closing(pycolmap.Database.open(tmp_path / "m.db")) as opened:
        assert opened.num_verified_image_pairs() == 1


def test_the_result_holds_places_and_verified_matches_only(wall, tmp_path):
    before = (wall / "f.db").read_bytes()
    matching.match(wall / "f.db", tmp_path / "m.db", [("walk/000.png", "walk/001.png")], seed=0)
    assert (wall / "f.db").read_bytes() == before
    with closing(sqlite3.connect(tmp_path / "m.db")) as connection:
        count = {
            table: connection.execute(f"SELECT COUNT(*) FROM {table}").fetchone()[0]
            for table in ("keypoints", "descriptors", "matches", "two_view_geometries")
        }
    assert count == {"keypoints": 6, "descriptors": 0, "matches": 0, "two_view_geometries": 1}
    assert not list(wall.glob("f.db-*"))


def test_the_same_seed_gives_the_same_matches(wall, tmp_path):
    asked = pairs([f"walk/{at:03d}.png" for at in range(4)])
    tables = []
    for at in range(2):
        matching.match(wall / "f.db", tmp_path / f"{at}.db", asked, seed=3)
        with closing(sqlite3.connect(tmp_path / f"{at}.db")) as connection:
            rows = connection.execute(
                "SELECT pair_id, data FROM two_view_geometries ORDER BY pair_id"
            )
            tables.append(rows.fetchall())
    assert tables[0] == tables[1] and len(tables[0]) == len(asked)


def test_a_stricter_ratio_keeps_fewer(wall, tmp_path):
    pair = ("walk/000.png", "walk/003.png")
    loose = matching.match(wall / "f.db", tmp_path / "a.db", [pair], seed=0, max_ratio=0.9)[pair]
    strict = matching.match(wall / "f.db", tmp_path / "b.db", [pair], seed=0, max_ratio=0.4)[pair]
    assert 15 < strict < loose


def test_no_pairs_give_no_matches(wall, tmp_path):
    assert matching.match(wall / "f.db", tmp_path / "m.db", [], seed=0) == {}
    assert len(database.image_ids(tmp_path / "m.db")) == 6
