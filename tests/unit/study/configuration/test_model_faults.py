"""Entries of models.yaml and detectors.yaml: every fault in one line that names the key."""

import shutil
from pathlib import Path

import pytest
import yaml

from courtside.study.configuration import configuration, yaml_files
from courtside.study.errors import InputError

CONFIG = Path(__file__).parents[4] / "config"
OWN = {"file": "data/n.onnx", "sha256": "0" * 64}
GIVEN = {"size": [192, 256], "channels": "rgb", "padding": 1.25}
MODEL = {"decoder": "simcc", "skeleton": "coco17", "input": GIVEN, "landmarks": OWN}
ONE = {"decoder": "rtmo", "skeleton": "coco17", "landmarks": OWN}
ONE |= {"input": {"size": [640, 640], "channels": "bgr"}}
FINDER = {"decoder": "yolox", "input": ONE["input"], "network": OWN}


@pytest.fixture
def folder(tmp_path):
    """Return a copy of config/ beside a network."""
    shutil.copytree(CONFIG, tmp_path / "config")
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "n.onnx").touch()
    return tmp_path / "config"


def load(folder, model=MODEL, finder=FINDER):
    for name, entry in (("models", model), ("detectors", finder)):
        content = yaml_files.read(CONFIG / f"{name}.yaml") | {"own": entry}
        (folder / f"{name}.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    config = yaml_files.read(CONFIG / "config.yaml")
    config |= {"sessions": ["walk-4cams"], "variations": [], "models": ["blazepose-full", "own"]}
    return configuration.load(config, "config/config.yaml", folder, root=folder.parent)


def without(entry, key):
    return {name: value for name, value in entry.items() if name != key}


def test_own_networks_are_read(folder):
    own = {"detector": "own", "split": 2, "flip_test": True, "full_score": 4.9}
    study = load(folder, MODEL | own)
    assert study.models["own"].detector.network.path == "data/n.onnx"
    assert study.models["own"].decoder_options()["split"] == 2
    assert study.models["own"].decoder_options()["full_score"] == 4.9
    assert load(folder).models["own"].detector.decoder == "blazepose"
    assert load(folder, ONE).models["own"].detector is None


@pytest.mark.parametrize(
    ("model", "part"),
    [
        (MODEL | {"skeleton": "octopus"}, "own.skeleton: expected one of"),
        (MODEL | {"detector": "nobody"}, "own.detector: expected one of ['blazepose-detector'"),
        (MODEL | {"cells": "udp"}, "own.cells: expected none with the decoder simcc"),
        (MODEL | {"decoder": "heatmaps", "split": 2}, "own.split: expected none"),
        (MODEL | {"full_score": 0}, "own.full_score: expected at least 0.01, found 0"),
        (ONE | {"full_score": 5}, "own.full_score: expected none with the decoder rtmo"),
        (without(MODEL, "input"), "own.input: expected with the decoder simcc, found none"),
        (without(MODEL, "landmarks"), "missing ['landmarks']"),
        (MODEL | {"input": without(GIVEN, "padding")}, "own.input: expected `padding`"),
        (MODEL | {"input": without(GIVEN, "channels")}, "missing ['channels']"),
        (MODEL | {"input": GIVEN | {"std": [1, 0, 1]}}, "own.input.std.1: expected more than 0"),
        (MODEL | {"input": GIVEN | {"range": [0, 1]}}, "own.input: expected keys of"),
        (MODEL | {"landmarks": OWN | {"sha256": "x"}}, "64 hexadecimal digits"),
        (MODEL | {"landmarks": OWN | {"file": "n.pth"}}, "an ONNX file"),
        (
            MODEL | {"landmarks": OWN | {"artefact": "a"}},
            "either `artefact` and `member`, or `file`",
        ),
        (MODEL | {"landmarks": without(OWN, "file")}, "either `artefact` and `member`, or `file`"),
        (MODEL | {"landmarks": OWN | {"file": "data/no.onnx"}}, "own.landmarks.file: expected an"),
        (ONE | {"detector": "own"}, "own.detector: expected none, for it finds persons itself"),
        (ONE | {"input": GIVEN}, "own.input: expected no `padding`"),
        (ONE | {"flip_test": True}, "own.flip_test: expected none with the decoder rtmo"),
    ],
)
def test_a_fault_of_a_model_is_one_line(folder, model, part):
    with pytest.raises(InputError) as caught:
        load(folder, model)
    (line,) = caught.value.lines
    assert "models.yaml" in line
    assert part in line, line


@pytest.mark.parametrize(
    ("finder", "part"),
    [
        (FINDER | {"decoder": "ssd"}, "own.decoder: expected one of"),
        (FINDER | {"input": GIVEN}, "own.input"),
        (without(FINDER, "input"), "own.input: expected with the decoder yolox, found none"),
        (FINDER | {"network": OWN | {"file": "data/d.onnx"}}, "own.network.file: expected an ONNX"),
        (
            FINDER | {"network": {"artefact": "a", "member": "m.onnx", "sha256": "0" * 64}},
            "own.network: expected a member of external.yaml",
        ),
    ],
)
def test_a_fault_of_a_detector_is_one_line(folder, finder, part):
    with pytest.raises(InputError) as caught:
        load(folder, MODEL | {"detector": "own"}, finder)
    (line,) = caught.value.lines
    assert "detectors.yaml" in line
    assert part in line, line


def test_an_absent_file_of_a_network_that_is_not_used_is_no_fault(folder):
    study = load(folder, finder=FINDER | {"network": OWN | {"file": "data/d.onnx"}})
    assert "own" in study.models
