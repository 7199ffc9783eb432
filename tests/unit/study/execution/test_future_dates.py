"""Files dated in the future are told before any job runs."""

import os
import subprocess
import time

import pytest

from courtside.study.errors import InputError
from courtside.study.execution import future_dates

DAY_S = 86400.0


def dated(path, when_s):
    path.parent.mkdir(exist_ok=True)
    path.write_text("x")
    os.utime(path, (when_s, when_s))
    return path


def test_files_of_the_past_and_missing_folders_pass(tmp_path):
    dated(tmp_path / "data" / "old.mp4", time.time() - 7000 * DAY_S)
    dated(tmp_path / "data" / "now.mp4", time.time())
    assert future_dates.check([tmp_path / "data", tmp_path / "none"]) is None


def test_a_file_that_is_named_counts_once(tmp_path):
    late = dated(tmp_path / "disk" / "late.mp4", time.time() + DAY_S)
    dated(tmp_path / "disk" / "other.mp4", time.time() + DAY_S)
    with pytest.raises(InputError, match=r"late\.mp4: expected a date in the past.*in 0 more"):
        future_dates.check([late, late, tmp_path / "disk" / "missing.mp4"])


def test_the_file_furthest_ahead_is_named_and_the_advice_mends_it(tmp_path):
    dated(tmp_path / "data" / "near.mp4", time.time() + DAY_S)
    dated(tmp_path / "data" / "far.mp4", time.time() + 400 * DAY_S)
    with pytest.raises(
        InputError, match=r"far\.mp4: expected a date in the past.*as in 1 more;"
    ) as e:
        future_dates.check([tmp_path / "data"])
    assert "\n" not in str(e.value)
    if os.name == "nt":
        pytest.skip("the advice is for PowerShell, which is not the shell here")
    subprocess.run(str(e.value).rpartition(": ")[2], shell=True, check=True)
    assert future_dates.check([tmp_path / "data"]) is None


def test_the_advice_on_windows_is_for_powershell(tmp_path, monkeypatch):
    monkeypatch.setattr(future_dates.files, "WINDOWS", True)
    dated(tmp_path / "data" / "far.mp4", time.time() + DAY_S)
    with pytest.raises(InputError, match=r"today's date: Get-ChildItem -LiteralPath '.*data' -Rec"):
        future_dates.check([tmp_path / "data"])


@pytest.mark.skipif(os.name == "nt", reason="links need a right of their own")
def test_a_link_that_leads_nowhere_is_no_concern_of_dates(tmp_path):
    (tmp_path / "lost").symlink_to(tmp_path / "nothing")
    assert future_dates.check([tmp_path]) is None
