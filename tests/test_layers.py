"""Who may import whom: the rooms of the library, the scripts, the packages with one owner."""

import ast
import functools
import importlib
import itertools
import re
import subprocess
import sys
from pathlib import Path

import pytest

from courtside.study import paths
from courtside.study.execution import digest
from smoke.snakemake_runs import copy_digests

ROOT = Path(__file__).parents[1]
LIBRARY = ROOT / "workflow" / "lib"
MODULES = sorted(LIBRARY.rglob("*.py"))
SCRIPTS = sorted((ROOT / "workflow" / "scripts").glob("*.py"))
PATHS = LIBRARY / "courtside" / "study" / "paths.py"
LEVELS = {  # a room imports rooms of lower levels only
    "study": 1,
    "statistics": 2,
    "video": 2,
    "geometry": 2,
    "records": 3,
    "kinematics": 4,
    "inertial": 4,
    "devices": 4,
    "depth": 4,
    "pose": 4,
    "calibration": 4,
    "reconstruction": 5,
    "body_model": 5,
    "events": 5,
    "footwork": 5,
    "sfm": 5,
    "exports": 5,
    "strokes": 5,
    "drafting": 5,
    "validation": 5,
    "pages": 5,
    "quality": 6,
    "evaluation": 6,
    "body_frame": 6,
    "synchronisation": 7,
    "figures": 7,
    "virtualgym": 8,
}
OWNERS = {
    "matplotlib": "figures",
    "onnxruntime": "pose",
    "onnx": "pose",
    "tflite": "pose",
    "pycolmap": "sfm",
    "av": "video",
    "bvhio": "devices",
    "ezc3d": "exports",
    "embreex": "virtualgym",
}
# What takes 0.1 to 0.5 s to load. `import scipy` loads a part of it when a function first names it;
# simulations, which are few, may name most parts at the head.
SLOW = ("scipy.", "jsonschema")
SLOWEST = ("scipy.signal", "scipy.stats")
# How rules name files of truth.
TRUTH = ("truth.npz", "TRUTH", "TRUE_TAKE", "BACKDROPS", "backdrops")
FOR_SCRIPTS = {"courtside", "virtualgym", "numpy", "pandas", "cv2", *sys.stdlib_module_names}


def faulty(paths, faults):
    """Return {file: faults} of the files with faults, so that one test names all of them."""
    found = {str(path.relative_to(ROOT)): faults(path) for path in paths}
    return {name: lines for name, lines in found.items() if lines}


@functools.cache
def imports(source, within=True):
    """Return the full names of all imports of a module's source, `within` its functions or not."""
    body, names = ast.parse(source).body, []
    head = [node for node in body if within or not isinstance(node, ast.FunctionDef)]
    for node in ast.walk(ast.Module(head)):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names += [f"{node.module}.{alias.name}" for alias in node.names]
    return names


def room_of(parts):
    """Return the room of a module, by the parts of its name or path: the simulation is one."""
    return parts[0] if parts[0] == "virtualgym" else parts[1]


def faults(room, source):
    """Return what a module of a room may not import, as lines."""
    lines = []
    for name in imports(source):
        first = name.split(".")[0]
        if first in ("courtside", "virtualgym"):
            other = room_of(name.split("."))
            if other != room and LEVELS.get(other, 99) >= LEVELS[room]:
                lines.append(f"{room} may not import {name}")
        if first == "snakemake" or OWNERS.get(first, room) != room:
            lines.append(f"{room} may not import {name}")
    if "results/" in source and room != "study":
        lines.append(f"{room} names results/")
    return lines


def faults_of_room(path):
    room = room_of(path.relative_to(LIBRARY).parts)
    return [] if room == "__init__.py" else faults(room, path.read_text())


def test_rooms_import_downwards_only():
    assert faulty(MODULES, faults_of_room) == {}


def test_every_room_has_a_level():
    rooms = {room_of(path.relative_to(LIBRARY).parts) for path in MODULES} - {"__init__.py"}
    assert rooms == set(LEVELS)


@pytest.mark.parametrize(
    ("room", "source"),
    [
        ("pose", "from courtside.devices import bvh"),
        ("geometry", "from courtside.records.keypoints import keypoints"),
        ("study", "import courtside.geometry.camera"),
        ("calibration", "from courtside.evaluation import calibration"),
        ("figures", "from virtualgym.hall import hall"),
        ("kinematics", "import matplotlib.pyplot"),
        ("exports", "import snakemake"),
        ("figures", "PATH = 'results/walk'"),
    ],
)
def test_the_check_bites(room, source):
    assert len(faults(room, source)) == 1


def slow_at_head(source, slow=SLOW):
    """Return what a module loads slowly whenever it is imported."""
    named = [ast.unparse(node) for node in at_head(ast.parse(source)) if is_scipy(node)]
    return [n for n in [*imports(source, within=False), *named] if n.startswith(slow)]


def at_head(node):
    """Yield the nodes that Python evaluates on import: of functions, all but their bodies."""
    yield node
    body = node.body if isinstance(node, ast.FunctionDef | ast.Lambda) else ()
    for child in ast.iter_child_nodes(node):
        if child is not body and not (isinstance(body, list) and child in body):
            yield from at_head(child)


def is_scipy(node):
    return isinstance(node, ast.Attribute) and ast.unparse(node.value) == "scipy"


def slow_parts(path):
    return slow_at_head(path.read_text(), SLOWEST if "virtualgym" in path.parts else SLOW)


def test_a_job_waits_for_no_part_of_scipy_and_no_check_of_files_that_it_does_not_use():
    assert faulty([*MODULES, *SCRIPTS], slow_parts) == {}


def test_slow_imports_at_the_head_of_a_module_are_found():
    assert slow_at_head("from scipy import signal") == ["scipy.signal"]
    assert slow_at_head("from scipy.stats import chi2") == ["scipy.stats.chi2"]
    assert slow_at_head("import jsonschema") == ["jsonschema"]
    assert slow_at_head("import scipy") == []
    assert slow_at_head("def f():\n    from scipy import stats") == []
    assert slow_at_head("def f() -> scipy.interpolate.BSpline: ...") == ["scipy.interpolate"]
    assert slow_at_head("LIMIT = scipy.special.ndtri(0.9)") == ["scipy.special"]
    assert slow_at_head('def f() -> "scipy.interpolate.BSpline":\n    scipy.stats.norm()') == []


def imported_beyond(path):
    return {name.split(".")[0] for name in imports(path.read_text())} - FOR_SCRIPTS


def test_scripts_import_the_library_and_little_else():
    assert faulty(SCRIPTS, imported_beyond) == {}


def faults_of_blocks(path):
    *body, last = ast.parse(path.read_text()).body
    named = {leaf.id for node in body for leaf in ast.walk(node) if isinstance(leaf, ast.Name)}
    return named & {"snakemake"} | (set() if isinstance(last, ast.If) else {"no last block"})


def test_only_the_last_block_of_a_script_names_snakemake():
    assert faulty(SCRIPTS, faults_of_blocks) == {}


def fault_of_import(path):
    name = ".".join(path.relative_to(LIBRARY).with_suffix("").parts).removesuffix(".__init__")
    try:
        return "" if importlib.import_module(name).__doc__ else "no docstring"
    except Exception as error:  # noqa: BLE001  # the faults of the other modules are named, too
        return repr(error)


def test_every_module_imports():
    assert faulty(MODULES, fault_of_import) == {}


def faults_of_list(package: Path) -> list[str]:
    """Return what the docstring of a room leaves out or calls by a name that is gone."""
    text = ast.get_docstring(ast.parse((package / "__init__.py").read_text()))
    parts = {p.stem for p in package.iterdir() if p.suffix == ".py" or (p / "__init__.py").exists()}
    parts -= {"__init__"}
    source = "\n".join(p.read_text() for p in package.rglob("*.py") if p.name != "__init__.py")
    listed = {name.split(".")[-1] for name in re.findall(r"`([\w.]+)`", text)} - parts
    return [
        f"{part} is not listed in __init__.py"
        for part in parts
        if not re.search(rf"\b{part}\b", text)
    ] + [
        f"{name} is listed in __init__.py and not there"
        for name in listed
        if not re.search(rf"\b{name}\b", source)
    ]


def test_a_room_lists_its_modules_and_their_functions():
    assert (
        faulty({path.parent for path in MODULES if path.name == "__init__.py"}, faults_of_list)
        == {}
    )


def test_a_list_of_modules_that_is_not_true_is_found(tmp_path):
    (tmp_path / "__init__.py").write_text('"""Room.\n\nnear: `gone`, `there`\n"""\n')
    (tmp_path / "near.py").write_text("def there(): ...\n")
    (tmp_path / "far.py").write_text("")
    assert faults_of_list(tmp_path) == [
        "far is not listed in __init__.py",
        "gone is listed in __init__.py and not there",
    ]


TRUE_MODULES = ("virtualgym", "courtside.records.truth")
KNOWING = ("simulate_", "evaluate_")  # rules that make truth or measure against it
# What may rest on an evaluation: measures and drawings of it, never a method.
SHOWING = ("evaluate_", "draw_", "tabulate_", "compare_", "all")


def refused(rule, names):
    """Return which of these names of truth a rule may not read.

    A simulation may read its empty hall only.
    """
    if rule.startswith("evaluate_"):
        return []
    return [name for name in names if not (rule.startswith("simulate_") and "backdrops" in name)]


def is_truth(name):
    """Tell files that hold the truth of a simulation, how far its empty hall is among them."""
    return "/virtual/" in f"/{name}" and Path(name).name in ("truth.npz", "backdrops.npz")


def true_parts(path):
    reached = digest.modules_of(path, LIBRARY)
    named = [words for words in ("truth.npz", "backdrops") if words in path.read_text()]
    return [name for name in sorted(reached) if name.startswith(TRUE_MODULES)] + named


def test_methods_reach_neither_simulation_nor_truth():
    methods = [path for path in SCRIPTS if not path.name.startswith(KNOWING)]
    assert len(methods) > 50
    assert faulty(methods, true_parts) == {}


def test_only_the_records_of_truth_the_simulation_and_the_paths_name_its_file():
    naming = [path.relative_to(LIBRARY) for path in MODULES if "truth.npz" in path.read_text()]
    assert any("virtualgym" in path.parts for path in naming)
    others = [path for path in naming if not {"virtualgym", "truth"}.intersection(path.parts)]
    others.remove(PATHS.relative_to(LIBRARY))
    assert [path for path in others if "truth" not in path.stem] == []


def test_only_the_inputs_of_evaluations_use_the_paths_of_truth():
    truth = [
        name
        for name, pattern in vars(paths).items()
        if isinstance(pattern, str) and is_truth(pattern)
    ]
    assert sorted(truth) == ["BACKDROPS", "TRUE_TAKE", "TRUTH"]
    words = re.compile(rf"paths\.({'|'.join(truth)})\b")
    users = [path for path in MODULES if words.search(path.read_text())]
    assert users == [LIBRARY / "courtside" / "study" / "jobs" / "evaluation.py"]


def parts_of_rules(path):
    known = tuple(f"courtside.study.{name}" for name in ("paths", "jobs", "targets"))
    return [name for name in imports(path.read_text()) if name.startswith(known)]


def test_only_rules_and_the_study_itself_know_paths_jobs_and_targets():
    others = [p for p in [*MODULES, *SCRIPTS] if "study" not in p.relative_to(ROOT).parts]
    assert faulty(others, parts_of_rules) == {}


def rule_blocks():
    """Return (name, text) of every rule in the rule files, those made in a loop included."""
    blocks = []
    for path in sorted((ROOT / "workflow" / "rules").glob("*.smk")):
        parts = re.split(r"^ *(?:rule|checkpoint)\b", path.read_text(), flags=re.M)[1:]
        for part in parts:
            script = re.search(r"scripts/(\w+)\.py", part)
            blocks.append((script.group(1) if script else part.split(":")[0].strip(), part))
    return blocks


def test_only_evaluations_take_truth_files():
    takers = []
    for name, text in rule_blocks():
        # All but what a rule makes: its inputs, and parameters that could smuggle a path.
        taken = re.sub(
            r"^ *output:.*?^ *(?=log:|benchmark:|params:|script:)", "", text, flags=re.M | re.S
        )
        if named := [words for words in TRUTH if words in taken]:
            takers.append((name, named))
    assert len(takers) >= 9
    assert [name for name, named in takers if refused(name, named)] == []


@pytest.fixture(scope="module")
def jobs(tmp_path_factory):
    """Return (rule, inputs, outputs) of every job of the default study, planned from nothing."""
    folder = tmp_path_factory.mktemp("empty")
    copy_digests(folder)
    command = [sys.executable, "-m", "snakemake", "-n", "--directory", str(folder)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return planned_jobs(done.stdout + done.stderr)


def planned_jobs(text):
    """Return (rule, inputs, outputs) of the jobs that a dry run lists."""
    found = []
    for block in re.split(r"^(?:local)?rule ", text, flags=re.M)[1:]:
        files = {
            key: words.split(", ")
            for key, words in re.findall(r"^    (input|output): (.*)$", block, flags=re.M)
        }
        found.append((block.split(":")[0], files.get("input", []), files.get("output", [])))
    return found


def knowing_methods(jobs):
    """Return the rules that take a truth file, or what was measured against one, and may not."""
    takers = {rule for rule, inputs, _ in jobs if refused(rule, filter(is_truth, inputs))}
    measured = {
        name for rule, _, outputs in jobs if rule.startswith("evaluate_") for name in outputs
    }
    showing = {rule for rule, inputs, _ in jobs if measured.intersection(inputs)}
    return sorted(takers | {rule for rule in showing if not rule.startswith(SHOWING)})


def test_no_job_of_a_method_takes_truth_or_what_was_measured_against_it(jobs):
    simulated = [out for rule, _, outputs in jobs for out in outputs if is_truth(out)]
    assert len(jobs) > 500
    assert len(simulated) >= 10
    assert sum(rule.startswith("evaluate_") for rule, _, _ in jobs) > 50
    assert knowing_methods(jobs) == []


def test_what_rests_on_measured_errors_is_itself_no_input_of_a_method(jobs):
    """Drawings and tables of errors end there: nothing but other drawings and tables reads them."""
    shown = {name for rule, _, outputs in jobs if rule.startswith(SHOWING) for name in outputs}
    readers = {rule for rule, inputs, _ in jobs if shown.intersection(inputs)}
    assert [rule for rule in sorted(readers) if not rule.startswith(SHOWING)] == []


def test_the_check_of_truth_bites():
    text = """rule triangulate:
    input: results/a/x.npz, results/virtual/a/takes/t/truth.npz
    output: results/a/y.npz

localrule filter_motion:
    input: results/a/errors.csv
    output: results/a/z.npz

rule simulate_a_t:
    input: results/virtual/a/backdrops.npz
    output: results/virtual/a/takes/t/truth.npz

rule simulate_a_u:
    input: results/virtual/a/truth.npz
    output: results/virtual/a/takes/u/truth.npz

rule evaluate_take:
    input: results/virtual/a/truth.npz
    output: results/a/errors.csv
"""
    assert knowing_methods(planned_jobs(text)) == ["filter_motion", "simulate_a_u", "triangulate"]


ARCHITECTURE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")


def test_the_architecture_page_names_every_room_with_its_level_and_what_it_holds():
    rows = re.findall(r"^\| (\d) \| `(\w+)` \| (.*) \|$", ARCHITECTURE, flags=re.M)
    assert {room: int(level) for level, room, _ in rows} == LEVELS
    packages = {"virtualgym": "virtualgym"}
    for _, room, holds in rows:
        name = packages.get(room, f"courtside.{room}")
        assert importlib.import_module(name).__doc__.strip().splitlines()[0] == holds


def test_the_files_of_the_architecture_page_exist():
    named = re.findall(r"`(\w+(?:/\w+)+\.py)`", ARCHITECTURE.replace("tests/test_layers.py", ""))
    assert len(named) >= 10
    assert [name for name in named if not (LIBRARY / "courtside" / name).is_file()] == []


def drawn_arrows():
    """Return the (from, to) pairs of rules of the architecture page's drawing."""
    drawing = re.search(r"```mermaid\n(.*?)```", ARCHITECTURE, flags=re.S).group(1)
    chains = [line.split(" --> ") for line in map(str.strip, drawing.splitlines())]
    return {pair for chain in chains for pair in itertools.pairwise(chain)}


def test_every_arrow_of_the_architecture_page_is_a_file_that_one_rule_hands_to_another(jobs):
    made_by = {name: rule for rule, _, outputs in jobs for name in outputs}
    handed = {(made_by.get(name), rule) for rule, inputs, _ in jobs for name in inputs}
    assert len(drawn_arrows()) >= 30
    assert sorted(drawn_arrows() - handed) == []
