"""Sidecars name what a file rests on: no more, no less, and only when it was made."""

import hashlib
import json
import os
from pathlib import Path

import pytest

from courtside.study.execution import checksums
from courtside.study.provenance import provenance

RUN = {
    "command": ["snakemake", "--configfile", "config/a b.yaml"],
    "surroundings": {"commit": "c1", "lock_sha256": "l1", "packages": {"numpy": "2"}},
    "config": {"sessions": ["gym"]},
    "config_files": ["config.yaml"],
}


def job(rule, inputs, outputs, made=True, done=True, **params):
    return {
        "rule": rule,
        "script": f"{rule}.py",
        "code": f"digest of {rule}",
        "inputs": inputs,
        "outputs": outputs,
        "params": params,
        "done": done,
        "made": made,
    }


def study(**change):
    """Return jobs of two cameras, a network, a figure; and a figure from one video alone."""
    jobs = [
        job(
            "fetch", [], ["results/external/net.tflite", "results/external/other"], step={"seed": 9}
        ),
        job("detect", ["data/a.mp4", "results/external/net.tflite"], ["results/gym/a.npz"], size=4),
        job("detect", ["data/b.mp4", "results/external/net.tflite"], ["results/gym/b.npz"], size=4),
        job(
            "draw",
            ["results/gym/a.npz", "results/gym/b.npz"],
            ["results/gym/figures/f.pdf", "results/gym/figures/f.csv", "results/gym/logs/f.log"],
            seed=3,
        ),
        job("draw_alone", ["data/a.mp4"], ["results/gym/figures/alone.pdf"]),
        job("all", ["results/gym/figures/f.pdf", "results/gym/a.npz"], []),
    ]
    return [{**each, **change} for each in jobs]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Go to a folder where the study ran; return the folder of its records."""
    monkeypatch.chdir(tmp_path)
    names = {name for each in study() for name in (*each["inputs"], *each["outputs"])}
    for name in [*names, "config.yaml"]:
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_text(f"content of {name}")
    return Path("results/run")


def sha(name):
    return hashlib.sha256(f"content of {name}".encode()).hexdigest()


def record(folder, jobs, **options):
    options = {"pinned": ["results/external/"], "root": "results", "run": RUN, **options}
    return provenance.record(jobs, folder, **options)


def read(folder, name):
    return json.loads((folder / "provenance" / f"{name}.json").read_text())


def test_a_figure_rests_on_all_that_is_upstream(folder):
    record(folder, study())
    assert read(folder, "gym/figures/f.pdf") == {
        "format": 1,
        "file": "results/gym/figures/f.pdf",
        "sha256": sha("results/gym/figures/f.pdf"),
        "rule": "draw",
        "command": "snakemake --configfile 'config/a b.yaml' -- results/gym/figures/f.pdf",
        "recorded": "when it was made",
        "inputs": {name: sha(name) for name in ("data/a.mp4", "data/b.mp4")},
        "artefacts": {"results/external/net.tflite": sha("results/external/net.tflite")},
        "settings": {
            "detect": [{"size": 4}],
            "draw": [{"seed": 3}],
            "fetch": [{"step": {"seed": 9}}],
        },
        "seeds": {"draw.seed": [3], "fetch.step.seed": [9]},
        "code": {f"{rule}.py": f"digest of {rule}" for rule in ("fetch", "detect", "draw")},
        **RUN["surroundings"],
    }


def test_a_figure_rests_on_nothing_else(folder):
    record(folder, study())
    alone = read(folder, "gym/figures/alone.pdf")
    assert list(alone["inputs"]) == ["data/a.mp4"]
    assert alone["artefacts"] == alone["settings"] == alone["seeds"] == {}
    assert list(alone["code"]) == ["draw_alone.py"]


def test_the_order_of_jobs_changes_no_byte(folder):
    path = folder / "provenance/gym/figures/f.pdf.json"
    record(folder, study())
    before = path.read_bytes()
    record(folder, study()[::-1])
    assert path.read_bytes() == before


def test_figures_tables_and_what_was_asked_for_have_sidecars(folder):
    drawn = {f"results/gym/figures/{name}" for name in ("f.pdf", "f.csv", "alone.pdf")}
    assert set(record(folder, study(), targets={"results/gym/a.npz"})) == {
        *drawn,
        "results/gym/a.npz",
    }


def test_what_once_had_a_sidecar_keeps_having_one(folder):
    record(folder, study(), targets={"results/gym/a.npz"})
    assert "results/gym/a.npz" in record(folder, study())


def test_what_was_not_made_again_keeps_its_sidecar(folder):
    record(folder, study())
    before = (folder / "provenance/gym/figures/f.pdf.json").read_bytes()
    Path("data/a.mp4").write_text("another")
    assert record(folder, study(made=False)) == []
    assert (folder / "provenance/gym/figures/f.pdf.json").read_bytes() == before


def test_what_was_made_again_gets_a_new_one_whatever_the_clock_says(folder):
    record(folder, study())
    os.utime("results/gym/figures/f.pdf", ns=(10**9, 10**9))
    Path("data/a.mp4").write_text("another")
    assert "results/gym/figures/f.pdf" in record(folder, study())
    found = read(folder, "gym/figures/f.pdf")["inputs"]["data/a.mp4"]
    assert found == hashlib.sha256(b"another").hexdigest()


def test_a_file_younger_than_its_sidecar_was_made_by_a_run_that_was_killed(folder):
    record(folder, study())
    later = (folder / "provenance/gym/figures/f.pdf.json").stat().st_mtime_ns + 10**9
    os.utime("results/gym/figures/f.pdf", ns=(later, later))
    assert record(folder, study(made=False)) == ["results/gym/figures/f.pdf"]
    assert "later run" in read(folder, "gym/figures/f.pdf")["recorded"]


def test_a_copy_of_another_date_keeps_what_it_was_made_with(folder):
    record(folder, study())
    path = folder / "provenance/gym/figures/f.pdf.json"
    before, later = path.read_bytes(), path.stat().st_mtime_ns + 10**11
    os.utime("results/gym/figures/f.pdf", ns=(later, later))
    jobs = [{**job, "params": {"seed": 4}} for job in study(made=False, known=False)]
    assert record(folder, jobs) == []
    assert path.read_bytes() == before
    path.write_text("{")
    os.utime("results/gym/figures/f.pdf", ns=(later, later))
    assert record(folder, jobs) == ["results/gym/figures/f.pdf"]
    Path("results/gym/figures/f.pdf").write_text("drawn anew")
    os.utime("results/gym/figures/f.pdf", ns=(later, later))
    assert record(folder, jobs) == ["results/gym/figures/f.pdf"]


@pytest.mark.parametrize("absent", ["undone", "gone"])
def test_what_is_not_made_yet_has_none(folder, absent):
    jobs = study(made=False, done=absent != "undone")
    if absent == "gone":
        for path in Path("results/gym/figures").iterdir():
            path.unlink()
    assert record(folder, jobs) == []


def test_the_sidecar_of_a_file_that_is_gone_goes(folder):
    record(folder, study())
    Path("results/gym/figures/f.pdf").unlink()
    record(folder, study(made=False))
    names = {path.name for path in (folder / "provenance").rglob("*.json")}
    assert names == {"f.csv.json", "alone.pdf.json"}


def test_files_with_a_sidecar_are_listed_here_or_not(folder):
    record(folder, study())
    Path("results/gym/figures/f.pdf").unlink()
    names = ("alone.pdf", "f.csv", "f.pdf")
    found = provenance.recorded(folder, "results")
    assert found == [f"results/gym/figures/{name}" for name in names]


def test_a_folder_has_a_sidecar_too(folder):
    project = Path("results/gym/project")
    project.mkdir()
    (project / "a.toml").write_text("x")
    jobs = [job("export", ["data/a.mp4"], [str(project)])]
    assert record(folder, jobs, targets={str(project)}) == [str(project)]
    jobs[0]["made"] = False
    assert record(folder, jobs) == []


def test_the_run_has_a_record(folder):
    record(folder, study())
    assert json.loads((folder / "provenance.json").read_text()) == {
        "format": 1,
        "command": "snakemake --configfile 'config/a b.yaml'",
        "config_files": {"config.yaml": sha("config.yaml")},
        "config": {"sessions": ["gym"]},
        **RUN["surroundings"],
    }


def test_nothing_but_records_is_written(folder):
    before = {path: path.stat().st_mtime_ns for path in Path().rglob("*") if path.is_file()}
    record(folder, study())
    after = {path: path.stat().st_mtime_ns for path in Path().rglob("*") if path.is_file()}
    assert {p: t for p, t in after.items() if not p.is_relative_to(folder)} == before
    assert not list(folder.rglob(".*"))


def test_upstream_of_a_ladder_of_many_jobs():
    """Each rung rests on both rails of the one below: 2^n paths, n jobs."""
    jobs = [
        job("rung", [f"{n - 1}a", f"{n - 1}b"] * (n > 0), [f"{n}a", f"{n}b"]) for n in range(1500)
    ]
    reach = provenance.upstream(jobs[::-1])
    assert [len(found) for found in reach] == list(range(1500, 0, -1))


def test_faulty_jobs_are_refused():
    with pytest.raises(ValueError, match="circle"):
        provenance.upstream([job("a", ["y"], ["x"]), job("b", ["x"], ["y"])])
    with pytest.raises(ValueError, match="two jobs make x"):
        provenance.upstream([job("a", [], ["x"]), job("b", [], ["x"])])


def test_parameters_become_json():
    value = {1: Path("a"), "b": {"name": "left", "size": (2, 3)}, "d": object(), "e": None}
    found = provenance.plain(value)
    assert found == {"1": "a", "b": {"name": "left", "size": [2, 3]}, "d": "a object", "e": None}
    assert json.loads(json.dumps(found)) == found


def test_seeds_are_found_at_any_depth():
    jobs = [job("a", [], ["x"], list=[{"walk_seed": 1}, {"walk_seed": 2}], seedling=5)]
    found = provenance.origin(jobs, {0}, lambda path: None)
    assert found["seeds"] == {"a.list.walk_seed": [1, 2]}


def test_inputs_keep_the_date_of_what_was_last_made_directly_from_them(folder):
    for at, name in enumerate(["data/a.mp4", "data/b.mp4", "results/gym/b.npz"]):
        os.utime(name, ns=(10**9 * (at + 1), 10**9 * (at + 1)))
    dates = {"results/gym/a.npz": 5, "results/gym/figures/alone.pdf": 6}
    for name, at in dates.items():
        os.utime(name, ns=(10**9 * at, 10**9 * at))
    record(folder, study())
    kept = folder / "checksums.json"
    expected = {"data/a.mp4": 6 * 10**9, "data/b.mp4": 3 * 10**9}
    assert checksums.Checksums(kept).until == expected
    os.utime("results/gym/figures/alone.pdf", ns=(10**10, 10**10))
    undone = [{**one, "done": one["rule"] != "draw_alone"} for one in study()]
    record(folder, undone)
    assert checksums.Checksums(kept).until == expected
