"""The register of numbers: what is kept comes back, what changed is told, what lacks is named."""

import math
from dataclasses import replace

import pandas as pd
import pytest

from courtside.evaluation.numbers import register
from courtside.study.errors import InputError


@pytest.fixture
def built(tmp_path):
    pd.DataFrame({"a": [0.123456789, None]}).to_csv(tmp_path / "t.csv", index=False)
    build = register.Builder("joints")
    cut = register.Cut(register.Source(tmp_path), "t.csv", "row 1", "plain-a")
    build.add("`s/t`: all", "median", 0.123456789, cut, "a", unit="cm", n=90, n_failed=2)
    build.add("`s/t`: all", "p95", math.nan, cut, "a")
    return build.numbers


def test_a_register_comes_back_as_it_was_written(tmp_path, built):
    register.write(tmp_path / "numbers.csv", built)
    median, p95 = register.read(tmp_path / "numbers.csv")
    assert median == replace(built[0], value=0.12345679)
    assert (median.name, median.printed) == ("joints/median/`s/t`: all", "0.12")
    assert (median.n, median.n_failed, p95.n, p95.printed) == (90, 2, None, "-")
    assert median.selector == "row 1; a" and len(median.sha256) == 16 and math.isnan(p95.value)


def test_two_numbers_of_one_name_are_refused(tmp_path, built):
    with pytest.raises(InputError, match="two numbers are called joints/median"):
        register.write(tmp_path / "numbers.csv", [*built, built[0]])


def test_a_damaged_register_is_refused_in_one_line(tmp_path):
    path = tmp_path / "numbers.csv"
    path.write_text("name,printed\njoints/median,1\n")
    with pytest.raises(InputError, match="expected a register of numbers"):
        register.read(path)


def test_numbers_that_changed_came_or_went_are_told(built):
    changed = replace(built[0], printed="0.13", value=0.13)
    new = replace(built[0], row="other")
    assert register.stale(built, built) == []
    assert register.stale(built, [replace(built[0], value=0.1235), built[1]]) == []
    assert register.stale(built, [changed, new]) == [
        "joints/median/`s/t`: all: printed 0.12, would be 0.13",
        "joints/p95/`s/t`: all: printed -, would be no longer measured",
        "joints/median/other: printed not in the register, would be 0.12",
    ]


def test_a_missing_table_is_named(tmp_path):
    source = register.Source(tmp_path)
    with pytest.raises(InputError, match=r"figures/players.csv: expected this table"):
        source.table("figures/players.csv")
    with pytest.raises(InputError, match=r"known\*.csv: expected tables"):
        source.names("known*.csv")


def test_the_checksum_of_several_files_changes_with_each(tmp_path):
    for name in "ab":
        (tmp_path / f"{name}.csv").write_text(name)
    before = register.Source(tmp_path).sha256("*.csv")
    (tmp_path / "b.csv").write_text("c")
    assert register.Source(tmp_path).sha256("*.csv") != before


@pytest.mark.parametrize(
    ("value", "text"), [(-0.001, "0.00"), (-0.17, "-0.17"), (math.nan, "-"), (1.005e3, "1005.00")]
)
def test_numbers_are_printed_rounded(value, text):
    assert register.printed(value, 2) == text


def test_texts_are_read_as_they_stand(tmp_path):
    (tmp_path / "t.csv").write_text("printed,n\n86.0,12\n-,\n")
    rows = register.Source(tmp_path).texts("t.csv")
    assert rows.to_numpy().tolist() == [["86.0", "12"], ["-", ""]]


def test_a_summary_is_listed_row_by_row(tmp_path):
    table = pd.DataFrame({"who": ["a", "b"], "error_mm": [1.25, 2.0], "n": [3, 4]})
    table.to_csv(tmp_path / "t.csv", index=False)
    cut = register.Cut(register.Source(tmp_path), "t.csv", "by who", "s")
    rows = {row["who"]: row for _, row in table.iterrows()}
    found = register.listed(cut, "who", rows, {"error": ("error_mm", 1, "mm")})
    assert [(n.name, n.printed, n.n) for n in found] == [
        ("who/error/a", "1.2", 3),
        ("who/error/b", "2.0", 4),
    ]
