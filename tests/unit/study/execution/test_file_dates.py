"""Files dated in the future, or exchanged for older ones, are told before any job runs."""

import os
import re
import subprocess
import time

import pytest

from courtside.study.errors import InputError
from courtside.study.execution import checksums, file_dates

DAY_S = 86400.0


def dated(path, when_s):
    path.parent.mkdir(exist_ok=True)
    path.write_text("x")
    os.utime(path, (when_s, when_s))
    return path


def test_files_of_the_past_and_missing_folders_pass(tmp_path):
    dated(tmp_path / "data" / "old.mp4", time.time() - 7000 * DAY_S)
    dated(tmp_path / "data" / "now.mp4", time.time())
    assert file_dates.check_future([tmp_path / "data", tmp_path / "none"]) is None


def test_a_file_that_is_named_counts_once(tmp_path):
    late = dated(tmp_path / "disk" / "late.mp4", time.time() + DAY_S)
    dated(tmp_path / "disk" / "other.mp4", time.time() + DAY_S)
    with pytest.raises(InputError, match=r"late\.mp4: expected a date in the past.*in 0 more"):
        file_dates.check_future([late, late, tmp_path / "disk" / "missing.mp4"])


def test_the_file_furthest_ahead_is_named_and_the_advice_mends_it(tmp_path):
    dated(tmp_path / "data" / "near.mp4", time.time() + DAY_S)
    dated(tmp_path / "data" / "far.mp4", time.time() + 400 * DAY_S)
    with pytest.raises(
        InputError, match=r"far\.mp4: expected a date in the past.*as in 1 more;"
    ) as e:
        file_dates.check_future([tmp_path / "data"])
    assert "\n" not in str(e.value)
    if os.name == "nt":
        pytest.skip("the advice is for PowerShell, which is not the shell here")
    subprocess.run(str(e.value).rpartition(": ")[2], shell=True, check=True)
    assert file_dates.check_future([tmp_path / "data"]) is None


def test_a_file_in_a_folder_within_a_folder_is_looked_at(tmp_path):
    (tmp_path / "data").mkdir()
    late = dated(tmp_path / "data" / "left_json" / "1.json", time.time() + DAY_S)
    with pytest.raises(InputError, match=re.escape(f"{late}: expected a date in the past")):
        file_dates.check_future([tmp_path])


def test_the_advice_on_windows_is_for_powershell(tmp_path, monkeypatch):
    monkeypatch.setattr(file_dates.files, "WINDOWS", True)
    dated(tmp_path / "data" / "far.mp4", time.time() + DAY_S)
    with pytest.raises(InputError, match=r"today's date: Get-ChildItem -LiteralPath '.*data' -Rec"):
        file_dates.check_future([tmp_path / "data"])


@pytest.mark.skipif(os.name == "nt", reason="links need a right of their own")
def test_a_link_that_leads_nowhere_is_no_concern_of_dates(tmp_path):
    (tmp_path / "lost").symlink_to(tmp_path / "nothing")
    assert file_dates.check_future([tmp_path]) is None


def kept_of(folder, *paths):
    """Return what the end of a run keeps of the files that results were made from."""
    known = checksums.Checksums(folder / "checksums.json")
    for path in paths:
        known.of(path)
    known.write()
    return known.path


@pytest.fixture
def used(tmp_path):
    """Return a recording from which the last run was made, and what that run has kept of it."""
    film = dated(tmp_path / "my data" / "a.mp4", 1000)
    return film, kept_of(tmp_path, film)


@pytest.fixture
def made(used):
    """Return the recording, what runs have kept, and when the results were made from it."""
    film, kept = used
    known = checksums.Checksums(kept)
    known.use(film, 2000 * 10**9)
    known.write()
    return film, kept, 2000


def replaced(path, content, when_s):
    path.write_text(content)
    os.utime(path, (when_s, when_s))


def test_files_as_in_the_last_run_and_those_that_are_gone_pass(used, tmp_path):
    film, kept = used
    assert file_dates.check_exchanged(kept, []) is None
    os.utime(film, (900, 900))  # an older date alone
    assert file_dates.check_exchanged(kept, []) is None
    replaced(film, "newer", 1100)
    assert file_dates.check_exchanged(kept, []) is None
    film.unlink()
    assert file_dates.check_exchanged(kept, []) is None
    assert file_dates.check_exchanged(tmp_path / "no run", []) is None


@pytest.mark.parametrize(
    ("content", "when_s"), [("y", 900), ("of another size", 900), ("of another size", 1000)]
)
def test_another_file_that_is_no_newer_is_told_until_it_is_dated_today(used, content, when_s):
    film, kept = used
    replaced(film, content, when_s)
    with pytest.raises(InputError, match=r"my data: expected .*found others .*\(a\.mp4\)") as e:
        file_dates.check_exchanged(kept, [])
    assert "\n" not in str(e.value)
    if os.name == "nt":
        pytest.skip("the advice is for PowerShell, which is not the shell here")
    subprocess.run(str(e.value).rpartition(": ")[2], shell=True, check=True)
    assert file_dates.check_exchanged(kept, []) is None


@pytest.mark.parametrize("content", ["y", "of another size"])
@pytest.mark.parametrize("before_s", [0, 900])
def test_another_file_that_is_no_newer_than_the_results_is_told(made, content, before_s):
    film, kept, made_s = made
    replaced(film, content, made_s - before_s)
    with pytest.raises(InputError, match=r"my data: expected .*found others .*\(a\.mp4\)"):
        file_dates.check_exchanged(kept, [])
    replaced(film, content, made_s + 1)  # Snakemake sees this one
    assert file_dates.check_exchanged(kept, []) is None


def test_a_copy_without_dates_is_neither_told_nor_read(made, monkeypatch):
    film, kept, made_s = made
    os.utime(film, (made_s - 1, made_s - 1))
    assert file_dates.check_exchanged(kept, []) is None
    os.utime(film, (made_s + DAY_S, made_s + DAY_S))
    monkeypatch.setattr(file_dates.files, "sha256", lambda path: pytest.fail(f"read {path}"))
    assert file_dates.check_exchanged(kept, []) is None
    known = checksums.Checksums(kept)
    known.use(film, 10**18)  # a run in the copy that made something else of it
    known.write()
    assert file_dates.check_exchanged(kept, []) is None


def test_a_file_that_was_only_dated_anew_is_read_once(made, monkeypatch):
    film, kept, made_s = made
    os.utime(film, (900, 900))  # as of a disk that shifts dates by an hour
    assert file_dates.check_exchanged(kept, []) is None
    with monkeypatch.context() as patch:
        patch.setattr(file_dates.files, "sha256", lambda path: pytest.fail(f"read {path}"))
        assert file_dates.check_exchanged(kept, []) is None
    replaced(film, "y", 950)
    with pytest.raises(InputError):
        file_dates.check_exchanged(kept, [])
    with pytest.raises(InputError):  # it is told until it is mended
        file_dates.check_exchanged(kept, [])
    replaced(film, "y", made_s + 1)
    assert file_dates.check_exchanged(kept, []) is None


def test_two_files_that_change_names_are_both_told(tmp_path):
    walk, jump = (dated(tmp_path / "data" / name, at) for name, at in (("w", 1000), ("j", 995)))
    replaced(jump, "y", 995)
    kept = kept_of(tmp_path, walk, jump)
    known = checksums.Checksums(kept)
    for one in (walk, jump):
        known.use(one, 2000 * 10**9)
    known.write()
    walk.rename(tmp_path / "data" / "other")
    jump.rename(walk)
    (tmp_path / "data" / "other").rename(jump)
    with pytest.raises(InputError, match=r"\(j, w\)"):
        file_dates.check_exchanged(kept, [])


def test_a_file_put_back_before_any_run_passes(used):
    film, kept = used
    replaced(film, "another one", 1100)
    replaced(film, "x", 1000)
    assert file_dates.check_exchanged(kept, []) is None


def test_files_and_folders_apart_are_not_looked_at(used):
    film, kept = used
    replaced(film, "another one", 900)
    for apart in (film, film.parent):
        assert file_dates.check_exchanged(kept, [apart]) is None
    with pytest.raises(InputError):
        file_dates.check_exchanged(kept, [film.with_name("b.mp4")])


def test_a_folder_has_one_line_whose_advice_mends_it(tmp_path):
    photos = [dated(tmp_path / "walk photos" / f"{at}.jpg", 1000) for at in range(5)]
    kept = kept_of(tmp_path, *photos)
    for path in photos:
        replaced(path, "another one", 900)
    with pytest.raises(InputError, match=r"\(0\.jpg, 1\.jpg, 2\.jpg and 2 more\)") as e:
        file_dates.check_exchanged(kept, [])
    assert len(e.value.lines) == 1
    if os.name == "nt":
        pytest.skip("the advice is for PowerShell, which is not the shell here")
    subprocess.run(str(e.value).rpartition(": ")[2], shell=True, check=True)
    assert file_dates.check_exchanged(kept, []) is None


def test_the_advice_for_an_exchanged_file_on_windows_is_for_powershell(used, monkeypatch):
    film, kept = used
    replaced(film, "another one", 900)
    monkeypatch.setattr(file_dates.files, "WINDOWS", True)
    with pytest.raises(InputError, match=r"Get-Item -Path '.*a\.mp4' \| ForEach-Object"):
        file_dates.check_exchanged(kept, [])
