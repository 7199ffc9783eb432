"""The tables of README.md and docs/measured/ are what the register of numbers gives."""

import functools
import re
import subprocess
import sys
from pathlib import Path

import pytest

from courtside.evaluation.numbers import document_tables, register, study
from courtside.evaluation.numbers.views import VIEWS
from fixtures.study import results_made

ROOT = Path(__file__).parents[1]
MEASURED = r"\d (%|mm|cm|m/s|px|us|s)\b|\d / \d"  # values as tables of results show them


@functools.cache
def numbers():
    """Return the register, which takes a while to read: not at the collection of tests."""
    return study.kept(ROOT)


@pytest.mark.parametrize("name", study.documents(ROOT))
def test_tables_are_exactly_those_of_the_register(name):
    assert (ROOT / name).read_text(encoding="utf-8") == study.filled(numbers(), ROOT)[name]


def test_every_table_of_the_register_is_shown_and_every_view_used():
    texts = [(ROOT / name).read_text(encoding="utf-8") for name in study.documents(ROOT)]
    shown = {name for text in texts for name in document_tables.names(text)}
    assert shown == set(VIEWS)
    assert {VIEWS[name].table for name in shown} == {number.table for number in numbers()}


def test_the_documents_have_no_table_of_numbers_outside_the_markers():
    for name in study.documents(ROOT):
        text = document_tables.BLOCK.sub("", (ROOT / name).read_text(encoding="utf-8"))
        rows = re.findall(r"^\| .* \|$", text, flags=re.M)
        assert [row for row in rows if re.search(MEASURED, row)] == []


def test_every_number_says_where_it_comes_from():
    assert len({number.name for number in numbers()}) == len(numbers()) > 1000
    for number in numbers():
        assert number.origin in register.ORIGINS and number.source and number.sha256
        assert number.command or number.origin in (register.STUDY, register.PUBLISHED)
        assert number.sessions or number.origin != register.STUDY


def test_selectors_name_what_tells_rows_of_one_file_apart():
    """Clicks twice and three times as bad, and differences of rackets, are in the same files."""
    for number in numbers():
        if number.origin == register.STUDY and number.table.startswith(
            ("calibration", "published")
        ):
            assert "in-sample" in number.selector and "click_strength" in number.selector
        if number.source == "figures/badminton_fig12.csv":
            assert "tips empty" in number.selector


def test_published_numbers_are_those_of_their_tables():
    documents = register.Source(ROOT)
    for number in numbers():
        if number.source.startswith("config/"):
            assert number.sha256 == documents.sha256(number.source), number.source


def test_the_halls_that_the_text_names_are_those_whose_interval_contains_0():
    text = (ROOT / "docs" / "measured" / "calibration_by_walk.md").read_text(encoding="utf-8")
    halls = text.split("<!-- table: halls -->")[1].split("<!-- end -->")[0]
    ends = re.findall(r"^\| `(\S+)`.*\((\S+) to (\S+)\) \|$", halls, flags=re.M)
    named = re.search(r"interval of the difference contains 0 in [^(]*\(([^)]*)\)", text)[1]
    open_halls = {name for name, low, high in ends if float(low) <= 0 <= float(high)}
    assert len(ends) == 6 and set(re.findall("`(.*?)`", named)) == open_halls


def test_the_readme_tells_the_two_re_enacted_walks_apart_with_the_numbers_of_the_register():
    text = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    halls = {f"`{name}` (plain hall, layout {name[-1]})": name for name in ("plain-a", "plain-b")}
    of = {
        (n.part, halls[n.row]): n for n in numbers() if n.table == "calibration" and n.row in halls
    }
    walk = of["paper", "plain-a"]
    assert f"({walk.n_failed} of its {walk.n + walk.n_failed} trials in `plain-a` failed" in text
    a, b = (of["paper_global", name].printed for name in halls.values())
    assert f"[{a} cm in `plain-a`, {b} cm in `plain-b`]" in text


def program(path, *words):
    command = [sys.executable, str(ROOT / path), *map(str, words)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def test_verify_study_lists_the_numbers_that_other_results_change(tmp_path):
    results_made.write(tmp_path / "results")
    done = program("workflow/verify_study.py", "--directory", tmp_path, "--numbers")
    assert (done.returncode, done.stderr) == (1, "")
    printed = next(n.printed for n in numbers() if n.name == WALK)
    assert f"{WALK}: printed {printed}, would be 0.65" in done.stdout.splitlines()


def test_results_that_lack_a_table_change_nothing_and_are_told_in_one_line(tmp_path):
    before = (ROOT / study.REGISTER).read_bytes()
    done = program("docs/make_tables.py", tmp_path)
    assert done.returncode == 1 and (ROOT / study.REGISTER).read_bytes() == before
    (line,) = done.stderr.splitlines()
    assert line.startswith("Error: ") and "figures/calibration.csv" in line


WALK = "calibration/walk18/`plain-a` (plain hall, layout a)"
