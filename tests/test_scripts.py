"""Rules and scripts agree: what a rule names, its script's `main` takes, and vice versa."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SCRIPTS = sorted((ROOT / "workflow" / "scripts").glob("*.py"))
PARTS = ("input", "output", "params")
DRAWN = {"figure", "session_figure", "study_figure", "device_figure", "calibrated_figure"}
FILES_OF_A_FIGURE = {"pdf", "png", "csv"}
# Files that a script finds by another one: members of folders, assets, what a simulation writes.
FOR_SNAKEMAKE = {"assets", "files", "photos", "videos", "boards", "clicks", "devices", "racket"}
WILDCARDS = {
    *("session", "take", "camera", "person", "device", "source", "model", "calibration"),
    *("mapper", "n_images", "offset", "threads"),
}


@pytest.mark.parametrize("kind", ["draw", "evaluate", "compare"])
def test_persons_and_sources_called_by_digits_keep_their_names(kind):
    names = [path for path in SCRIPTS if path.stem.startswith(kind)]
    assert [path.name for path in names if "read_csv(" in path.read_text()] == []  # `tables.read`


def rules_of(script):
    """Return {part: names} of each rule that runs a script."""
    found = []
    for path in sorted((ROOT / "workflow" / "rules").glob("*.smk")):
        for block in re.split(r"^ *rule\b.*:\n", path.read_text(), flags=re.M)[1:]:
            if f"scripts/{script}.py" in block:
                found.append(names_in(block))
    return found


def names_in(block):
    lines = block.split("\n")
    outer = len(lines[0]) - len(lines[0].lstrip())
    names, part = {part: set() for part in PARTS}, None
    for line in lines:
        directive = re.match(rf" {{{outer}}}(\w+):", line)
        part = directive[1] if directive else part
        if part not in PARTS:
            continue
        if named := re.match(rf" {{{outer + 4}}}(\w+)=", line):
            names[part].add(named[1])
        if unpacked := re.match(rf" {{{outer + 4}}}\*\*(\w+)\((.*)", line):
            kind = re.match(r'"(\w+)"\)', unpacked[2]) if unpacked[1] == "plan_figure" else None
            stem = f"{kind[1]}_" if kind else ""
            assert kind or unpacked[1] in DRAWN, line
            names[part] |= {stem + name for name in FILES_OF_A_FIGURE}
    return names


def arguments_of(path):
    main = next(
        node
        for node in ast.parse(path.read_text()).body
        if isinstance(node, ast.FunctionDef) and node.name == "main"
    ).args
    positional = main.args[: len(main.args) - len(main.defaults)]
    keywords = [a for a, d in zip(main.kwonlyargs, main.kw_defaults, strict=True) if d is None]
    every = {one.arg for one in (*main.args, *main.kwonlyargs)}
    return every, {one.arg for one in (*positional, *keywords)}, main.kwarg is not None


@pytest.mark.parametrize("path", SCRIPTS, ids=[path.stem for path in SCRIPTS])
def test_a_rule_gives_its_script_what_main_takes(path):
    taken, needed, others = arguments_of(path)
    found = rules_of(path.stem)
    assert found
    for names in found:
        files = {"paths"} if "paths" in taken else names["input"]
        parameters = names["params"] - {"code", "pin"}
        given = files | names["output"] | parameters
        assert len(given & taken) == sum(
            len(p & taken) for p in (files, names["output"], parameters)
        )
        spread = "step" in given and "step" not in taken
        if not others:
            assert given - taken - {"step"} - FOR_SNAKEMAKE == set()
        if not spread:
            assert needed - given - WILDCARDS == set()
            assert taken - given - WILDCARDS - {"paths"} == set()


@pytest.mark.parametrize("name", [p.stem for p in SCRIPTS if p.stem.startswith("build_")])
def test_a_page_is_built_again_when_its_templates_change(name):
    assert all("assets" in names["input"] for names in rules_of(name))


@pytest.mark.parametrize("path", SCRIPTS, ids=[path.stem for path in SCRIPTS])
def test_a_script_ends_with_one_call(path):
    last = ast.parse(path.read_text()).body[-1]
    assert ast.unparse(last) == "if __name__ == '__main__':\n    run(main, snakemake)"
