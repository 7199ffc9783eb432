"""Each change is told once for each file that it reaches, and for no other."""

import json
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from courtside.study.errors import InputError
from courtside.study.execution import checksums, digest
from courtside.study.provenance import environment, planned, provenance, verification

PROGRAM = Path(__file__).parents[4] / "workflow" / "verify_study.py"
FIGURE, ALONE = "results/figures/f.pdf", "results/figures/alone.csv"
LIBRARY = str(Path(planned.__file__).parents[3])
ASK = planned.ask
SNAKEFILE = """
import atexit, sys, types
sys.path.insert(0, LIBRARY)
from courtside.study.provenance import planned
atexit.register(lambda: planned.tell(workflow, types.SimpleNamespace(sessions={})))
configfile: "config.yaml"
rule all:
    input: "results/figures/f.pdf", "results/figures/alone.csv"
rule draw:
    input: "a.mp4", "net.onnx"
    output: "results/figures/f.pdf"
    params: width=config["width"]
    shell: "echo draw > {output}"
rule tabulate:
    input: "b.mp4"
    output: "results/figures/alone.csv"
    shell: "echo tabulate > {output}"
""".replace("LIBRARY", repr(LIBRARY))


@pytest.fixture
def study(tmp_path, monkeypatch):
    """Go to a made-up repository where a study ran; Snakemake, which is slow, is not asked."""
    monkeypatch.chdir(tmp_path)
    nothing = planned.Plan({FIGURE: {}, ALONE: {}}, frozenset())
    monkeypatch.setattr(planned, "ask", lambda *_: nothing)
    digest._parsed.cache_clear()  # of a process that sees one repository only
    library = Path("workflow/lib/courtside")
    for path in (library, Path("workflow/scripts"), Path("results/figures")):
        path.mkdir(parents=True)
    (library / "__init__.py").write_text("")
    (library / "style.py").write_text("WIDTH = 1")
    Path("workflow/scripts/draw.py").write_text("from courtside import style")
    Path("workflow/scripts/tabulate.py").write_text("X = 1")
    for name in ("a.mp4", "b.mp4", "net.onnx", FIGURE, ALONE):
        Path(name).write_text(name)
    Path("environment.lock").write_text("numpy==1\n")
    Path("config.yaml").write_text("width: 3\n")
    Path("Snakefile").write_text(SNAKEFILE)
    jobs = [
        made("fetch", None, [], ["net.onnx"]),
        made("draw", "draw.py", ["a.mp4", "net.onnx"], [FIGURE]),
        made("tabulate", "tabulate.py", ["b.mp4"], [ALONE]),
    ]
    run = {
        "command": ["snakemake"],
        "surroundings": environment.found("."),
        "config": {},
        "config_files": ["config.yaml"],
    }
    provenance.record(jobs, "results/run", run=run, root="results", pinned=["net"])
    return tmp_path


def made(rule, script, inputs, outputs):
    code = script and digest.code_digest(f"workflow/scripts/{script}", "workflow/lib")
    job = {"rule": rule, "script": script, "code": code, "inputs": inputs, "outputs": outputs}
    return {**job, "params": {}, "done": True, "made": True}


def reported():
    digest._parsed.cache_clear()
    lines, n_faults, _ = verification.report("results/run", "results", ".")
    assert n_faults == len([line for line in lines[:-1] if line.startswith("results/")])
    return lines[:-1]


def test_an_untouched_study_is_what_it_would_be(study):
    assert reported() == []


def test_a_file_that_is_only_touched_changes_nothing(study):
    for name in ("a.mp4", "config.yaml", "environment.lock"):
        Path(name).touch()
    assert reported() == []


@pytest.mark.parametrize(
    ("name", "content", "lines"),
    [
        ("a.mp4", "x", [f"{FIGURE}: a.mp4 changed"]),
        ("net.onnx", "x", [f"{FIGURE}: net.onnx changed"]),
        ("workflow/lib/courtside/style.py", "WIDTH = 2", [f"{FIGURE}: code of draw.py changed"]),
        ("workflow/lib/courtside/style.py", "WIDTH = 1  # mm", []),
        ("workflow/scripts/tabulate.py", None, [f"{ALONE}: code of tabulate.py is gone"]),
        (FIGURE, "x", [f"{FIGURE}: altered since it was made"]),
        (ALONE, None, [f"{ALONE}: missing"]),
        (
            "environment.lock",
            "numpy==1\n# new\n",
            [
                f"{ALONE}: environment.lock changed",
                f"{FIGURE}: environment.lock changed",
                "2 files: environment.lock changed",
            ],
        ),
        (
            "results/figures/new.png",
            "x",
            [
                "results/figures/new.png: has no record; "
                "remake it, or delete it if the study no longer names it: "
                "snakemake --force -- results/figures/new.png"
            ],
        ),
    ],
)
def test_each_change_is_told_for_what_it_reaches(study, name, content, lines):
    if content is None:
        Path(name).unlink()
    else:
        Path(name).write_text(content)
    assert reported() == lines


def test_another_package_and_interpreter_are_told(study):
    now = verification.present(".")
    now |= {"python": "4.0", "platform": "Plan9", "packages": {"numpy": "99", "extra": "1"}}
    sidecar = verification.read("results/run")[0]
    old = sidecar["packages"]["numpy"]
    assert verification.changes(sidecar, now) == [
        "package extra none -> 1",
        f"package numpy {old} -> 99",
        f"Python {sidecar['python']} -> 4.0",
        f"platform {sidecar['platform']} -> Plan9",
    ]


def test_the_digest_of_packages_is_no_change_of_the_code(study):
    sidecar, now = verification.read("results/run")[0], verification.present(".")
    for script, recorded in sidecar["code"].items():
        sidecar["code"][script] = f"{recorded}-{'0' * 64}"
    assert verification.changes(sidecar, now) == []
    sidecar["code"] = dict.fromkeys(sidecar["code"], f"{'0' * 64}-{'0' * 64}")
    assert verification.changes(sidecar, now) == ["code of tabulate.py changed"]


def test_each_file_is_read_once(study, monkeypatch):
    read, real = [], checksums.of_path
    monkeypatch.setattr(checksums, "of_path", lambda path: read.append(str(path)) or real(path))
    reported()
    assert sorted(read) == sorted([FIGURE, ALONE, "a.mp4", "b.mp4", "net.onnx", "config.yaml"])


@pytest.fixture
def ran(study, monkeypatch):
    """Let Snakemake run the study, and ask it."""
    monkeypatch.setattr(planned, "ask", ASK)
    Path(FIGURE).unlink()
    words = ["-m", "snakemake", "--cores", "1", "--quiet", "all", "--forceall"]
    subprocess.run([sys.executable, *words], check=True, capture_output=True)
    jobs = [
        made("draw", None, ["a.mp4", "net.onnx"], [FIGURE]) | {"params": {"width": 3}},
        made("tabulate", None, [], [ALONE]),
    ]
    record = {"command": ["snakemake"], "surroundings": environment.found("."), "config": {}}
    record["config_files"] = ["config.yaml"]
    provenance.record(jobs, "results/run", run=record, root="results")


def test_a_changed_setting_is_told(ran):
    assert reported() == []
    Path("config.yaml").write_text("width: 4\n")
    told = [
        f"{FIGURE}: settings of draw changed (width)",
        "since the last run, config.yaml changed",
    ]
    assert reported() == told
    shutil.rmtree(".snakemake")  # as of results that were moved without it
    *lines, advice = reported()
    assert lines == told
    assert advice.startswith("Snakemake has no records of these settings")
    assert advice.endswith(": snakemake --forcerun draw")


def test_a_study_that_cannot_be_planned_is_told(ran):
    Path("Snakefile").write_text("Error")
    lines, n_faults, n_unseen = verification.report("results/run", "results", ".")
    assert lines[0].startswith("settings are not compared: snakemake: ") and "Error" in lines[0]
    assert (n_faults, n_unseen) == (0, 2)
    Path("config.yaml").write_text("width: 4\n")
    lines, n_faults, _ = verification.report("results/run", "results", ".")
    assert n_faults == 1 and lines[0] == "since the last run, config.yaml changed"


@pytest.mark.parametrize(("name", "of"), [("b.mp4", ALONE), ("net.onnx", FIGURE)])
def test_inputs_that_are_not_here_are_told_apart_from_those_that_changed(study, name, of):
    Path(name).unlink()
    lines, n_faults, n_unseen = verification.report("results/run", "results", ".")
    told = f"1 inputs of 1 files are not here, so they cannot be compared: {name}; bring them to"
    assert lines == [
        f"{told} this folder",
        "2 files have a record: 1 cannot be compared in full, the rest is up to date",
    ]
    assert (n_faults, n_unseen) == (0, 1)
    Path(of).write_text("x")
    lines, n_faults, n_unseen = verification.report("results/run", "results", ".")
    assert lines[0] == f"{of}: altered since it was made"
    verdict = "1 are missing, out of date or without a record, 1 cannot be compared in full"
    assert verdict in lines[-1]
    assert (n_faults, n_unseen) == (1, 1)


def test_files_of_the_repository_are_found_from_other_folders(study, monkeypatch):
    asset = Path("workflow/lib/courtside/style.py")
    assert verification.present(".")["sha256"](str(asset)) == checksums.of_path(asset)
    (study / "elsewhere").mkdir()
    monkeypatch.chdir("elsewhere")
    known = checksums.of_path(study / asset)
    now = verification.present("..")
    assert (now["sha256"](str(asset)), now["sha256"]("a.mp4")) == (known, None)
    now = verification.present("..", "tests/smoke")  # the study ran there
    assert now["sha256"](f"../../{asset}") == known


def test_files_of_another_study_are_told(study, monkeypatch):
    monkeypatch.setattr(planned, "ask", lambda *_: planned.Plan({FIGURE: {}}, frozenset()))
    (line,) = reported()
    assert line == "1 files are not of the last run's study: their settings are not compared"


def test_settings_of_a_file_asked_for_by_name_are_compared(study, monkeypatch):
    def ask(words, repository, targets=()):
        return planned.Plan({name: {"draw": [{"n": 1}]} for name in targets}, frozenset())

    monkeypatch.setattr(planned, "ask", ask)
    *_, cause, advice = reported()
    assert cause == "2 files: settings of draw changed (n)"
    assert advice.endswith(f": snakemake --forcerun draw -- all {ALONE} {FIGURE}")


def test_what_the_study_no_longer_asks_for_is_counted_apart(study, monkeypatch):
    advice = "gym: results/figures belongs to no take: delete it"
    unrecorded = "results/figures/old.png"
    remains = frozenset([FIGURE, unrecorded])
    left = planned.Plan({ALONE: {}}, frozenset(), remains=remains, advice=(advice,))
    monkeypatch.setattr(planned, "ask", lambda *_: left)
    Path(unrecorded).touch()
    Path("a.mp4").write_text("x")  # no run makes this figure again
    lines, n_faults, _ = verification.report("results/run", "results", ".")
    assert n_faults == 1
    verdict = "1 files have a record: all are up to date; besides, 2 that the study no longer asks"
    assert lines == [advice, f"{verdict} for"]


def test_what_was_deleted_because_nobody_asks_for_it_is_no_fault(study, monkeypatch):
    left = planned.Plan({ALONE: {}}, frozenset(), remains=frozenset([FIGURE]))
    monkeypatch.setattr(planned, "ask", lambda *_: left)
    Path(FIGURE).unlink()
    (line,) = reported()
    assert line.startswith("1 files that the study no longer asks for were deleted: the next run")
    Path(ALONE).unlink()
    assert reported() == [f"{ALONE}: missing", line]


def test_the_folder_of_the_results_is_the_present_one(study, monkeypatch):
    asked = []
    monkeypatch.setattr(
        planned, "ask", lambda words, *_: asked.append(words) or planned.Plan({}, frozenset())
    )
    path = Path("results/run/provenance.json")
    moved = {"command": "snakemake --directory elsewhere --configfile config/a.yaml"}
    path.write_text(json.dumps(json.loads(path.read_text()) | moved))
    reported()
    assert asked[0] == ["snakemake", "--configfile", "config/a.yaml"]
    verification.report("results/run", "results", study.parent)
    assert asked[-1] == ["snakemake", "--directory", study.name, "--configfile", "config/a.yaml"]


@pytest.mark.parametrize("text", ["", "{", "[]", '{"format": 0}'])
def test_a_broken_sidecar_is_named(study, text):
    path = Path("results/run/provenance/figures/f.pdf.json")
    path.write_text(text)
    with pytest.raises(InputError, match=r"figures/f\.pdf\.json: expected"):
        verification.read("results/run")


@pytest.mark.parametrize("key", list(verification.OF_FILE))
def test_a_sidecar_without_a_key_is_named(study, key):
    path = Path("results/run/provenance/figures/f.pdf.json")
    content = json.loads(path.read_text())
    path.write_text(json.dumps(content | {key: [3]}))
    with pytest.raises(
        InputError, match=rf"f\.pdf\.json: expected {key} in a sidecar, found \[3\]"
    ):
        verification.read("results/run")


@pytest.mark.parametrize(
    "command",
    [
        "http.server",
        "pip install x",
        "snakemake --snakefile other.smk",
        "snakemake -s other.smk",
        "snakemake --default-resources x",
        "snakemake 'unclosed",
        "",
    ],
)
def test_a_record_of_another_command_is_not_run(study, command):
    path = Path("results/run/provenance.json")
    path.write_text(json.dumps(json.loads(path.read_text()) | {"command": command}))
    with pytest.raises(InputError, match="expected a command of snakemake"):
        reported()


def test_no_records_are_no_success(tmp_path):
    with pytest.raises(InputError, match="expected sidecars"):
        verification.read(tmp_path)


def program(folder, *words):
    command = [sys.executable, str(PROGRAM), "--directory", str(folder), *words]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_the_program_tells_faults_in_one_line(tmp_path):
    done = program(tmp_path)
    assert done.returncode == 1
    assert done.stderr.startswith("Error: ")
    assert len(done.stderr.splitlines()) == 1
    (tmp_path / "results").mkdir()
    assert "expected sidecars" in program(tmp_path).stderr
    assert "correct --against" in program(tmp_path, "--against", "nowhere").stderr


def test_the_program_compares_trees(tmp_path):
    for name in ("one", "two"):
        (tmp_path / name / "results").mkdir(parents=True)
        (tmp_path / name / "results" / "a.json").write_text(json.dumps({"x": 1}))
    against = ("--against", str(tmp_path / "two" / "results"))
    done = program(tmp_path / "one", *against)
    assert (done.returncode, done.stderr) == (0, "")
    (tmp_path / "two" / "results" / "a.json").write_text(json.dumps({"x": 2}))
    done = program(tmp_path / "one", *against)
    assert done.returncode == 1
    assert "a.json: different by up to 1" in done.stdout


@pytest.mark.parametrize(("counts", "status"), [((0, 0), 0), ((2, 0), 1), ((0, 5), 3), ((1, 5), 1)])
def test_the_exit_status_tells_what_differs_from_what_is_not_here(
    tmp_path, monkeypatch, counts, status
):
    monkeypatch.chdir(tmp_path)
    Path("results").mkdir()
    program = runpy.run_path(str(PROGRAM))
    monkeypatch.setattr(verification, "report", lambda *_: (["line"], *counts))
    lines, found = program["main"](None)
    assert (lines[0], found) == ("line", status)
