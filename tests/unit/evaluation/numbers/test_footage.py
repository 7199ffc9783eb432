"""Raw and corrected joints stand side by side, for virtual takes as for real ones."""

from pathlib import Path

from courtside.evaluation.numbers import footage, register

ROOT = Path(__file__).parents[4]


def test_each_reference_is_named_and_has_all_three_stages(source):
    documents = register.Source(ROOT)
    rows = {}
    for number in footage.corrections(source, documents):
        rows.setdefault(number.row, set()).add(number.part.split("_")[0])
    assert len(rows) >= 3
    assert all(" against " in row for row in rows)
    assert all(stages == {"raw", "filtered", "corrected"} for stages in rows.values())
