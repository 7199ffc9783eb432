"""A made-up default run."""

import pytest

from courtside.evaluation.numbers import register
from fixtures.study import results_made


@pytest.fixture(scope="session")
def source(tmp_path_factory):
    return register.Source(results_made.write(tmp_path_factory.mktemp("run")))


@pytest.fixture(scope="session")
def value():
    """Return the printed number of a list by its row's beginning and its part."""

    def find(numbers, row, part):
        (found,) = [n for n in numbers if n.row.startswith(row) and n.part == part]
        return found

    return find
