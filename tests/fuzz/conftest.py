"""The table of what came of the changed files, at the end of the run."""

import pytest

from fuzz import watch

RESULTS = pytest.StashKey()


@pytest.fixture(scope="session")
def results(request):
    """Return the list that every format adds its result to."""
    return request.config.stash.setdefault(RESULTS, [])


@pytest.fixture(scope="session")
def watched(tmp_path_factory):
    """Give the process that reads, and end it after all."""
    made = watch.Watched(tmp_path_factory.mktemp("fuzz"))
    yield made
    made.stop()


def pytest_terminal_summary(terminalreporter, config):
    """Print the table."""
    found = config.stash.get(RESULTS, [])
    if found:
        terminalreporter.write_sep("=", "changed files")
        for line in watch.table(found):
            terminalreporter.write_line(line)
