"""All formats: each changed file gives a value or one clear line.

It does so within seconds, memory and its folder.
"""

import os

import pytest

from fuzz import formats

pytestmark = [
    pytest.mark.fuzz,
    pytest.mark.skipif(os.name == "nt", reason="the memory of the reader is limited by POSIX"),
]

SEED = 1


@pytest.mark.parametrize("name", list(formats.FORMATS))
def test_changed_files_end_in_a_value_or_one_line(name, watched, results):
    result = watched.run(name, SEED, range(formats.FORMATS[name].cases))
    results.append(result)
    assert result.failures == [], "\n".join(result.failures)
    assert result.cases == formats.FORMATS[name].cases
    assert result.values and bool(result.refused) == formats.FORMATS[name].refuses
