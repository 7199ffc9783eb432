"""Programs that somebody starts outside the environment."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]


@pytest.mark.parametrize("program", sorted(path.name for path in ROOT.glob("workflow/*.py")))
def test_without_its_packages_a_program_says_so_in_one_line(program):
    # -I -S: neither this folder nor installed packages
    command = [sys.executable, "-I", "-S", f"workflow/{program}"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert line.endswith("activate the environment that README.md installs")


def test_with_its_packages_it_goes_on():
    command = [sys.executable, "workflow/draft_session.py", "--help"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0 and "usage" in done.stdout
