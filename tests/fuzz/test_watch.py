"""The watch itself: it tells every kind of fault, and goes on after it."""

import os
import random

import pytest

from fuzz import binaries, containers, formats, mutations, planted, texts, trees, watch

pytestmark = [
    pytest.mark.fuzz,
    pytest.mark.skipif(os.name == "nt", reason="the memory of the reader is limited by POSIX"),
]

TOLD = {
    "unnamed": "does not name whole.bin",
    "lines": "not one printable line",
    "other": "KeyError",
    "hang": "still reading after",
    "wait": "still reading after 0",
    "fill": "MemoryError",
    "crash": "the process ended (status -11)",
    "end": "the process ended (status 0)",
    "escape": "did what it may not",
    "hidden": "wrote outside: ['hidden.txt']",
    "unpickle": "pickle.find_class",
    "start": "subprocess.Popen",
}


@pytest.fixture(scope="module")
def planting(tmp_path_factory):
    made = watch.Watched(
        tmp_path_factory.mktemp("planted"), "fuzz.planted", limit_s=1.0, sleep_s=2.0
    )
    yield made
    made.stop()


@pytest.mark.parametrize("name", list(TOLD))
def test_every_kind_of_fault_is_told_and_the_next_is_read(planting, name):
    what, more, _ = planting.one(name, 1, 0)
    assert what == "failure" and TOLD[name] in more
    for left in planting.inside.glob("hidden.txt"):
        left.unlink()
    assert planting.one("refuse", 1, 0)[0] == "refused"
    assert planting.read("refuse", planting.whole("refuse")[0])[0] == "value"


def test_a_result_counts_and_names_the_command(planting):
    result = planting.run("other", 1, range(3))
    assert (result.cases, result.values, result.refused, len(result.failures)) == (3, 0, 0, 3)
    assert result.failures[1].endswith("[python tests/fuzz other 1 1]")
    good = planting.run("refuse", 1, range(3))
    assert (good.refused, good.failures) == (3, [])
    lines = watch.table([result, good])
    assert len(lines) == 4 and lines[-1].split()[:5] == ["all", "6", "0", "3", "3"]


def test_a_case_is_the_same_ever_after(tmp_path):
    made = [watch.Watched(tmp_path / name) for name in ("a", "b")]
    for name in ("clicks-csv", "people-npz"):
        for case in range(20):
            one, other = (each.make(name, 7, case).read_bytes() for each in made)
            assert one == other
    different = {made[0].make("clicks-csv", seed, 0).read_bytes() for seed in range(20)}
    assert len(different) > 15


def test_every_way_changes_something(tmp_path):
    watched = watch.Watched(tmp_path)
    wholes = {}
    for name in ("clicks-csv", "clocks", "people-npz", "png", "jpeg", "mp4", "db3", "cameras-toml"):
        path = watched.whole(name)[0]
        wholes[path.suffix] = path.read_bytes()
    rng = random.Random(0)
    for way in {*texts.WAYS, *binaries.WAYS}:
        assert len({way(wholes[".csv"], rng) for _ in range(20)}) > 2, way
    for suffix, way in mutations.STRUCTURE.items():
        if suffix in wholes:
            assert len({way(wholes[suffix], rng) for _ in range(30)}) > 10, suffix
    assert trees.change_json(b"no tree", rng) == b"no tree"
    assert containers.change_zip(b"no archive", rng) == b"no archive"


def test_there_are_enough_cases_of_every_format():
    counts = {name: form.cases for name, form in formats.FORMATS.items()}
    assert sum(counts.values()) >= 20_000
    assert min(counts.values()) >= 200
    assert set(TOLD) == {fault.__name__ for fault in planted.BAD}
