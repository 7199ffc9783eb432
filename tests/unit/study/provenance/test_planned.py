"""What a run would make is told by the workflow, with or without Snakemake's own records."""

import json
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from courtside.study.errors import InputError
from courtside.study.provenance import planned

LIBRARY = Path(planned.__file__).parents[3]
SNAKEFILE = f"""
import atexit, sys, types
sys.path.insert(0, {str(LIBRARY)!r})
from courtside.study.provenance import planned
atexit.register(lambda: planned.tell(workflow, types.SimpleNamespace(sessions={{}})))
configfile: "config.yaml"
rule all:
    input: "b.txt"
rule measure:
    output: "a.txt"
    params: step={{"width": config["width"], "sizes": (1, 2)}}
    shell: "echo a > {{output}}"
rule draw:
    input: "a.txt"
    output: "b.txt"
    shell: "echo b > {{output}}"
rule apart:
    output: "c.txt"
    params: n=1
    shell: "echo c > {{output}}"
"""


@pytest.fixture
def ran(tmp_path, monkeypatch):
    """Go to a folder where a small workflow ran."""
    monkeypatch.chdir(tmp_path)
    Path("Snakefile").write_text(SNAKEFILE)
    Path("config.yaml").write_text("width: 3\n")
    words = [sys.executable, "-m", "snakemake", "--cores", "1", "--quiet", "all"]
    subprocess.run(words, check=True, capture_output=True)


def test_settings_of_all_steps_before_a_file_are_told(ran):
    plan = planned.ask(["snakemake"], ".")
    measured = {"measure": [{"step": {"width": 3, "sizes": [1, 2]}}]}
    assert plan == planned.Plan({"a.txt": measured, "b.txt": measured}, frozenset())
    Path("config.yaml").write_text("width: 4\n")
    plan = planned.ask(["snakemake"], ".")
    assert plan.pending == {"a.txt", "b.txt"}
    shutil.rmtree(".snakemake")
    without = planned.ask(["snakemake"], ".")
    assert (without.settings, without.pending) == (plan.settings, set())
    assert planned.changes(measured, without.settings["b.txt"]) == {"measure": ["step"]}
    assert set(planned.ask(["snakemake"], ".", ["c.txt"]).settings) == {"c.txt"}


def test_a_refused_command_is_an_error(ran):
    with pytest.raises(InputError, match="MissingRule"):
        planned.ask(["snakemake"], ".", ["nothing.txt"])


def test_settings_that_differ_are_named_by_rule():
    one = {"draw": [{"seed": 1, "size": 2}], "same": [{"x": 1}], "gone": [{"a": 1}]}
    other = {"draw": [{"seed": 1, "size": 3}, {"seed": 1, "size": 2}], "same": [{"x": 1}]}
    assert planned.changes(one, other) == {"draw": ["size"], "gone": ["a"]}


def test_a_setting_without_a_value_that_is_new_is_named():
    assert planned.changes({"fit": [{"a": 1}]}, {"fit": [{"a": 1, "b": None}]}) == {"fit": ["b"]}


def test_other_combinations_of_the_same_values_name_all_settings():
    one = [{"a": 1, "b": 1}, {"a": 2, "b": 2}]
    other = [{"a": 1, "b": 2}, {"a": 2, "b": 1}]
    assert planned.changes({"fit": one}, {"fit": other}) == {"fit": ["a", "b"]}


def test_results_that_snakemake_has_no_records_of_are_told_in_one_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("a.txt", "b.txt", "c.txt"):
        Path(name).touch()
    names = {"draw": "a.txt", "fit": "b.txt", "cut": "c.txt", "lift": "none.txt"}
    jobs = [SimpleNamespace(rule=SimpleNamespace(name=n), output=[p]) for n, p in names.items()]
    dag = SimpleNamespace(jobs=jobs, needrun=lambda job: job.rule.name == "cut")
    records = SimpleNamespace(metadata={"b.txt": 1}.get)
    (line,) = planned.unseen(SimpleNamespace(dag=dag, persistence=records), tmp_path)
    assert line.startswith("Remark: results of 1 job (draw) are here, but not Snakemake's records")
    assert "`python workflow/verify_study.py` tells" in line
    (line,) = planned.unseen(SimpleNamespace(dag=dag, persistence=records), tmp_path.parent)
    assert f"verify_study.py --directory {tmp_path.name}` tells" in line
    records = SimpleNamespace(metadata=lambda path: json.dumps(path))
    assert planned.unseen(SimpleNamespace(dag=dag, persistence=records), tmp_path) == []
    assert planned.unseen(SimpleNamespace(dag=None, persistence=None), tmp_path) == []
