"""The house keeps its own rules: sizes, names, formatting, lint, lock, documentation."""

import ast
import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path

import jsonschema
import pytest
import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from courtside.study.execution import digest

ROOT = Path(__file__).parents[1]
LIBRARY = ROOT / "workflow" / "lib"
MODULES = sorted(LIBRARY.rglob("*.py"))
SCRIPTS = sorted((ROOT / "workflow" / "scripts").glob("*.py"))
RULES = sorted((ROOT / "workflow" / "rules").glob("*.smk"))
SCHEMAS = sorted((ROOT / "workflow" / "schemas").glob("*.yaml"))
UNTESTED = {"__init__", "errors", "missing_reason"}  # names and constants only
TESTED_THROUGH = {  # parts of one thing: the tests of the whole cover them
    "courtside/calibration/records/support": "test_tie_points.py",
    "courtside/calibration/boards/start": "test_adjustment.py",
    "courtside/calibration/wand/start": "test_calibration.py",
    "courtside/calibration/wand/adjustment": "test_calibration.py",
    "courtside/calibration/wand/world": "test_calibration.py",
    "courtside/calibration/wand/timing": "test_quality.py",
    "courtside/calibration/foreign/forms": "../test_file_formats.py",
    "courtside/calibration/foreign/opencv": "../test_file_formats.py",
    "courtside/calibration/foreign/qualisys": "../test_file_formats.py",
    "courtside/calibration/foreign/xml_fields": "../test_file_formats.py",
    "courtside/pose/conversion/onnx_writer": "test_tflite_onnx.py",
    "courtside/pose/conversion/tflite_operators": "test_tflite_onnx.py",
    "courtside/pose/conversion/tflite_tensors": "test_tflite_graph.py",
    "courtside/geometry/camera_fields": "../calibration/test_file_formats.py",
    "courtside/study/configuration/take_faults": "test_session_faults.py",
    "courtside/exports/bvh": "test_bvh_export.py",
}
PER_NAME = {
    "fetch_artefact.py",
    "simulate_session.py",
    "simulate_take.py",
}  # one rule for each artefact, each virtual session and take
# Written in pieces, so that this file does not name them itself.
FOREIGN = ["/" + "work/", "/" + "tmp/", "pypi" + ".org", "python" + "hosted"]
LARGEST_BYTES = 1 << 20


def tracked():
    done = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / line for line in done.stdout.splitlines() if (ROOT / line).is_file()]


def run(*command):
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def long_functions(source, limit=40):
    """Return functions whose body, docstring apart, has more lines than the limit."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef):
            first = node.body[0]
            text = isinstance(first, ast.Expr) and isinstance(
                getattr(first.value, "value", None), str
            )
            lines = node.end_lineno - node.lineno + 1
            lines -= first.end_lineno - first.lineno + 1 if text else 0
            if lines > limit:
                found.append(f"{node.name}: {lines}")
    return found


@pytest.mark.parametrize(
    ("paths", "limit"),
    [(SCRIPTS, 100), (MODULES, 500)],
    ids=["scripts", "modules"],
)
def test_files_stay_short(paths, limit):
    lengths = {str(path): len(path.read_text().splitlines()) for path in paths}
    assert {name: length for name, length in lengths.items() if length > limit} == {}


def test_functions_stay_short():
    found = {str(path): long_functions(path.read_text()) for path in [*MODULES, *SCRIPTS]}
    assert {name: functions for name, functions in found.items() if functions} == {}
    assert long_functions("def f():\n" + "    x = 1\n" * 41) == ["f: 42"]


def functions_of_rules(text):
    """Return the Python functions of a rule file, as source."""
    return re.findall(r"^def .*?(?=^\S|\Z)", text, flags=re.M | re.S)


def test_rule_files_are_few_and_their_functions_short():
    assert len(RULES) <= 23
    found = [source for path in RULES for source in functions_of_rules(path.read_text())]
    assert len(found) > 10
    assert [fault for source in found for fault in long_functions(source, limit=6)] == []
    long = 'rule a:\n    input:\n        f,\n\n\ndef f():\n    """Text."""\n' + "    x = 1\n" * 6
    (source,) = functions_of_rules(f"{long}\n\nrule b:\n    input:\n        f,\n")
    assert long_functions(source, limit=6) == ["f: 7"]


def rules():
    """Return (rule name, script name, log folder) of every scripted rule with a fixed name."""
    text = "\n".join(path.read_text() for path in RULES)
    blocks = re.split(r"^(?=rule \w+:)", text, flags=re.M)[1:]
    return [
        (
            re.match(r"rule (\w+):", block).group(1),
            re.search(r"scripts/(\w+)\.py", block).group(1),
            re.search(r"/logs/(\w+)/", block).group(1),
        )
        for block in blocks
    ]


def test_rule_script_and_log_folder_have_one_name():
    found = rules()
    assert len(found) >= 12
    assert [names for names in found if len(set(names)) > 1] == []
    assert {f"{script}.py" for _, script, _ in found} | PER_NAME == {p.name for p in SCRIPTS}


def unannotated(path):
    """Return the public functions and methods of a module that leave a type out."""
    missing = []
    for node in ast.walk(ast.parse(path.read_text())):
        for one in getattr(node, "body", []) if isinstance(node, ast.Module | ast.ClassDef) else []:
            if isinstance(one, ast.FunctionDef) and not one.name.startswith("_"):
                arguments = [*one.args.posonlyargs, *one.args.args, *one.args.kwonlyargs]
                arguments = [a for a in arguments if a.arg not in ("self", "cls")]
                if one.returns is None or any(a.annotation is None for a in arguments):
                    missing.append(f"{path.relative_to(LIBRARY)}: {one.name}")
    return missing


def test_public_functions_say_their_types():
    assert [name for path in MODULES for name in unannotated(path)] == []


def test_the_library_is_mirrored_by_tests():
    missing = []
    for path in MODULES:
        name = path.relative_to(LIBRARY).with_suffix("")
        folder = (
            ROOT
            / "tests"
            / "unit"
            / name.parent.relative_to("courtside" if name.parts[0] == "courtside" else ".")
        )
        mirror = folder / TESTED_THROUGH.get(name.as_posix(), f"test_{path.stem}.py")
        if path.stem not in UNTESTED and not mirror.is_file():
            missing.append(f"{name.as_posix()}: write {mirror.relative_to(ROOT)}")
    assert missing == []


def test_a_folder_holds_one_subject():
    folders = {path.parent for path in MODULES}
    crowded = {
        folder.relative_to(LIBRARY).as_posix(): n_files
        for folder in folders
        if (n_files := sum(p.name != "__init__.py" for p in folder.glob("*.py"))) > 12
    }
    assert crowded == {}


@pytest.mark.parametrize(
    "command",
    [
        ("-m", "ruff", "check", "--no-cache", "."),
        ("-m", "ruff", "format", "--no-cache", "--check", "."),
        ("-m", "snakefmt", "--check", "Snakefile", "workflow/rules"),
        (
            "-m",
            "codespell_lib",
        ),
    ],
    ids=["ruff", "format", "snakefmt", "codespell"],
)
def test_tools_find_nothing(command):
    done = run(sys.executable, *command)
    assert done.returncode == 0, done.stdout + done.stderr


def test_lint_finds_only_the_missing_conda_environments():
    done = run(sys.executable, "-m", "snakemake", "--lint")
    titles = set(re.findall(r"^    \* (.*)$", done.stdout + done.stderr, flags=re.M))
    assert titles == {"Specify a conda environment or container for each rule.:"}


def locked():
    """Return the versions of each package in the lock, and its text."""
    text = (ROOT / "environment.lock").read_text()
    versions = {}
    for name, version in re.findall(r"^([A-Za-z0-9._-]+)(?:\[[^]]*\])?==([^ ]+)", text, flags=re.M):
        versions.setdefault(canonicalize_name(name), []).append(version)
    return versions, text


def test_the_lock_is_hashed_and_names_no_index():
    versions, text = locked()
    blocks = re.split(r"^(?=[A-Za-z0-9])", text, flags=re.M)[1:]
    assert len(blocks) == sum(map(len, versions.values()))
    assert [block.split()[0] for block in blocks if "--hash=sha256:" not in block] == []
    assert "http" not in text


def test_the_lock_covers_the_direct_dependencies():
    versions, _ = locked()
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    wanted = [*project["project"]["dependencies"], *project["dependency-groups"]["test"]]
    for requirement in map(Requirement, wanted):
        found = versions[canonicalize_name(requirement.name)]
        assert all(requirement.specifier.contains(version) for version in found), requirement


def test_the_lock_pins_extras():
    """A package asked for with an extra is pinned with it.

    pip before 23.3 takes the newest version of `name[extra]` where the lock pins only `name`, and
    then stops: a lock that installs today fails after the next release of that package.
    """
    wanted = {
        f"{canonicalize_name(needed.name)}[{extra}]"
        for distribution in metadata.distributions()
        if canonicalize_name(distribution.name) in locked()[0]
        for needed in map(Requirement, distribution.requires or [])
        if needed.marker is None or needed.marker.evaluate({"extra": ""})
        for extra in needed.extras
    }
    assert wanted
    assert sorted(one for one in wanted if f"\n{one}==" not in locked()[1]) == []


def imported(path):
    """Return the top-level names of all absolute imports of a module."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add(node.module.split(".")[0])
    return names


def test_every_package_that_the_workflow_imports_is_declared():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    declared = {canonicalize_name(Requirement(r).name) for r in project["dependencies"]}
    since_314 = {"compression"}  # of the standard library
    ours = {"courtside", "virtualgym", *since_314, *sys.stdlib_module_names}
    used = set().union(*map(imported, [*MODULES, *SCRIPTS])) - ours
    assert len(used) > 10
    names = {canonicalize_name(digest.INSTALLED_AS.get(name, name)) for name in used}
    assert sorted(names - declared) == []


def test_nothing_large_or_foreign_is_tracked():
    for path in tracked():
        content = path.read_bytes()
        assert len(content) <= LARGEST_BYTES, path
        named = [needle for needle in FOREIGN if needle.encode() in content]
        assert named == [], path


@pytest.mark.parametrize("path", SCHEMAS, ids=lambda p: p.name)
def test_schemas_are_schemas(path):
    jsonschema.Draft202012Validator.check_schema(yaml.safe_load(path.read_text()))


def keys(schema):
    """Yield the names of all properties of a schema, at any depth."""
    for name, value in schema.get("properties", {}).items():
        yield name
        yield from keys(value)
    if isinstance(schema.get("additionalProperties"), dict):
        yield from keys(schema["additionalProperties"])


@pytest.mark.parametrize("name", ["config", "session"])
def test_every_key_is_documented(name):
    text = (ROOT / "config" / "README.md").read_text()
    schema = yaml.safe_load((ROOT / "workflow" / "schemas" / f"{name}.schema.yaml").read_text())
    found = set(keys(schema))
    assert len(found) > 10
    assert {key for key in found if not re.search(rf"\b{key}\b", text)} == set()


def test_the_readme_gives_the_two_commands():
    text = (ROOT / "README.md").read_text()
    start = "python3 -m venv .venv && . .venv/bin/activate && pip install -r environment.lock && "
    assert f"{start}snakemake\n" in text
    assert f"{start}pytest\n" in text
