"""Machine faults of a study: full and closed disks, little memory, odd clocks, two runs at once."""

import contextlib
import os
import random
import re
import subprocess
import time

import psutil
import pytest

from faults import killing, study_copies
from faults.study_copies import CUT, JOBS, output, start
from faults.tally import tries
from smoke.conftest import ASKED_FOR
from smoke.snakemake_runs import FOLDER, planned, run

resource = pytest.importorskip("resource", reason="needs mounts and limits of POSIX")
pytestmark = pytest.mark.fault
ALL = ("--", "all", *ASKED_FOR)
YEAR_S = 365 * 86400
ROOM_BYTES = 60 << 20


@contextlib.contextmanager
def mounted(folder, *options):
    """Mount something on a folder, or skip the test where this is not allowed."""
    done = subprocess.run(["mount", *options, folder], capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip(f"needs the right to mount: {done.stderr.strip()}")
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", folder], check=True)


@contextlib.contextmanager
def closed(folder):
    """Make a folder read-only, even for root."""
    with mounted(folder, "--bind", folder):
        subprocess.run(["mount", "-o", "remount,ro,bind", folder], check=True)
        yield


@pytest.fixture
def on_small_disk(cut, tmp_path):
    """Return a copy of the study, with a few jobs due, on a disk of its own with little room."""
    disk = tmp_path / "disk"
    disk.mkdir()
    with mounted(disk, "-t", "tmpfs", "tmpfs"):
        root = study_copies.copy_study(cut, disk / "study")
        used = psutil.disk_usage(str(disk)).used
        subprocess.run(["mount", "-o", f"remount,size={used + ROOM_BYTES}", disk], check=True)
        yield root


@contextlib.contextmanager
def filled(root):
    """Fill the disk of a study to the last byte."""
    filler = root.parent / "filler"
    try:
        with contextlib.suppress(OSError), filler.open("wb", buffering=0) as stream:
            while True:
                stream.write(bytes(1 << 16))
        with contextlib.suppress(OSError), filler.open("ab", buffering=0) as stream:
            while True:
                stream.write(b"x")
        yield
    finally:
        filler.unlink()


def first_job(main, rule):
    """Return the job of a rule as soon as it has begun."""
    for _, begun, _ in killing.watch(main):
        for job in begun:
            if job.rule == rule:
                return job
    raise AssertionError(output(main))


def assert_one_line(main, *words):
    """Check that a run failed and said why in one line, without a traceback."""
    assert main.wait() != 0
    text = output(main)
    assert "Traceback" not in text, text
    assert any(all(word in line for word in words) for line in text.splitlines()), text


def assert_survived(root, untouched):
    """Run the cut again: it must end with the results of the untouched run, and nothing else."""
    main = start(root, "--", *CUT)
    assert main.wait() == 0, output(main)
    assert all((root / FOLDER / name).is_file() for name in CUT)
    assert study_copies.differences(root, untouched[0]) == []
    assert planned("--", *CUT, root=root) == {}


def test_a_disk_full_before_the_run_is_one_line(on_small_disk, untouched):
    with tries("full disk, before the run"):
        with filled(on_small_disk):
            assert_one_line(
                start(on_small_disk, "--", *CUT), "Error: ", "MB free", "free some room"
            )
        assert_survived(on_small_disk, untouched)


def test_a_disk_full_during_a_job_is_one_line(on_small_disk, untouched):
    with tries("full disk, during a job", len(JOBS)):
        for rule, product in JOBS.items():
            main = start(on_small_disk, "--", product, cores=1)
            first_job(main, rule)
            with filled(on_small_disk):
                assert_one_line(main, f"  {rule}: ")
                text = output(main)
                assert "No space left on device" in text or "free or allow" in text
                assert "its log is empty" not in text and "run.smk" not in text
        assert_survived(on_small_disk, untouched)


@pytest.mark.parametrize("name", ["results", "."])
def test_a_closed_folder_is_one_line(cut, untouched, name):
    folder = cut / FOLDER / name
    with tries(f"read-only {'results' if name == 'results' else 'folder of the study'}"):
        with closed(folder):
            assert_one_line(start(cut, "--", *CUT), "read-only", "same command again")
        assert_survived(cut, untouched)


def test_too_little_memory_is_one_line(cut, untouched):
    with tries("out of memory, during a job", 2):
        for rule in ("draw_skeletons", "draw_overlay"):
            main = start(cut, "--", JOBS[rule], cores=1)
            job = first_job(main, rule)
            leave_no_memory(cut / FOLDER / job.log, job)
            assert_one_line(main, f"  {rule}: ", "--cores 1")
        assert_survived(cut, untouched)


def leave_no_memory(log, job):
    """Let a job have no more memory than it has when its log begins, which is after its imports."""
    while (
        job.process.is_running() and not log.is_file()
    ):  # Snakemake deletes the log of an earlier run
        time.sleep(0.005)
    for process in (job.process, *job.process.children(recursive=True)):
        limit = process.memory_info().vms
        process.rlimit(psutil.RLIMIT_AS, (limit, resource.RLIM_INFINITY))


def shift(paths, seconds):
    """Move the dates of files by some seconds, each by its own."""
    for path in paths:
        when_s = time.time() + seconds()
        os.utime(path, (when_s, when_s), follow_symlinks=False)


def test_inputs_of_long_ago_are_inputs(cut, untouched):
    with tries("inputs dated long ago"):
        shift(of_inputs(cut), lambda: -20 * YEAR_S)
        assert_survived(cut, untouched)
        assert planned(*ALL, root=cut) == {}


def test_inputs_of_the_future_are_one_line(cut, untouched):
    with tries("inputs dated in the future"):
        shift(of_inputs(cut), lambda: YEAR_S)
        main = start(cut, "--", *CUT)
        assert_one_line(main, "Error: ", "expected a date in the past", "touch")
        advice = re.search(r"find .*touch {} \+", output(main)).group(0)
        subprocess.run(advice, shell=True, cwd=cut / FOLDER, check=True)
        assert_survived(cut, untouched)
        assert planned(*ALL, root=cut) == {}


def of_inputs(root):
    """Return the files that a study reads and does not make."""
    folders = [root / "config", root / FOLDER / "results" / "external"]
    return [path for folder in folders for path in folder.rglob("*") if path.is_file()]


def test_a_clock_that_jumped_reruns_nothing(copy):
    draw = random.Random(7)
    files = [path for path in (copy / FOLDER / "results").rglob("*") if known_by_content(path)]
    assert len(files) > 300
    with tries("clock that jumped, each file by its own"):
        shift(files, lambda: draw.uniform(0, YEAR_S))
        assert planned(*ALL, root=copy) == {}


def known_by_content(path):
    """Return whether Snakemake looks into a file of a new date: not inside an output folder.

    What is fetched from outside has a test of its own above.
    """
    of_folder = any((folder / ".snakemake_timestamp").exists() for folder in path.parents)
    return path.is_file() and not of_folder and "external" not in path.parts


def test_of_two_runs_at_once_the_second_stops(cut, untouched):
    with tries("two runs at once"):
        first = start(cut, "--", *CUT)
        first_job(first, "triangulate")
        second = run("--", *CUT, root=cut, check=False, anew=True)
        assert second.returncode != 0
        assert "Directory cannot be locked" in second.stdout + second.stderr
        assert "--unlock" in second.stdout + second.stderr
        assert first.wait() == 0, output(first)
        assert_survived(cut, untouched)
