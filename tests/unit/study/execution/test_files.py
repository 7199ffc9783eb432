"""Files appear whole or not at all."""

import hashlib
import json
import os
import unicodedata
from pathlib import Path

import numpy as np
import pytest

from courtside.study.errors import InputError
from courtside.study.execution import files


def test_a_file_appears_when_the_block_ends(tmp_path):
    path = tmp_path / "deep" / "table.csv"
    with files.atomic(path) as temporary:
        temporary.write_text("a")
        assert not path.exists()
        assert temporary.suffix == ".csv"
        assert temporary.parent == path.parent
    assert path.read_text() == "a"
    assert list(path.parent.iterdir()) == [path]


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("old")
    with pytest.raises(RuntimeError), files.atomic(path) as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_the_checksum_is_sha256(tmp_path):
    content = np.random.default_rng(0).bytes(3_000_001)
    (tmp_path / "f").write_bytes(content)
    assert files.sha256(tmp_path / "f") == hashlib.sha256(content).hexdigest()


def test_an_interruption_leaves_nothing(tmp_path):
    with pytest.raises(KeyboardInterrupt), files.atomic(tmp_path / "a.npz") as temporary:
        temporary.write_text("half")
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


def test_two_writers_of_one_file_do_not_meet(tmp_path):
    path = tmp_path / "a.npz"
    with files.atomic(path) as one:
        with files.atomic(path) as other:
            assert one != other
            one.write_text("1")
            other.write_text("2")
        assert path.read_text() == "2"
    assert path.read_text() == "1"
    assert list(tmp_path.iterdir()) == [path]


def test_the_checksum_of_an_empty_file(tmp_path):
    (tmp_path / "f").touch()
    assert files.sha256(tmp_path / "f") == hashlib.sha256(b"").hexdigest()


def test_json_is_written_for_people(tmp_path):
    files.write_json(tmp_path / "a.json", {"size_px": [1, 2], "name": "Ä"})
    assert json.loads((tmp_path / "a.json").read_text()) == {"size_px": [1, 2], "name": "Ä"}
    assert (tmp_path / "a.json").read_text().endswith("}\n")


def names(path):
    return sorted(p.name for p in path.iterdir())


def test_a_folder_appears_when_the_block_ends(tmp_path):
    path = tmp_path / "new" / "frames"
    with files.atomic_folder(path) as beside:
        (beside / "a.png").write_text("a")
        assert not path.exists() and beside.parent == path.parent
    assert names(path) == ["a.png"] and names(tmp_path / "new") == ["frames"]


@pytest.mark.parametrize("content", [[], ["old.png"]])
def test_an_older_folder_is_replaced(tmp_path, content):
    path = tmp_path / "frames"
    path.mkdir()
    for name in content:
        (path / name).write_text("old")
    with files.atomic_folder(path) as beside:
        (beside / "a.png").write_text("a")
        assert names(path) == content
    assert names(path) == ["a.png"] and names(tmp_path) == ["frames"]


def test_a_failing_block_leaves_the_older_one(tmp_path):
    path = tmp_path / "frames"
    path.mkdir()
    (path / "old.png").write_text("old")
    with pytest.raises(RuntimeError, match="disk"), files.atomic_folder(path) as beside:
        (beside / "half.png").write_text("half")
        raise RuntimeError("disk")
    assert names(path) == ["old.png"] and names(tmp_path) == ["frames"]


def test_json_is_read_and_anything_else_is_one_line(tmp_path):
    path = tmp_path / "a.json"
    files.write_json(path, {"a": [1, None]})
    assert files.read_json(path) == {"a": [1, None]}
    for content in (b"", b"{", b"\xff\xfe", b"[" * 100_000, b"1" * 5000):
        path.write_bytes(content)
        with pytest.raises(InputError, match=r"a\.json: expected JSON, found: .*; do so") as caught:
            files.read_json(path, "do so")
        assert len(str(caught.value).splitlines()) == 1


def test_what_killed_jobs_left_is_deleted_and_nothing_else(tmp_path):
    kept = [
        tmp_path / "deep" / name
        for name in ("walk.png", ".hidden", ".keep.me.png", "a.0a1b2c3d.png")
    ]
    kept[0].parent.mkdir()
    for path in kept:
        path.write_text("x")
    held = []
    for make in (files.atomic, files.atomic_folder):
        writing = make(tmp_path / "deep" / "take.mp4")
        held.append(writing)  # as of a killed job, the block never ends
        path = writing.__enter__()
        (path / "0.png" if path.is_dir() else path).write_text("half")
    assert len(list((tmp_path / "deep").iterdir())) == 6
    files.delete_unfinished(tmp_path)
    assert sorted((tmp_path / "deep").iterdir()) == sorted(kept)


def refusing(monkeypatch, times):
    """Let a rename be refused so many times, as Windows does for an open file."""
    monkeypatch.setattr(files, "WINDOWS", True)
    monkeypatch.setattr(files, "WAITS_S", (0.0, 0.0))
    tries, really = [], os.replace

    def replace(old, new):
        tries.append(new)
        if len(tries) <= times:
            raise PermissionError(13, "The process cannot access the file")
        really(old, new)

    monkeypatch.setattr(files.os, "replace", replace)
    return tries


@pytest.mark.parametrize("times", [0, 2])
def test_a_file_that_is_open_only_shortly_is_replaced_on_windows(tmp_path, monkeypatch, times):
    path = tmp_path / "table.csv"
    path.write_text("old")
    tries = refusing(monkeypatch, times)
    files.write_json(path, "new")
    assert files.read_json(path) == "new" and len(tries) == times + 1


def test_a_file_that_stays_open_is_told_in_one_line_on_windows(tmp_path, monkeypatch):
    path = tmp_path / "table.csv"
    path.write_text("old")
    tries = refusing(monkeypatch, 3)
    with pytest.raises(
        InputError, match=r"table\.csv: .*close the programs that have it open"
    ) as e:
        files.write_json(path, "new")
    assert len(tries) == 3 and "\n" not in str(e.value)
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]


def test_a_folder_that_cannot_be_replaced_keeps_its_files(tmp_path, monkeypatch):
    path = tmp_path / "frames"
    path.mkdir()
    (path / "old.png").write_text("old")
    really = os.replace

    def replace(old, new):
        if (Path(old) / "new.png").exists():
            raise PermissionError(13, "The process cannot access the file")
        really(old, new)

    monkeypatch.setattr(files.os, "replace", replace)
    with pytest.raises(PermissionError), files.atomic_folder(path) as beside:
        (beside / "new.png").write_text("new")
    assert names(path) == ["old.png"] and names(tmp_path) == ["frames"]


def test_elsewhere_a_refusal_stays_what_it_is(tmp_path, monkeypatch):
    tries = refusing(monkeypatch, 3)
    monkeypatch.setattr(files, "WINDOWS", False)
    with pytest.raises(PermissionError):
        files.write_json(tmp_path / "a.json", 1)
    assert len(tries) == 1


def test_a_path_is_seen_from_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert files.seen_from(tmp_path / "a" / "b") == "a/b"
    assert files.seen_from(tmp_path / "a", tmp_path / "c" / "d") == "../../a"
    assert files.seen_from(tmp_path, tmp_path) == "."


def test_a_path_on_another_drive_stays_absolute(tmp_path, monkeypatch):
    def between_drives(path, folder):
        raise ValueError("path is on mount 'D:', start on mount 'C:'")

    monkeypatch.setattr(files.os.path, "relpath", between_drives)
    assert files.seen_from(tmp_path / "a") == (tmp_path / "a").resolve().as_posix()


def test_what_is_nearly_there_is_told(tmp_path):
    (tmp_path / "Halle Süd").mkdir()
    (tmp_path / "Halle Süd" / "left.MP4").touch()
    assert files.misspelt("halle süd/Left.mp4", tmp_path) == "did you mean 'Halle Süd/left.MP4'?"
    assert files.misspelt("Halle Süd\\left.MP4", tmp_path) == "did you mean 'Halle Süd/left.MP4'?"
    whole = str(tmp_path / "Halle Süd" / "left.MP4")
    assert files.misspelt(whole.replace("MP4", "mp4"), "/elsewhere") == f"did you mean {whole!r}?"
    assert files.misspelt("~/left.MP4", tmp_path) == "write the whole path in place of ~"
    for other in ("Halle Süd/right.MP4", "Halle/left.MP4", "Halle Süd/left.MP4/a", "a" * 5000):
        assert files.misspelt(other, tmp_path) == ""


def test_of_several_names_that_are_nearly_right_none_is_told(tmp_path):
    for name in ("A.mp4", "a.MP4"):
        (tmp_path / name).touch()
    if len(list(tmp_path.iterdir())) < 2:
        pytest.skip("on this disk capital letters are small ones")
    assert files.misspelt("a.mp4", tmp_path) == ""


def test_accents_that_are_stored_in_another_way_are_told(tmp_path):
    typed, stored = (unicodedata.normalize(form, "Süd.mp4") for form in ("NFC", "NFD"))
    (tmp_path / stored).touch()
    if (tmp_path / typed).exists():
        pytest.skip("on this disk both are one name")
    assert files.misspelt(typed, tmp_path).startswith(
        "a name there looks the same, but its accents"
    )
