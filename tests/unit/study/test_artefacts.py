"""Fetching pinned files: mirror and registry, checksums, and archives that mean harm."""

import hashlib
import zipfile
from pathlib import Path

import pytest

from courtside.study import artefacts
from courtside.study.artefacts import Artefact
from courtside.study.errors import InputError

CONFIG = Path(__file__).parents[3] / "config"
CONTENT = {"pkg/a.bin": b"a" * 1000, "pkg/b.bin": b"b" * 10, "pkg/other.txt": b"unwanted"}


def sha256(content):
    return hashlib.sha256(content).hexdigest()


@pytest.fixture
def mirror(tmp_path):
    folder = tmp_path / "mirror"
    folder.mkdir()
    with zipfile.ZipFile(folder / "thing-1.0-py3-none-any.whl", "w") as archive:
        for name, content in CONTENT.items():
            archive.writestr(name, content)
    return folder


def artefact(mirror, **changes):
    wheel = mirror / "thing-1.0-py3-none-any.whl"
    entry = {
        "requirement": "thing==1.0",
        "sha256": sha256(wheel.read_bytes()),
        "licence": "MIT",
        "members": {name: sha256(CONTENT[name]) for name in ("pkg/a.bin", "pkg/b.bin")},
    }
    return Artefact.of("thing", entry | changes)


def outputs(tmp_path):
    return {name: tmp_path / "out" / name for name in ("pkg/a.bin", "pkg/b.bin")}


def made(tmp_path):
    return [path for path in (tmp_path / "out").rglob("*") if path.is_file()]


def test_only_the_named_members_are_unpacked(mirror, tmp_path):
    artefacts.fetch(artefact(mirror), outputs(tmp_path), mirror_folder=mirror)
    assert {path.read_bytes() for path in made(tmp_path)} == {
        CONTENT["pkg/a.bin"],
        CONTENT["pkg/b.bin"],
    }


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"sha256": "0" * 64}, "expected sha256 0000"),
        ({"members": {"pkg/a.bin": "0" * 64, "pkg/b.bin": "0" * 64}}, "member pkg/a.bin: expected"),
        (
            {"members": {"pkg/a.bin": sha256(b"a" * 1000), "pkg/b.bin": "0" * 64}},
            "member pkg/b.bin",
        ),
    ],
)
def test_a_wrong_checksum_leaves_nothing(mirror, tmp_path, changes, message):
    with pytest.raises(InputError, match=message):
        artefacts.fetch(artefact(mirror, **changes), outputs(tmp_path), mirror_folder=mirror)
    assert made(tmp_path) == []


def test_a_missing_member_leaves_nothing(mirror, tmp_path):
    wanted = {"pkg/a.bin": sha256(CONTENT["pkg/a.bin"]), "pkg/none": "0" * 64}
    places = {name: tmp_path / "out" / name for name in wanted}
    with pytest.raises(InputError, match="expected the member pkg/none"):
        artefacts.fetch(artefact(mirror, members=wanted), places, mirror_folder=mirror)
    assert made(tmp_path) == []


@pytest.mark.parametrize("name", ["../escape", "/etc/passwd", "pkg/../../escape"])
def test_a_member_outside_is_refused(mirror, tmp_path, name):
    with pytest.raises(InputError, match="expected members inside"):
        artefacts.fetch(artefact(mirror), {name: tmp_path / "out" / "x"}, mirror_folder=mirror)


def test_a_member_that_is_too_large_is_refused(mirror, tmp_path, monkeypatch):
    monkeypatch.setattr(artefacts, "LARGEST_MEMBER_BYTES", 999)
    with pytest.raises(InputError, match=r"pkg/a\.bin: expected at most"):
        artefacts.fetch(artefact(mirror), outputs(tmp_path), mirror_folder=mirror)
    assert made(tmp_path) == []


def test_a_single_file_is_its_own_member(tmp_path):
    (tmp_path / "net.tflite").write_bytes(b"net")
    entry = {"mirror_file": "net.tflite", "sha256": sha256(b"net"), "licence": "MIT"}
    one = Artefact.of("net", entry | {"members": {"net.tflite": sha256(b"net")}})
    artefacts.fetch(one, {"net.tflite": tmp_path / "out" / "net.tflite"}, mirror_folder=tmp_path)
    assert (tmp_path / "out" / "net.tflite").read_bytes() == b"net"


def test_what_no_registry_holds_must_be_in_the_mirror(tmp_path):
    entry = {"mirror_file": "net.tflite", "sha256": "0" * 64, "licence": "MIT", "members": {}}
    with pytest.raises(InputError, match=r"net\.tflite in the folder that `mirror_folder`"):
        artefacts.fetch(Artefact.of("net", entry), {}, mirror_folder=None)
    with pytest.raises(InputError, match="mirror_folder: expected a folder"):
        artefacts.fetch(Artefact.of("net", entry), {}, mirror_folder=tmp_path / "none")


def test_offline_is_one_line_that_says_what_to_do(mirror, tmp_path, monkeypatch):
    one = artefact(mirror)
    for key, value in {
        "PIP_INDEX_URL": "http://127.0.0.1:9/simple",
        "PIP_EXTRA_INDEX_URL": "",
        "PIP_FIND_LINKS": "",
        "PIP_CONFIG_FILE": "/dev/null",
        "PIP_RETRIES": "0",
    }.items():
        monkeypatch.setenv(key, value)
    with pytest.raises(InputError) as caught:
        artefacts.fetch(one, outputs(tmp_path))
    assert "go online, or put the wheel" in str(caught.value)
    assert "\n" not in str(caught.value)
    assert made(tmp_path) == []


def test_the_committed_register_reads():
    known = artefacts.read(CONFIG / "external.yaml")
    assert {"mediapipe", "pose2sim", "cpm-mobile-14"} <= set(known)
