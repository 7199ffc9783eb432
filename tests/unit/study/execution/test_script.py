from pathlib import Path
from types import SimpleNamespace

import pytest

from courtside.study.execution.script import arguments, run


class Named(dict):
    """What Snakemake gives a script for a part of its rule: by name and by attribute."""

    __getattr__ = dict.__getitem__


def job(**parts):
    named = ("input", "output", "params", "wildcards")
    return SimpleNamespace(
        **{name: Named(parts.get(name, {})) for name in named},
        rule="count_frames",
        threads=3,
        log=[parts.get("log", "all.log")],
    )


def test_files_parameters_and_wildcards_go_to_main_by_name():
    def main(video, table, *, camera, limit, threads):
        raise AssertionError

    given = job(
        input={"video": "a.mp4", "photos": ["b.png"]},
        output={"table": "a.csv"},
        params={"code": "abc", "limit": 4},
        wildcards={"camera": "left", "take": "t1"},
    )
    assert arguments(main, given) == {
        "video": "a.mp4",
        "table": "a.csv",
        "limit": 4,
        "camera": "left",
        "threads": 3,
    }


def test_an_input_left_empty_keeps_the_default():
    def main(video, court=None, clicks=()):
        raise AssertionError

    given = job(input={"video": [], "court": [], "clicks": ["c.csv"]})
    assert arguments(main, given) == {"video": [], "clicks": ["c.csv"]}


def test_the_parameters_of_a_step_are_spread_unless_main_takes_the_step():
    def spread(**step):
        raise AssertionError

    def whole(step):
        raise AssertionError

    given = job(params={"step": {"a": 1, "b": 2}})
    assert arguments(spread, given) == {"a": 1, "b": 2}
    assert arguments(whole, given) == {"step": {"a": 1, "b": 2}}


def test_paths_are_all_inputs():
    def main(paths, table):
        raise AssertionError

    given = job(input={"video": "a.mp4", "table": "old.csv"}, output={"table": "a.csv"})
    found = arguments(main, given)
    assert found["paths"].video == "a.mp4" and found["table"] == "a.csv"


def test_a_parameter_goes_before_a_wildcard_of_its_name():
    def main(camera):
        raise AssertionError

    given = job(params={"camera": "stated"}, wildcards={"camera": "left"})
    assert arguments(main, given) == {"camera": "stated"}


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({}, "rule count_frames: expected video for its script, found none"),
        ({"input": {"video": "a"}, "output": {"video": "b"}},
         "rule count_frames: video is given twice"),
        ({"input": {"video": "a"}, "params": {"fps": 2}},
         "rule count_frames: its script does not take fps"),
    ],
)  # fmt: skip
def test_a_rule_and_a_script_that_disagree_are_named(parts, message):
    def main(video):
        raise AssertionError

    with pytest.raises(TypeError, match=message):
        arguments(main, job(**parts))


def test_a_script_runs_with_its_log_open(tmp_path):
    log = tmp_path / "logs" / "all.log"

    def main(table, *, words):
        assert log.is_file()
        Path(table).write_text(words)

    table = tmp_path / "a.csv"
    run(main, job(output={"table": str(table)}, params={"words": "x,y"}, log=str(log)))
    assert table.read_text() == "x,y"
