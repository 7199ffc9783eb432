"""Checksums are those of the content, read again only where size or date changed."""

import hashlib
import json
import os
import time

import pytest

from courtside.study.execution import checksums

OLD_NS = time.time_ns() - 60 * 10**9


@pytest.fixture
def video(tmp_path):
    path = tmp_path / "video.mp4"
    path.write_bytes(b"frames")
    os.utime(path, ns=(OLD_NS, OLD_NS))
    return path


@pytest.fixture
def reads(monkeypatch):
    """Return the list of files that are read for their checksum."""
    found, real = [], checksums.files.sha256
    monkeypatch.setattr(checksums.files, "sha256", lambda path: found.append(path) or real(path))
    return found


def test_a_file_is_read_once(tmp_path, video, reads):
    for _ in range(3):
        known = checksums.Checksums(tmp_path / "checksums.json")
        assert known.of(video) == hashlib.sha256(b"frames").hexdigest()
        known.write()
    assert reads == [video]


@pytest.mark.parametrize("later_ns", [0, 5 * 10**9], ids=["another size", "another date"])
def test_a_changed_file_is_read_again(tmp_path, video, later_ns):
    known = checksums.Checksums(tmp_path / "checksums.json")
    known.of(video)
    content = b"frames" if later_ns == 0 else b"FRAMES"
    video.write_bytes(content * (2 if later_ns == 0 else 1))
    os.utime(video, ns=(OLD_NS + later_ns, OLD_NS + later_ns))
    assert known.of(video) == hashlib.sha256(video.read_bytes()).hexdigest()


def test_a_file_of_this_moment_is_not_trusted_later(tmp_path, reads):
    path = tmp_path / "clicks.csv"
    path.write_text("a")
    known = checksums.Checksums(tmp_path / "checksums.json")
    known.of(path)
    state = path.stat()
    path.write_text("b")
    os.utime(path, ns=(state.st_mtime_ns, state.st_mtime_ns))
    assert known.of(path) == hashlib.sha256(b"b").hexdigest()
    assert len(reads) == 2


def test_what_is_gone_has_none_and_is_forgotten(tmp_path, video):
    known = checksums.Checksums(tmp_path / "checksums.json")
    known.of(video)
    other = video.with_name("other.mp4")
    video.rename(other)
    assert known.of(video) is None
    known.of(other)
    known.write()
    assert list(json.loads(known.path.read_text())["files"]) == [str(other)]


@pytest.mark.parametrize(
    "text",
    [
        "", "[]", "{", '{"format": 0}', '{"format": 1}', '{"format": 1, "files": []}',
        "[" * 100_000,
        '{"format": 1, "files": {"a": [1]}}', '{"format": 1, "files": {"a": [1, "x", 2]}}',
    ],
)  # fmt: skip
def test_a_broken_memory_is_an_empty_one(tmp_path, video, text):
    path = tmp_path / "checksums.json"
    path.write_text(text)
    assert checksums.Checksums(path).of(video) == hashlib.sha256(b"frames").hexdigest()


def test_a_folder_is_its_names_and_contents(tmp_path):
    folder = tmp_path / "board"
    (folder / "in").mkdir(parents=True)
    (folder / "a.png").write_bytes(b"1")
    (folder / "in" / "b.png").write_bytes(b"2")
    first = checksums.of_path(folder)
    assert checksums.Checksums(tmp_path / "c.json").of(folder) == first
    (folder / ".snakemake_timestamp").touch()
    assert checksums.of_path(folder) == first
    (folder / "a.png").write_bytes(b"3")
    changed = checksums.of_path(folder)
    (folder / "a.png").write_bytes(b"1")
    (folder / "a.png").rename(folder / "c.png")
    assert len({first, changed, checksums.of_path(folder)}) == 3


def test_a_folder_is_read_once_whatever_rests_on_it(tmp_path, reads):
    """Each of 60 results read an hour's 860 000 files of keypoints again."""
    folder = tmp_path / "left_json"
    folder.mkdir()
    for number in range(3):
        (folder / f"{number}.json").write_text(str(number))
        os.utime(folder / f"{number}.json", ns=(OLD_NS, OLD_NS))
    known = checksums.Checksums(tmp_path / "checksums.json")
    first = known.of(folder)
    assert known.of(folder) == first == checksums.of_path(folder)
    known.write()
    del reads[:]
    assert checksums.Checksums(known.path).of(folder) == first
    assert reads == []


def test_a_file_in_doubt_is_forgotten(tmp_path, video):
    known = checksums.Checksums(tmp_path / "checksums.json")
    assert known.of(video)
    known.use(video, OLD_NS + 1)
    known.write()
    known = checksums.Checksums(known.path)
    known.doubt([video])
    assert known.of(video) is None
    known.write()
    again = checksums.Checksums(known.path)
    assert (again.known, again.until) == ({}, {})
