"""Who may import whom: the rooms of the library, the scripts, the packages with one owner."""

import ast
import importlib
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
LIBRARY = ROOT / "workflow" / "lib"
MODULES = sorted((LIBRARY / "courtside").rglob("*.py"))
SCRIPTS = sorted((ROOT / "workflow" / "scripts").glob("*.py"))
LEVELS = {
    "study": 0,
    "geometry": 1,
    "records": 1.5,  # records may use geometry
    "sfm": 2,
    "pose": 2,
    "devices": 2,
    "motion": 2,
    "exports": 3,
    "virtual": 3,
    "figures": 3,
    "pages": 3,
}
OWNERS = {
    "matplotlib": "figures",
    "onnxruntime": "pose",
    "onnx": "pose",
    "tflite": "pose",
    "pycolmap": "sfm",
    "av": "devices",
    "bvhio": "devices",
    "ezc3d": "exports",
    "embreex": "virtual",
}
TRUTH = ("truth.npz", "TRUE_TAKE", "true_take_file")  # how rules name files of truth
FOR_SCRIPTS = {"courtside", "numpy", "pandas", "cv2", *sys.stdlib_module_names}


def imports(source):
    """Return the full names of all imports of a module's source."""
    names = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names += [f"{node.module}.{alias.name}" for alias in node.names]
    return names


def faults(room, source):
    """Return what a module of a room may not import, as lines."""
    lines = []
    for name in imports(source):
        first, _, rest = name.partition(".")
        other = rest.split(".")[0]
        if first == "courtside" and other != room and LEVELS.get(other, 99) >= LEVELS[room]:
            lines.append(f"{room} may not import {name}")
        if first == "snakemake" or OWNERS.get(first, room) != room:
            lines.append(f"{room} may not import {name}")
    if "results/" in source and room != "study":
        lines.append(f"{room} names results/")
    return lines


@pytest.mark.parametrize("path", MODULES, ids=lambda p: "/".join(p.parts[-2:]))
def test_rooms_import_downwards_only(path):
    room = path.relative_to(LIBRARY / "courtside").parts[0]
    assert room == "__init__.py" or faults(room, path.read_text()) == []


@pytest.mark.parametrize(
    ("room", "source"),
    [
        ("pose", "from courtside.devices import video"),
        ("geometry", "from courtside.records import keypoints"),
        ("study", "import courtside.geometry.cameras"),
        ("motion", "from courtside.figures import style"),
        ("motion", "import matplotlib.pyplot"),
        ("exports", "import snakemake"),
        ("figures", "PATH = 'results/walk'"),
    ],
)
def test_the_check_bites(room, source):
    assert len(faults(room, source)) == 1


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda p: p.name)
def test_scripts_import_the_library_and_little_else(path):
    assert {name.split(".")[0] for name in imports(path.read_text())} <= FOR_SCRIPTS


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda p: p.name)
def test_only_the_last_block_of_a_script_names_snakemake(path):
    body = ast.parse(path.read_text()).body
    assert isinstance(body[-1], ast.If)
    for node in body[:-1]:
        names = {leaf.id for leaf in ast.walk(node) if isinstance(leaf, ast.Name)}
        assert "snakemake" not in names


@pytest.mark.parametrize("path", MODULES, ids=lambda p: "/".join(p.parts[-2:]))
def test_every_module_imports(path):
    name = ".".join(path.relative_to(LIBRARY).with_suffix("").parts)
    assert importlib.import_module(name.removesuffix(".__init__")).__doc__


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda p: p.name)
def test_methods_see_neither_simulation_nor_truth(path):
    used = {".".join(name.split(".")[:3]) for name in imports(path.read_text())}
    if not path.name.startswith(("simulate_", "evaluate_")):
        assert not [
            n for n in used if n.startswith(("courtside.virtual", "courtside.records.truth"))
        ]


def test_only_evaluations_take_truth_files():
    rules = sorted((ROOT / "workflow" / "rules").glob("*.smk"))
    takers = []
    for path in rules:
        blocks = path.read_text().split("\nrule ")[1:]
        takers += [
            block.split(":")[0]
            for block in blocks
            if any(words in block.split("output:")[0] for words in TRUTH)
        ]
    assert len(takers) >= 9
    assert [name for name in takers if not name.startswith("evaluate_")] == []
