"""The tiny study, run once for all tests that look at its results."""

import pytest

from fixtures.study import once
from smoke.snakemake_runs import FOLDER, ROOT, copy_repository, run

ASKED_FOR = (  # what the study makes only when it is asked for by name
    "results/report.html",
    "results/plain-tiny/pages/clicking.html",
    "results/walk-4cams-tiny/calibration/file/other_programs",
    "results/walk-4cams-tiny/takes/balancing/pose2sim/file/all-robust/blazepose-full",
)


@pytest.fixture(scope="session")
def tiny_study(run_folder):
    """Return the folder of the tiny study's results, made new where something changed.

    Of several processes one runs it, and the others wait for it.
    """
    fault = once.made_once(run_folder, "tiny_study", fault_of_study)
    if "from the package registry" in fault:
        pytest.skip("the pinned artefacts are neither fetched nor within reach")
    assert fault == ""
    return ROOT / FOLDER / "results"


def fault_of_study():
    """Run the tiny study; return what Snakemake said where it failed."""
    done = run("--", "all", *ASKED_FOR, check=False, anew=True)
    return done.stdout + done.stderr if done.returncode else ""


@pytest.fixture(scope="session")
def kept(tiny_study, tmp_path_factory):
    """Return a repository copy with the tiny study's results, for tests that leave it unchanged."""
    root = tmp_path_factory.mktemp("kept")
    copy_repository(root, FOLDER)
    return root
