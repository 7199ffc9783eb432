"""Tables between markers are those of the register."""

import pytest

from courtside.evaluation.numbers import document_tables, register
from courtside.evaluation.numbers.document_tables import View
from courtside.study.errors import InputError

TEXT = "Before.\n\n<!-- table: joints -->\nold\n<!-- end -->\n\nAfter 12.\n"


def number(row, part, printed, n=None):
    texts = {"unit": "", "source": "", "selector": "", "sessions": "", "command": "", "sha256": ""}
    about = {"table": "joints", "row": row, "part": part, "printed": printed, "value": 0.0}
    return register.Number(**about, **texts, n=n, n_failed=None, origin=register.STUDY)


NUMBERS = [number("one", "a", "1.0", 9), number("one", "b", "2.0"), number("two", "b", "3.0")]
VIEW = View("joints", {"what": "{row}", "both": "{a} / {b}", "first": "{a} mm", "n": "{a.n}"})


def test_a_table_is_written_between_its_markers_and_nothing_else_changes():
    filled = document_tables.fill(TEXT, {"joints": VIEW}, NUMBERS)
    assert filled == TEXT.replace(
        "old\n",
        "| what | both | first | n |\n| --- | --- | --- | --- |\n"
        "| one | 1.0 / 2.0 | 1.0 mm | 9 |\n| two | - / 3.0 | | |\n",
    )
    assert document_tables.fill(filled, {"joints": VIEW}, NUMBERS) == filled


def test_a_view_shows_the_rows_that_it_asks_for():
    shown = document_tables.render(View("joints", {"what": "{row}"}, "^tw"), NUMBERS)
    assert shown.splitlines()[2:] == ["| two |"]
    with pytest.raises(InputError, match="found none"):
        document_tables.render(View("joints", {"what": "{row}"}, "three"), NUMBERS)


def test_a_number_that_is_not_in_the_register_is_refused():
    with pytest.raises(InputError, match="expected c in the table joints"):
        document_tables.render(View("joints", {"what": "{c}"}), NUMBERS)


@pytest.mark.parametrize(
    ("text", "words"),
    [(TEXT.replace("joints", "other"), "found other"), (TEXT.replace("end", "x"), "1 markers")],
)
def test_unknown_tables_and_open_markers_are_refused(text, words):
    with pytest.raises(InputError, match=words):
        document_tables.fill(text, {"joints": VIEW}, NUMBERS)
