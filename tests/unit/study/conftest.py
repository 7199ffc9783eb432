"""The tiny study, checked once, and jobs of it."""

from pathlib import Path

import pytest

from courtside.study.configuration import configuration, yaml_files
from courtside.study.jobs.job import Job
from fixtures.study import yaml_read

CONFIG = Path(__file__).parents[3] / "config"
PARSING = "test_yaml_files.py"  # the tests of parsing itself


@pytest.fixture(scope="module", autouse=True)
def parsed_once(request):
    """Parse each configuration file only once, where parsing is not what is tested."""
    if request.path.name == PARSING:
        yield
    else:
        with yaml_read.remembered():
            yield


def load(**changes):
    """Return the study of config/tiny.yaml with other values of some keys."""
    config = yaml_files.read(CONFIG / "config.yaml") | yaml_files.read(CONFIG / "tiny.yaml")
    return configuration.load(config | changes, "config/tiny.yaml", CONFIG)


@pytest.fixture(scope="session")
def study():
    """Return the tiny study: walk-4cams-tiny (real), plain-tiny, players-tiny, single-view-tiny."""
    return load()


@pytest.fixture(scope="session")
def studies():
    """Return a function that gives the tiny study with other values of some keys."""
    return load


@pytest.fixture
def job(study):
    """Return a function that gives the job of some wildcards, of the tiny study or another."""
    return lambda of=study, **wildcards: Job(of, wildcards)
