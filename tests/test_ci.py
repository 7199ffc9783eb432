"""Continuous integration: its jobs run what is here, and the audit takes no silence for success."""

import importlib.machinery
import importlib.util
import os
import re
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[1]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yaml"))
PROGRAMS = sorted(path for path in (ROOT / ".ci").iterdir() if path.is_file())


def jobs():
    """Return {job: its description} of all workflows."""
    return {
        name: job
        for path in WORKFLOWS
        for name, job in yaml.safe_load(path.read_text())["jobs"].items()
    }


def lines_of(job):
    return [line.strip() for step in job["steps"] for line in step.get("run", "").splitlines()]


def test_jobs_run_programs_that_are_here():
    called = {
        path
        for job in jobs().values()
        for line in lines_of(job)
        for path in re.findall(r"(?:\.ci|workflow)/[\w./-]+", line)
    }
    assert {".ci/run", ".ci/audit", "workflow/list_parts.py"} <= called
    for path in called:
        assert (ROOT / path).is_file(), path
    if os.name == "nt":
        pytest.skip("Windows has no mode bits")
    for path in (path for path in called if path.startswith(".ci/")):
        assert (ROOT / path).stat().st_mode & 0o111, f"{path} is not executable"


def test_the_lock_and_the_newest_versions_pass_the_same_checks():
    found = jobs()
    assert lines_of(found["lock"]) == [".ci/run"]
    *before, last = lines_of(found["newest"])
    assert last == ".ci/run"
    command = re.search(r"`(uv pip compile [^`]*)`", (ROOT / "README.md").read_text()).group(1)
    newest = next(line for line in before if line.startswith("uv pip compile"))
    assert newest == command.replace("--group test", "--upgrade --group test")


def test_both_run_weekly():
    for path in WORKFLOWS:
        triggers = yaml.safe_load(path.read_text())[True]  # YAML reads `on` so
        assert re.fullmatch(r"\d+ \d+ \* \* \d", triggers["schedule"][0]["cron"])
    assert all("timeout-minutes" in job for job in jobs().values())


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.name)
def test_programs_are_sound(path):
    text = path.read_text()
    if "python" in text.split("\n")[0]:
        compile(text, str(path), "exec")
        return
    assert "set -euo pipefail" in text
    done = subprocess.run(["bash", "-n", str(path)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.fixture(scope="module")
def audit():
    loader = importlib.machinery.SourceFileLoader("audit", str(ROOT / ".ci" / "audit"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("audit", loader))
    loader.exec_module(module)
    return module


CLEAN = {"name": "a", "version": "1", "vulns": []}
SKIPPED = {"name": "b", "skip_reason": "Dependency not found"}
FAULTY = {"name": "c", "version": "2", "vulns": [{"id": "CVE-1", "fix_versions": ["2.1", "3"]}]}


@pytest.mark.parametrize(
    ("packages", "status", "message"),
    [
        ([CLEAN], 0, "1 of 1 packages looked up, 0 vulnerable"),
        ([CLEAN, FAULTY], 1, "c 2: CVE-1, mended in 2.1, 3"),
        ([SKIPPED, FAULTY], 1, "1 of 2 packages looked up, 1 vulnerable"),
        ([CLEAN, SKIPPED], 2, "not looked up: b"),
        ([SKIPPED, SKIPPED], 2, "the advisory service cannot be reached from here"),
        ([], 2, "0 of 0 packages"),
    ],
)
def test_only_what_was_looked_up_is_sound(audit, packages, status, message):
    lines, found = audit.judge(packages)
    assert found == status
    assert any(message in line for line in lines)
