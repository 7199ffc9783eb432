"""Views hold headings and places for numbers; no number is typed into a cell."""

import re

import pytest

from courtside.evaluation.numbers.document_tables import FIELD
from courtside.evaluation.numbers.views import VIEWS


def typed(pattern):
    """Return the digits of a pattern that no number of the register gives."""
    return re.findall(r"\d+", FIELD.sub("", pattern))


@pytest.mark.parametrize("name", VIEWS)
def test_cells_take_all_numbers_from_the_register(name):
    assert [p for p in VIEWS[name].columns.values() if typed(p)] == []
    assert next(iter(VIEWS[name].columns.values())) == "{row}"


@pytest.mark.parametrize("name", VIEWS)
def test_raw_values_are_not_counted_for_corrected_errors(name):
    """The filter leaves values out and fills gaps, so that each stage has its own number."""
    cells = VIEWS[name].columns.values()
    counted = [c for c in cells if re.search(r"\{raw_\w+\.n\}", c)]
    if any("{corrected_" in c for c in cells):
        assert all("{corrected_" in c for c in counted)


def test_a_typed_number_is_found():
    assert typed("{a18} / {b_p95}") == []
    assert typed("{a} / 1.19") == ["1", "19"]
