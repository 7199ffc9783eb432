"""The list of parts holds what lock and pins hold, read here in another way, in CycloneDX form."""

import json
import re
import runpy
import subprocess
import sys
from pathlib import Path

import jsonschema
import numpy as np
import pytest
import yaml
from packaging.requirements import Requirement

from courtside.study.errors import InputError
from courtside.study.execution.artefacts import Artefact
from courtside.study.provenance import sbom

ROOT = Path(__file__).parents[4]
PROGRAM = ROOT / "workflow" / "list_parts.py"
ABOUT = {"name": "study", "version": "1", "licence": "MIT"}
HASH = "0" * 64
# From the specification of CycloneDX 1.6, those parts of it that are used here.
LICENCES = {
    "type": "array",
    "maxItems": 1,
    "items": {
        "oneOf": [
            {"type": "object", "required": ["expression"], "additionalProperties": False,
             "properties": {"expression": {"type": "string", "minLength": 1}}},
            {"type": "object", "required": ["license"], "additionalProperties": False,
             "properties": {"license": {"type": "object", "required": ["name"]}}},
        ]
    },
}  # fmt: skip
SCHEMA = {
    "type": "object",
    "required": ["bomFormat", "specVersion", "components"],
    "properties": {
        "bomFormat": {"const": "CycloneDX"},
        "specVersion": {"const": "1.6"},
        "version": {"type": "integer", "minimum": 1},
        "components": {"type": "array", "items": {"$ref": "#/$defs/component"}},
        "metadata": {"properties": {"component": {"$ref": "#/$defs/component"}}},
    },
    "$defs": {
        "component": {
            "type": "object",
            "required": ["type", "name", "bom-ref"],
            "additionalProperties": False,
            "properties": {
                "type": {"enum": ["application", "library", "data", "file"]},
                "name": {"type": "string"},
                "version": {"type": "string", "minLength": 1},
                "bom-ref": {"type": "string", "minLength": 1},
                "purl": {
                    "type": "string",
                    "pattern": "^pkg:(pypi|npm/%40[a-z0-9-]+)/[a-z0-9._-]+@[^@ ]+$",
                },
                "description": {"type": "string"},
                "hashes": {
                    "type": "array",
                    "minItems": 1,
                    "items": {
                        "required": ["alg", "content"],
                        "properties": {
                            "alg": {"const": "SHA-256"},
                            "content": {"pattern": "^[a-fA-F0-9]{64}$"},
                        },
                    },
                },
                "licenses": LICENCES,
                "properties": {"type": "array", "items": {"required": ["name", "value"]}},
                "components": {"type": "array", "items": {"$ref": "#/$defs/component"}},
            },
        }
    },
}


@pytest.fixture(scope="module")
def listed():
    """Return what the program says of this repository."""
    done = subprocess.run(
        [sys.executable, str(PROGRAM)], capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


def locked():
    """Yield (requirement, hashes) of the lock, as pip reads it: one for each line that goes on."""
    text = (ROOT / "environment.lock").read_text().replace("\\\n", " ")
    for line in text.splitlines():
        if line.strip() and not line.lstrip().startswith("#"):
            words, *hashes = line.split("--hash=sha256:")
            yield Requirement(words.strip()), sorted(each.strip() for each in hashes)


def test_every_pinned_package_is_in_it_with_every_checksum(listed):
    libraries = [part for part in listed["components"] if part["type"] == "library"]
    found = {
        (p["name"], p["version"]): sorted(h["content"] for h in p["hashes"]) for p in libraries
    }
    expected = {
        (requirement.name, str(requirement.specifier).removeprefix("==")): hashes
        for requirement, hashes in locked()
    }
    assert found == expected
    assert len(libraries) == len(expected) > 100
    markers = sorted(p["properties"][0]["value"] for p in libraries if "properties" in p)
    assert len(markers) == sum(requirement.marker is not None for requirement, _ in locked())


def test_every_artefact_is_in_it_with_members_and_licence(listed):
    pins = yaml.safe_load((ROOT / "config" / "external.yaml").read_text())
    found = {
        p["bom-ref"].removeprefix("artefact:"): p
        for p in listed["components"]
        if p["type"] == "data"
    }
    assert sorted(found) == sorted(pins)
    for name, pin in pins.items():
        assert found[name]["hashes"] == [{"alg": "SHA-256", "content": pin["sha256"]}]
        assert found[name]["licenses"] == [{"expression": pin["licence"]}]
        members = {m["name"]: m["hashes"][0]["content"] for m in found[name]["components"]}
        assert members == pin["members"]
        if "requirement" in pin:
            assert f"{found[name]['name']}=={found[name]['version']}" == pin["requirement"]
        if "package" in pin:
            assert f"{found[name]['name']}@{found[name]['version']}" == pin["package"]


def test_it_has_the_form_of_cyclonedx(listed):
    jsonschema.validate(listed, SCHEMA)
    text = json.dumps(listed)
    references = re.findall(r'"bom-ref": "([^"]*)"', text)
    assert len(references) == len(set(references)) > 100


def test_licences_are_those_of_the_installed_versions(listed):
    of = {(p["name"], p.get("version")): p.get("licenses") for p in listed["components"]}
    assert of["pytest", pytest.__version__] == [{"expression": "MIT"}]
    (numpy,) = of["numpy", np.__version__]
    assert "BSD-3-Clause" in numpy["expression"]
    assert of["tomli-w", "1.2.0"] == [{"license": {"name": "MIT License"}}]
    assert sbom.installed_licence("numpy", "0.1") is None
    assert sbom.installed_licence("not-installed-at-all", "1") is None


def test_it_is_written_to_a_file_and_the_same_each_time(listed, tmp_path):
    path = tmp_path / "sbom.json"
    subprocess.run([sys.executable, str(PROGRAM), "--output", str(path)], check=True)
    assert json.loads(path.read_text()) == listed


def test_a_file_that_cannot_be_written_is_one_line(monkeypatch):
    monkeypatch.setattr(sys, "argv", [str(PROGRAM), "--output", "/dev/null/x"])
    with pytest.raises(SystemExit, match=r"^Error: .*") as ended:
        runpy.run_path(str(PROGRAM), run_name="__main__")
    assert len(ended.value.code.splitlines()) == 1  # a text: the exit status is 1


@pytest.mark.parametrize(
    ("lock", "n_named", "n_found"),
    [
        ("a==1\n", 1, 0),
        (f"a==1 \\\n    --hash=sha256:{HASH}\nb==2\n", 2, 1),
        (f"a==1 \\\n    --hash=sha256:{HASH}\nb>=2 \\\n    --hash=sha256:{HASH}\n", 2, 1),
        (f"a==1 \\\n    --hash=md5:{HASH}\n", 1, 0),
        ("-r other.txt\n", 1, 0),
    ],
)
def test_what_is_not_pinned_is_refused(lock, n_named, n_found):
    with pytest.raises(InputError, match=rf"each of {n_named} requirements.* {n_found};"):
        sbom.of_study(lock, [], **ABOUT)


def test_every_form_of_a_pin_in_a_lock_is_read():
    lock = (
        "# made by\n"
        f"A.b[extra]==1.0.post1 ; python_version < '4' \\\n    --hash=sha256:{HASH} \\\n"
        f"    --hash=sha256:{HASH}\n    # via x\nc==2 \\\n    --hash=sha256:{HASH}\n"
    )
    first, second = sbom.of_study(lock, [], **ABOUT)["components"]
    assert (first["name"], first["version"], len(first["hashes"])) == ("A.b", "1.0.post1", 2)
    assert first["properties"] == [{"name": "marker", "value": "python_version < '4'"}]
    assert (second["name"], second["version"], len(second["hashes"])) == ("c", "2", 1)


def test_an_artefact_that_no_registry_holds():
    artefact = Artefact(
        "net", HASH, {"net.tflite": HASH}, "free to use, ask", mirror_file="net.tflite"
    )
    (part,) = sbom.of_study("", [artefact], **ABOUT)["components"]
    assert "version" not in part and "purl" not in part
    assert part["licenses"] == [{"license": {"name": "free to use, ask"}}]


def test_an_npm_package_has_the_url_of_its_kind():
    artefact = Artefact("net", HASH, {"package/n": HASH}, "MIT", package="@scope/thing@1.0")
    (part,) = sbom.of_study("", [artefact], **ABOUT)["components"]
    assert (part["name"], part["version"]) == ("@scope/thing", "1.0")
    assert part["purl"] == "pkg:npm/%40scope/thing@1.0"
