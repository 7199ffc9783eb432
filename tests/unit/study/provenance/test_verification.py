"""Each change is told once for each file that it reaches, and for no other."""

import json
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
    monkeypatch.setattr(planned, "ask", lambda *_: planned.Plan({}, frozenset()))
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
    lines, n_faults = verification.report("results/run", "results", ".")
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
        ("b.mp4", None, [f"{ALONE}: b.mp4 is gone"]),
        ("net.onnx", "x", [f"{FIGURE}: net.onnx changed"]),
        ("workflow/lib/courtside/style.py", "WIDTH = 2", [f"{FIGURE}: code of draw.py changed"]),
        ("workflow/lib/courtside/style.py", "WIDTH = 1  # mm", []),
        ("workflow/scripts/tabulate.py", None, [f"{ALONE}: code of tabulate.py is gone"]),
        (FIGURE, "x", [f"{FIGURE}: was altered since it was made"]),
        (ALONE, None, [f"{ALONE}: is gone"]),
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
    (line,) = reported()
    assert line.startswith("settings are not compared: snakemake: ") and "Error" in line
    Path("config.yaml").write_text("width: 4\n")
    with pytest.raises(InputError, match=r"snakemake: .*Error.*; correct this"):
        reported()


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
    left = planned.Plan({}, frozenset(), remains=remains, advice=(advice,))
    monkeypatch.setattr(planned, "ask", lambda *_: left)
    Path(unrecorded).touch()
    Path("a.mp4").write_text("x")  # no run makes this figure again
    lines, n_faults = verification.report("results/run", "results", ".")
    assert n_faults == 1
    verdict = "1 files have a record: all are up to date; besides, 2 that the study no longer asks"
    assert lines == [advice, f"{verdict} for"]


def test_what_was_deleted_because_nobody_asks_for_it_is_no_fault(study, monkeypatch):
    left = planned.Plan({}, frozenset(), remains=frozenset([FIGURE]))
    monkeypatch.setattr(planned, "ask", lambda *_: left)
    Path(FIGURE).unlink()
    (line,) = reported()
    assert line.startswith("1 files that the study no longer asks for were deleted: the next run")
    Path(ALONE).unlink()
    assert reported() == [f"{ALONE}: is gone", line]


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
