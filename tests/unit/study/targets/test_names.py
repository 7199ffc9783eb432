"""A file that no rule makes: the line says what there is, and the nearest name."""

from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import pytest

from courtside.study.targets import names

KNOWN = ["all", "report", "results/report.html", "results/{session,north|south}/pages/quality.html"]
KNOWN += ["results/south/figures/errors.png", "results/{session,north|south}/{take,[a-z]+}.html"]


@pytest.mark.parametrize(
    ("target", "said"),
    [
        ("reportt", "a rule or a file that one makes, found neither; did you mean 'report'?"),
        ("results/report.htm", "found neither; did you mean 'results/report.html'?"),
        ("xyz", "found neither; see docs/results.md"),
        ("results/nort/pages/quality.html", "north, south, found 'nort'; did you mean 'north'?"),
        ("results/x/a.csv", "a session of the study, one of north, south, found 'x'; name it"),
        ("results/north/pages/qualiti.html", "did you mean 'results/north/pages/quality.html'?"),
        ("results/north/figures/errors.png", "found neither; see docs/results.md"),
        ("results/figures/errors.png", "did you mean 'results/south/figures/errors.png'?"),
    ],
)
def test_a_name_that_nothing_makes_is_told_with_the_nearest_one(target, said):
    line = names.fault(target, ["north", "south"], KNOWN)
    assert line.startswith(f"{target}: expected")
    assert said in line


@dataclass
class Rule:
    """What is asked of a rule of Snakemake."""

    name: str
    made: str

    def is_producer(self, path):
        return path == self.made

    def products(self):
        return [self.made]

    def get_wildcards(self, path):
        return {"session": path.split("/")[1], "take": Path(path).stem}


def test_rules_and_their_files_and_files_on_the_disk_are_no_fault(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.csv").touch()
    rules = [Rule("all", "none"), Rule("draw", "results/north/a.png")]
    north = SimpleNamespace(file="north.yaml", takes={"a": None, "b": None}, withheld={})
    study = SimpleNamespace(sessions={"north": north})
    wanted = ["all", "./results/north/a.png", "mine.csv"]
    assert names.faults(wanted, rules, study, []) == []
    (line,) = names.faults([*wanted, "results/north/b.png"], rules, study, ["results/north/bb.png"])
    assert line.startswith("results/north/b.png: ") and "'results/north/bb.png'" in line
    rules.append(Rule("other", "results/north/ab.png"))
    (line,) = names.faults(["results/north/ab.png"], rules, study, [])
    assert line.startswith("north.yaml: expected a take of a, b, found 'ab'; did you mean")


def test_a_rule_of_many_files_is_no_advice():
    """Snakemake refuses its name: it would not say which file is wanted."""
    rules = [Rule("draw_wrist_arcs", "results/{session}/{take}.png"), Rule("draw_tables", "a.csv")]
    study = SimpleNamespace(sessions={"north": None})
    (line,) = names.faults(["wrist_arcs"], rules, study, [])
    assert line.endswith("found neither; see docs/results.md")
    (line,) = names.faults(["draw_table"], rules, study, [])
    assert line.endswith("did you mean 'draw_tables'?")
