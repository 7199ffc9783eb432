"""Rules and scripts agree: what a rule names, its script's `main` takes, and vice versa."""

import ast
import functools
import re
from collections import defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SCRIPTS = sorted((ROOT / "workflow" / "scripts").glob("*.py"))
PARTS = ("input", "output", "params")
DRAWN = {"figure", "session_figure", "study_figure", "device_figure", "calibrated_figure"}
FILES_OF_A_FIGURE = {"pdf", "png", "csv"}
# Files that a script finds by another one: members of folders, assets, what a simulation writes.
FOR_SNAKEMAKE = {"assets", "files", "of_cameras", "photos", "videos", "boards", "clicks"}
FOR_SNAKEMAKE |= {"devices", "racket"}
WILDCARDS = {
    *("session", "take", "camera", "person", "device", "source", "model", "calibration"),
    *("mapper", "n_images", "offset", "threads"),
}


@pytest.mark.parametrize("kind", ["draw", "evaluate", "compare"])
def test_persons_and_sources_called_by_digits_keep_their_names(kind):
    names = [path for path in SCRIPTS if path.stem.startswith(kind)]
    assert [path.name for path in names if "read_csv(" in path.read_text()] == []  # `tables.read`


@functools.cache
def rules_by_script():
    """Return {script: [{part: names} of each rule that runs it]}."""
    found = defaultdict(list)
    for path in sorted((ROOT / "workflow" / "rules").glob("*.smk")):
        for block in re.split(r"^ *rule\b.*:\n", path.read_text(), flags=re.M)[1:]:
            for script in set(re.findall(r"scripts/(\w+)\.py", block)):
                found[script].append(names_in(block))
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


def disagreements(path):
    """Return what the rules of a script give and its `main` does not take, and vice versa."""
    taken, needed, others = arguments_of(path)
    found = [] if rules_by_script()[path.stem] else ["no rule"]
    for names in rules_by_script()[path.stem]:
        files = {"paths"} if "paths" in taken else names["input"]
        parameters = names["params"] - {"code", "pin"}
        given = files | names["output"] | parameters
        if len(given & taken) != sum(len(p & taken) for p in (files, names["output"], parameters)):
            found.append("one name for two of input, output and params")
        spread = "step" in given and "step" not in taken
        if not others:
            found += [f"{name}: not taken" for name in given - taken - {"step"} - FOR_SNAKEMAKE]
        if not spread:
            found += [f"{name}: not given" for name in needed - given - WILDCARDS]
            unknown = taken - given - WILDCARDS - {"paths"}
            found += [f"{name}: given by no rule" for name in unknown]
    return found


def test_pages_are_built_again_when_their_templates_change():
    builders = [path.stem for path in SCRIPTS if path.stem.startswith("build_")]
    given = {name: [one["input"] for one in rules_by_script()[name]] for name in builders}
    assert all("assets" in one for rules in given.values() for one in rules), given


def test_what_reads_a_calibration_file_depends_on_all_files_of_it():
    of_session = {"import_cameras", "check_cameras", "check_court", "refine_cameras"}
    given = {name: [one["input"] for one in rules_by_script()[name]] for name in of_session}
    reading = [path.stem for path in SCRIPTS if "file_formats.read" in path.read_text()]
    assert set(reading) == of_session
    assert all("files" in one for rules in given.values() for one in rules), given


def test_a_rule_gives_its_script_what_main_takes():
    found = {path.stem: disagreements(path) for path in SCRIPTS}
    assert {name: lines for name, lines in found.items() if lines} == {}


def test_a_script_ends_with_one_call():
    last = {path.stem: ast.unparse(ast.parse(path.read_text()).body[-1]) for path in SCRIPTS}
    call = "if __name__ == '__main__':\n    run(main, snakemake)"
    assert {name: text for name, text in last.items() if text != call} == {}
