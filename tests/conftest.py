"""How the tests share processes, and the folder of what one process makes for all.

A file stays in one process, as do files that share bodies or a study.
"""

import os
import sys
from pathlib import PurePosixPath

import pytest
from xdist.scheduler import LoadFileScheduling

from fixtures.study import once

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # as in the study; a third less time than with threads
# Hundreds of jobs and programs import the library: let the first keep its bytecode.
os.environ["PYTHONDONTWRITEBYTECODE"], sys.dont_write_bytecode = "", False

# Files and folders. The two files come first and make the tiny study: in one scope they keep their
# process, so that no other file waits behind the study. What else reads the study comes last: it
# waits until the study is made (smoke/conftest.py).
ONE_STUDY = {"test_data_dictionary.py", "test_smoke.py", "faults", "slurm"}
# Folders whose files use the same bodies or filmed motions: each process makes these only once.
SHARING = ("unit/virtualgym/body", "unit/virtualgym/movement")


class ByStudy(LoadFileScheduling):
    """Gives a process the tests of one file, of a folder of `SHARING`, or of the one study."""

    def _split_scope(self, nodeid):
        return _scope(nodeid)


def pytest_collection_modifyitems(items):
    reading = {item.path for item in items if "tiny_study" in item.fixturenames}
    items.sort(key=lambda item: (_scope(item.nodeid) != "study", item.path in reading))


def _scope(nodeid):
    file = PurePosixPath(nodeid.partition("::")[0])
    if ONE_STUDY.intersection(file.parts):
        return "study"
    return next((folder for folder in SHARING if f"/{folder}/" in f"/{file}"), str(file))


def pytest_xdist_make_scheduler(config, log):
    config.option.loadscopereorder = False  # the study comes first, and takes longest
    return ByStudy(config, log)


@pytest.fixture(scope="session")
def run_folder(request, tmp_path_factory):
    """Return the folder that all processes of this test run share."""
    return once.folder_of_run(request.config, tmp_path_factory)
