"""The records of a run, by the real Snakefile and a figure that takes a second."""

import hashlib
import json
import shutil
import subprocess
import sys

import pytest

from smoke.snakemake_runs import FOLDER, copy_repository, planned, run

FIGURE = "results/figures/court_points.badminton.png"
COURT = "config/courts/badminton.yaml"
FILES = [f"results/figures/court_points.badminton.{kind}" for kind in ("csv", "pdf", "png")]


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """Return a copy of the repository in which one figure was drawn."""
    root = tmp_path_factory.mktemp("repository")
    copy_repository(root)
    run("--", FIGURE, root=root)
    return root


def records(root):
    """Return {file: sidecar} of all sidecars."""
    folder = root / FOLDER / "results" / "run" / "provenance"
    found = [json.loads(path.read_text()) for path in folder.rglob("*.json")]
    return {each["file"]: each for each in found}


def verify(root, *words):
    program = root / "workflow" / "verify_study.py"
    command = [sys.executable, str(program), "--directory", str(root / FOLDER), *words]
    return subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def test_the_figure_has_records_and_no_reason_to_rerun(drawn):
    found = records(drawn)
    assert sorted(found) == FILES
    for name, record in found.items():
        assert record["sha256"] == sha256(drawn / FOLDER / name)
        assert record["inputs"] == {f"../../{COURT}": sha256(drawn / COURT)}
        assert record["rule"] == "draw_court_points"
        assert list(record["code"]) == ["draw_court_points.py"]
        assert record["lock_sha256"] == sha256(drawn / "environment.lock")
        assert record["packages"]["numpy"]
    assert planned("--", FIGURE, root=drawn) == {}


def test_the_command_of_a_record_makes_that_file_again(drawn):
    name = FILES[1]
    before = {path: sha256(drawn / FOLDER / path) for path in FILES}
    (drawn / FOLDER / name).unlink()
    command = records(drawn)[name]["command"]
    assert command == f"snakemake --directory {FOLDER} --configfile config/tiny.yaml -- {name}"
    subprocess.run(f"{sys.executable} -m {command}", shell=True, cwd=drawn, check=True)
    assert {path: sha256(drawn / FOLDER / path) for path in FILES} == before


def test_results_that_came_without_snakemakes_records_are_told(drawn):
    hidden = drawn / FOLDER / ".snakemake"
    kept = hidden.rename(hidden.with_name("kept"))
    done = run("-n", "--", FIGURE, root=drawn, anew=True)
    said = done.stdout + done.stderr
    assert "Remark: results of 1 job (draw_court_points) are here, but not" in said
    assert f"verify_study.py --directory {FOLDER.as_posix()}`" in said
    assert verify(drawn).returncode == 0
    shutil.rmtree(hidden)
    kept.rename(hidden)
    done = run("-n", "--", FIGURE, root=drawn, anew=True)
    assert "Remark: results of" not in done.stdout + done.stderr


def test_a_changed_input_is_told_and_a_new_run_settles_it(drawn):
    done = verify(drawn)
    assert (done.returncode, done.stderr) == (0, "")
    court = drawn / COURT
    court.write_text(court.read_text() + "\n# measured again\n")
    lines = verify(drawn).stdout.splitlines()
    assert lines[:3] == [f"{name}: ../../{COURT} changed" for name in FILES]
    run("--", FIGURE, root=drawn)
    assert verify(drawn).returncode == 0
    assert records(drawn)[FIGURE]["inputs"] == {f"../../{COURT}": sha256(court)}


def test_a_study_that_fails_keeps_no_record_of_what_is_gone(drawn):
    script = drawn / "workflow" / "scripts" / "draw_court_points.py"
    text = script.read_text()
    script.write_text(text.replace("def main", "FAULT = 1 / 0\n\n\ndef main", 1))
    done = run("--", FIGURE, root=drawn, check=False)
    script.write_text(text)
    assert done.returncode
    assert sorted(records(drawn)) == []  # Snakemake took the old files away before it drew


def test_records_that_cannot_be_written_are_told_in_one_line(drawn):
    folder = drawn / FOLDER / "results" / "run"
    shutil.rmtree(folder)
    folder.write_text("in the way")
    done = run("--force", "--", FIGURE, root=drawn, check=False)
    folder.unlink()
    assert done.returncode
    assert "provenance not written" in done.stdout + done.stderr
    assert "Traceback" not in done.stdout + done.stderr
