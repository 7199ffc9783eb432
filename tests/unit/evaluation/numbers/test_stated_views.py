"""Views of stated numbers say who measured them."""

from courtside.evaluation.numbers.document_tables import cell
from courtside.evaluation.numbers.register import BENCHMARK, Number
from courtside.evaluation.numbers.stated_views import made


def test_a_row_says_by_whom_and_with_what_a_part_of_it_was_measured():
    texts = {"unit": "", "source": "", "selector": "", "sessions": "", "sha256": ""}
    made_by = {"n": None, "n_failed": None, "origin": BENCHMARK, "command": "speed.py"}
    found = Number("speed", "largest", "found", "2", 2.0, **texts, **made_by)
    shown = {head: cell(text, "largest", {"found": found}) for head, text in made("found").items()}
    assert shown == {"by": BENCHMARK, "with": "speed.py"}
