"""The tiny study, run once for all tests that look at its results."""

import pytest

from smoke.snakemake_runs import FOLDER, ROOT, run

ASKED_FOR = (  # what the study makes only when it is asked for by name
    "results/report.html",
    "results/plain-tiny/pages/clicking.html",
    "results/walk-4cams-tiny/takes/balancing/pose2sim/file/all-robust/blazepose-full",
)


@pytest.fixture(scope="session")
def tiny_study():
    """Return the folder of the tiny study's results, made new where something changed."""
    done = run("--", "all", *ASKED_FOR, check=False)
    if done.returncode and "from the package registry" in done.stdout + done.stderr:
        pytest.skip("the pinned artefacts are neither fetched nor within reach")
    assert done.returncode == 0, done.stdout + done.stderr
    return ROOT / FOLDER / "results"
