"""Execution providers are asked for before any job, in every session."""

from dataclasses import replace
from pathlib import Path

import pytest

from courtside.study.configuration import configuration, yaml_files
from courtside.study.errors import InputError
from courtside.validation import providers
from fixtures.study import yaml_read

CONFIG = Path(__file__).parents[3] / "config"


@pytest.fixture(scope="module", autouse=True)
def parsed_once():
    """Parse each configuration file only once."""
    with yaml_read.remembered():
        yield


def study(named):
    content = yaml_files.read(CONFIG / "config.yaml")
    content |= {"sessions": ["walk-4cams", "players-b"], "variations": []}
    found = configuration.load(content, "config/config.yaml", CONFIG)
    session = found.sessions["players-b"]
    step = session.parameters["detect_pose"] | {"providers": named}
    changed = replace(session, parameters=session.parameters | {"detect_pose": step})
    return replace(found, sessions=found.sessions | {"players-b": changed})


def test_the_default_asks_for_nothing():
    assert study(["cpu"]).parameters["detect_pose"]["providers"] == ["cpu"]
    assert providers.check(study(["cpu"])) is None


def test_what_a_session_lacks_is_one_line_each():
    with pytest.raises(InputError) as caught:
        providers.check(study(["cuda", "directml", "cpu"]))
    first, second = caught.value.lines
    assert "players-b.yaml: detect_pose.providers: expected the execution provider cuda" in first
    assert "install onnxruntime-gpu in place of onnxruntime" in first
    assert "directml" in second and "onnxruntime-directml" in second


def test_what_the_whole_study_lacks_is_one_line():
    content = yaml_files.read(CONFIG / "config.yaml")
    content["detect_pose"]["providers"] = ["cuda", "cpu"]
    content |= {"sessions": ["walk-4cams", "players-b"], "variations": []}
    with pytest.raises(InputError) as caught:
        providers.check(configuration.load(content, "config/config.yaml", CONFIG))
    (line,) = caught.value.lines
    assert line.startswith(
        "config/config.yaml: detect_pose.providers: expected the execution provider cuda"
    )
