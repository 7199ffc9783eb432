"""What a job's log holds after a fault, by a real process."""

import subprocess
import sys
from pathlib import Path

import pytest

from courtside.study.execution import log

LIBRARY = Path(__file__).parents[4] / "workflow" / "lib"

FULL = f"""
import sys
sys.path.insert(0, {str(LIBRARY)!r})
from courtside.study.execution import log
log.to_file({{log!r}})
log.logger.info("three of nine")
with open("/dev/full", "w") as stream:
    stream.write("x")
"""


def run(tmp_path, statement):
    script = tmp_path / "script.py"
    script.write_text(
        "import sys\n"
        f"sys.path.insert(0, {str(LIBRARY)!r})\n"
        "from courtside.study.execution import log\n"
        "from courtside.study.errors import InputError\n"
        f"log.to_file({str(tmp_path / 'logs' / 'job.log')!r})\n{statement}\n"
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False)
    return done, (tmp_path / "logs" / "job.log").read_text()


def test_a_fault_of_the_user_is_one_line(tmp_path):
    done, text = run(tmp_path, "raise InputError('a.mp4: expected a video, found text')")
    assert done.returncode == 1
    assert done.stderr == ""
    assert len(text.splitlines()) == 1
    assert text.endswith("ERROR a.mp4: expected a video, found text\n")


def test_a_fault_of_the_program_keeps_its_traceback(tmp_path):
    done, text = run(tmp_path, "1 / 0")
    assert done.returncode == 1
    assert "ZeroDivisionError" in text
    assert "Traceback" in text


def test_too_little_memory_is_one_line(tmp_path):
    done, text = run(tmp_path, "import numpy; numpy.ones(1 << 45)")
    assert (done.returncode, done.stderr) == (1, "")
    assert len(text.splitlines()) == 1
    assert "ERROR expected enough memory" in text


def test_what_a_full_disk_keeps_from_the_log_goes_to_standard_error(tmp_path):
    (tmp_path / "logs").mkdir()
    (tmp_path / "logs" / "job.log").symlink_to("/dev/full")
    done = subprocess.run(
        [sys.executable, "-c", FULL.format(log=str(tmp_path / "logs" / "job.log"))],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert "ERROR a result: expected room on the disk, found: No space left" in done.stderr


def test_progress_passes_items_on_and_counts(caplog):
    with caplog.at_level("INFO", logger="courtside"):
        assert list(log.progress(range(5), 5, "cam: frames", every_s=0.0)) == [0, 1, 2, 3, 4]
    assert "cam: frames: 5 of 5" in caplog.messages[-1]


@pytest.mark.parametrize("total", [None, 3])
def test_progress_of_nothing_says_so(total, caplog):
    with caplog.at_level("INFO", logger="courtside"):
        assert list(log.progress([], total, "frames")) == []
    assert caplog.messages[-1].startswith("frames: 0")


def test_warnings_reach_the_log_and_a_run_that_ends_well_returns_zero(tmp_path):
    done, text = run(tmp_path, "import warnings; warnings.warn('thin data')")
    assert (done.returncode, done.stderr) == (0, "")
    assert "WARNING" in text
    assert "thin data" in text


def test_what_is_told_is_in_the_log_and_on_the_terminal(tmp_path):
    done, text = run(tmp_path, "log.tell('camera c1 was turned', 'check.json')")
    assert done.stderr == "Warning: camera c1 was turned; see check.json\n"
    assert text.endswith("WARNING camera c1 was turned\n")


def test_a_second_run_starts_a_new_log(tmp_path):
    run(tmp_path, "raise InputError('first')")
    _, text = run(tmp_path, "raise InputError('second')")
    assert "first" not in text
    assert len(text.splitlines()) == 1


def test_progress_speaks_only_after_the_interval(caplog, monkeypatch):
    clock = iter([0.0, 1.0, 4.0, 6.0, 8.0, 12.0, 13.0])
    monkeypatch.setattr(log.time, "monotonic", lambda: next(clock))
    with caplog.at_level("INFO", logger="courtside"):
        assert list(log.progress("abcde", None, "c1: frames", every_s=5.0)) == list("abcde")
    assert caplog.messages == [
        "c1: frames: 3, 0.5 per second",
        "c1: frames: 5, 0.4 per second",
        "c1: frames: 5, 0.4 per second",
    ]


def test_a_message_is_told_once_within_a_block_and_again_after_it(caplog):
    with log.told_once():
        for rate in (10, 10, 20, 10):
            log.logger.warning("lowered at %d frames per second", rate)
    log.logger.warning("lowered at %d frames per second", 10)
    ten, twenty = "lowered at 10 frames per second", "lowered at 20 frames per second"
    assert caplog.messages == [ten, twenty, ten]
