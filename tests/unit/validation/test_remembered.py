"""Looks are remembered while a file is unchanged; a damaged memory costs time only."""

import json
from dataclasses import asdict

import numpy as np
import pytest

from courtside.study.errors import InputError
from courtside.validation import remembered
from courtside.validation.remembered import Remembered
from fixtures.recordings import rooms_filmed


def test_an_unchanged_file_is_looked_at_once(tmp_path, monkeypatch):
    film, kept = rooms_filmed.film(tmp_path / "a.mp4", 1, n=5), tmp_path / "looks.json"
    first = Remembered(kept)
    found = first.look(film)
    first.save()
    seen = []
    monkeypatch.setattr(remembered, "glance", lambda path, stop_s=None: seen.append(path) or found)
    again = Remembered(kept).look(film)
    assert seen == []
    assert (again.size, again.n_frames, again.rate_hz) == (found.size, 5, found.rate_hz)
    assert np.array_equal(again.small, found.small)
    assert {**asdict(again), "small": 0} == {**asdict(found), "small": 0}
    film.touch()
    Remembered(kept).look(film)
    assert seen == [film]


@pytest.mark.parametrize("content", ["", "[]", '{"format": 1, "looks": 3}', '{"format": 0}'])
def test_a_damaged_memory_is_not_used(tmp_path, content):
    film, kept = rooms_filmed.film(tmp_path / "a.mp4", 1, n=5), tmp_path / "looks.json"
    kept.write_text(content)
    assert Remembered(kept).look(film).n_frames == 5


def test_a_damaged_entry_is_looked_at_again(tmp_path):
    film, kept = rooms_filmed.film(tmp_path / "a.mp4", 1, n=5), tmp_path / "looks.json"
    first = Remembered(kept)
    first.look(film)
    first.save()
    content = json.loads(kept.read_text())
    for entry in content["looks"].values():
        entry["small"] = "AA=="
    kept.write_text(json.dumps(content))
    assert Remembered(kept).look(film).n_frames == 5


def test_a_folder_is_read_again_if_a_file_in_it_changes(tmp_path):
    folder, kept, read = tmp_path / "recording", tmp_path / "looks.json", []
    (folder / "depth").mkdir(parents=True)
    (folder / "times.csv").write_text("1")

    def look():
        looks = Remembered(kept)
        looks.check(folder, "depth", lambda: read.append(1))
        looks.save()
        return len(read)

    assert [look(), look()] == [1, 1]
    (folder / "times.csv").write_text("22")
    assert [look(), look()] == [2, 2]
    (folder / "depth" / "0.png").write_text("new")
    assert [look(), look()] == [3, 3]


def test_faults_are_not_remembered(tmp_path):
    film = tmp_path / "a.mp4"
    film.write_bytes(b"no video")
    looks = Remembered(tmp_path / "looks.json")
    for _ in range(2):
        with pytest.raises(InputError):
            looks.look(film)
    looks.save()
    assert not (tmp_path / "looks.json").exists()
