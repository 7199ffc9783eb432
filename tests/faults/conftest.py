"""One untouched run of the tiny study, and copies of it to hurt."""

import shutil
import time

import pytest

from faults import killing, study_copies, tally
from smoke.conftest import ASKED_FOR
from smoke.snakemake_runs import FOLDER


@pytest.fixture(scope="session")
def untouched(tmp_path_factory):
    """Return (repository with the finished tiny study, seconds of each job by its log)."""
    root = tmp_path_factory.mktemp("untouched")
    study_copies.prepare_copy(root)
    main = study_copies.start(root, "--", "all", *ASKED_FOR)
    seconds = {}
    for _, _, ended in killing.watch(main):
        seconds |= {job.log: time.monotonic() - job.started_s for job in ended}
    if main.returncode and "from the package registry" in study_copies.output(main):
        pytest.skip("the pinned artefacts are neither fetched nor within reach")
    assert main.returncode == 0, study_copies.output(main)
    return root, seconds


@pytest.fixture
def copy(untouched, tmp_path):
    """Return a copy of the finished study."""
    root = study_copies.copy_study(untouched[0], tmp_path / "study")
    yield root
    shutil.rmtree(root / FOLDER, ignore_errors=True)


@pytest.fixture
def cut(copy):
    """Return a copy of the study in which a few jobs are due, `study_copies.JOBS`."""
    for name in study_copies.JOBS.values():
        (copy / FOLDER / name).unlink()
    return copy


def pytest_terminal_summary(terminalreporter):
    if tally.ROWS:
        terminalreporter.section("faults")
        terminalreporter.write_line("\n".join(tally.table()))
