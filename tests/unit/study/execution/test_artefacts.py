"""Fetching pinned files: mirror and registries, checksums, and archives that mean harm."""

import gzip
import hashlib
import io
import struct
import tarfile
import zipfile
import zlib
from pathlib import Path

import pytest

from courtside.study.errors import InputError
from courtside.study.execution import artefacts, registries
from courtside.study.execution.artefacts import Artefact
from fixtures.study import npm

CONFIG = Path(__file__).parents[4] / "config"
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
    return Artefact("thing", **(entry | changes))


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
    one = Artefact("net", **(entry | {"members": {"net.tflite": sha256(b"net")}}))
    artefacts.fetch(one, {"net.tflite": tmp_path / "out" / "net.tflite"}, mirror_folder=tmp_path)
    assert (tmp_path / "out" / "net.tflite").read_bytes() == b"net"


def test_what_no_registry_holds_must_be_in_the_mirror(tmp_path):
    entry = {"mirror_file": "net.tflite", "sha256": "0" * 64, "licence": "MIT", "members": {}}
    with pytest.raises(InputError, match=r"net\.tflite in the folder that `mirror_folder`"):
        artefacts.fetch(Artefact("net", **entry), {}, mirror_folder=None)
    with pytest.raises(InputError, match="mirror_folder: expected a folder"):
        artefacts.fetch(Artefact("net", **entry), {}, mirror_folder=tmp_path / "none")


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


def test_the_mirror_comes_before_the_registry(mirror, tmp_path, monkeypatch):
    monkeypatch.setattr(registries.subprocess, "run", None)  # a call would raise TypeError
    artefacts.fetch(artefact(mirror), outputs(tmp_path), mirror_folder=mirror)
    assert len(made(tmp_path)) == 2


def test_a_wheel_is_found_by_its_normalised_name(mirror, tmp_path):
    one = artefact(mirror, requirement="My.odd-Thing==1.0")
    (mirror / "thing-1.0-py3-none-any.whl").rename(mirror / "my_odd_thing-1.0-py3-none-any.whl")
    (mirror / "my_odd-1.0-py3-none-any.whl").touch()
    (mirror / "nameless.whl").touch()
    artefacts.fetch(one, outputs(tmp_path), mirror_folder=mirror)
    assert len(made(tmp_path)) == 2


def test_a_wrong_checksum_is_refused_before_the_file_is_opened(mirror, tmp_path, monkeypatch):
    one = artefact(mirror, sha256="0" * 64)
    monkeypatch.setattr(artefacts.zipfile, "ZipFile", None)
    with pytest.raises(InputError, match="expected sha256 0000"):
        artefacts.fetch(one, outputs(tmp_path), mirror_folder=mirror)


def bomb(mirror, declared, crc=None):
    """Rewrite the wheel so that pkg/a.bin, 1000 bytes, declares another size."""
    path = mirror / "thing-1.0-py3-none-any.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("pkg/b.bin", "pkg/a.bin"):
            archive.writestr(name, CONTENT[name])
    content = bytearray(path.read_bytes())
    entry = content.rindex(b"PK\1\2")  # the last entry of the directory
    struct.pack_into("<I", content, entry + 24, declared)
    if crc is not None:
        struct.pack_into("<I", content, entry + 16, crc)
    path.write_bytes(content)


@pytest.mark.parametrize(
    ("declared", "crc", "message"),
    [
        (2 << 30, None, "expected at most 1 GiB, found 2147483648 bytes"),
        (10, None, "expected a whole file"),
        (10, zlib.crc32(b"a" * 10), "expected sha256"),
    ],
)
def test_a_false_size_leaves_nothing(mirror, tmp_path, declared, crc, message):
    bomb(mirror, declared, crc)
    wanted = dict(reversed(outputs(tmp_path).items()))
    assert next(iter(wanted)) == "pkg/b.bin"  # the sound member comes first
    with pytest.raises(InputError, match=r"member pkg/a\.bin") as caught:
        artefacts.fetch(artefact(mirror), wanted, mirror_folder=mirror)
    assert message in str(caught.value)
    assert made(tmp_path) == []


def test_a_damaged_member_leaves_nothing(mirror, tmp_path):
    path = mirror / "thing-1.0-py3-none-any.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in CONTENT.items():
            archive.writestr(name, content)
    content = bytearray(path.read_bytes())
    content[30 + len("pkg/a.bin")] = 0xFF  # the first byte of the deflated stream
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"pkg/a\.bin: expected a whole file"):
        artefacts.fetch(artefact(mirror), outputs(tmp_path), mirror_folder=mirror)
    assert made(tmp_path) == []


def test_a_wheel_that_is_no_zip_file_is_one_line(mirror, tmp_path):
    (mirror / "thing-1.0-py3-none-any.whl").write_bytes(b"<html>not found</html>")
    with pytest.raises(InputError, match="expected a zip file"):
        artefacts.fetch(artefact(mirror), outputs(tmp_path), mirror_folder=mirror)


def test_a_single_file_that_reads_as_a_zip_file_is_copied_whole(mirror, tmp_path):
    wheel = mirror / "thing-1.0-py3-none-any.whl"
    content = b"network" + wheel.read_bytes()
    assert zipfile.is_zipfile(io.BytesIO(content))
    (mirror / "net.tflite").write_bytes(content)
    entry = {"mirror_file": "net.tflite", "sha256": sha256(content), "licence": "MIT"}
    one = Artefact("net", **(entry | {"members": {"net.tflite": sha256(content)}}))
    artefacts.fetch(one, {"net.tflite": tmp_path / "out" / "net.tflite"}, mirror_folder=mirror)
    assert (tmp_path / "out" / "net.tflite").read_bytes() == content


def test_a_file_that_is_not_in_the_mirror_folder_is_named_with_its_note(tmp_path):
    entry = {"mirror_file": "n.bin", "sha256": "0" * 64, "licence": "MIT", "note": "ask Ann"}
    one = Artefact("net", **(entry | {"members": {}}))
    with pytest.raises(InputError, match=r"expected n\.bin in the folder .*; ask Ann"):
        artefacts.fetch(one, {}, mirror_folder=tmp_path)


PACKAGE = "@scope/thing@1.0"
TARBALL = "scope-thing-1.0.tgz"


def entry(name, content=b"", kind=tarfile.REGTYPE, target=""):
    info = tarfile.TarInfo(name)
    info.size, info.type, info.linkname = len(content), kind, target
    return info, content


def tarball(folder, *entries):
    """Write an npm package with these entries, and return its pin."""
    folder.mkdir(exist_ok=True)
    with tarfile.open(folder / TARBALL, "w:gz") as archive:
        for info, content in entries or [entry(name, content) for name, content in CONTENT.items()]:
            archive.addfile(info, io.BytesIO(content))
    return npm_artefact(folder)


def npm_artefact(folder, **changes):
    pin = {"package": PACKAGE, "sha256": sha256((folder / TARBALL).read_bytes()), "licence": "MIT"}
    pin["members"] = {name: sha256(CONTENT[name]) for name in ("pkg/a.bin", "pkg/b.bin")}
    return Artefact("thing", **(pin | changes))


def test_an_npm_package_in_the_mirror_comes_before_the_registry(tmp_path, monkeypatch):
    one = tarball(tmp_path / "mirror")
    monkeypatch.setattr(registries.subprocess, "run", None)
    artefacts.fetch(one, outputs(tmp_path), mirror_folder=tmp_path / "mirror")
    assert {path.read_bytes() for path in made(tmp_path)} == {
        CONTENT["pkg/a.bin"],
        CONTENT["pkg/b.bin"],
    }


def test_an_npm_package_is_fetched_by_npm(tmp_path, monkeypatch):
    one = tarball(tmp_path / "registry")
    arguments = npm.only(tmp_path, tmp_path / "registry" / TARBALL, monkeypatch)
    (tmp_path / "mirror").mkdir()
    artefacts.fetch(one, outputs(tmp_path), mirror_folder=tmp_path / "mirror")
    assert len(made(tmp_path)) == 2
    assert arguments()[:2] == ["pack", PACKAGE]
    assert "--ignore-scripts" in arguments()


def test_a_package_with_a_wrong_checksum_leaves_nothing(tmp_path, monkeypatch):
    tarball(tmp_path / "registry")
    npm.only(tmp_path, tmp_path / "registry" / TARBALL, monkeypatch)
    with pytest.raises(InputError, match="expected sha256 0000") as caught:
        artefacts.fetch(npm_artefact(tmp_path / "registry", sha256="0" * 64), outputs(tmp_path))
    assert "artefact thing" in str(caught.value)
    assert made(tmp_path) == []


def test_where_npm_finds_nothing_one_line_says_what_to_do(tmp_path, monkeypatch):
    one = tarball(tmp_path / "registry")
    npm.only(tmp_path, tmp_path / "none.tgz", monkeypatch)
    with pytest.raises(InputError) as caught:
        artefacts.fetch(one, outputs(tmp_path))
    assert str(caught.value) == (
        "artefact thing: expected @scope/thing@1.0 from the npm registry, found: request to "
        "x failed, reason: no such place; install npm or go online, or put "
        f"scope-thing-1.0.tgz with sha256 {one.sha256} into the folder that `mirror_folder` of "
        "config.yaml names"
    )


@pytest.mark.parametrize(
    ("second", "message"),
    [
        (entry("pkg/b.bin", kind=tarfile.DIRTYPE), "expected the member pkg/b.bin, found none"),
        (entry("pkg/b.bin", kind=tarfile.SYMTYPE, target="/etc/hostname"), "found none"),
        (entry("pkg/b.bin", kind=tarfile.LNKTYPE, target="pkg/a.bin"), "found none"),
        (entry("../pkg/b.bin", CONTENT["pkg/b.bin"]), "found none"),
        (entry("pkg/b.bin", b"other"), r"member pkg/b\.bin: expected sha256"),
    ],
)
def test_a_member_of_a_package_that_is_no_file_leaves_nothing(tmp_path, second, message):
    one = tarball(tmp_path / "mirror", entry("pkg/a.bin", CONTENT["pkg/a.bin"]), second)
    with pytest.raises(InputError, match=message):
        artefacts.fetch(one, outputs(tmp_path), mirror_folder=tmp_path / "mirror")
    assert made(tmp_path) == []


def test_a_false_size_in_a_package_leaves_nothing(tmp_path):
    """A tar file is no longer than its content, whatever sizes it states."""
    folder = tmp_path / "mirror"
    tarball(folder)
    raw = bytearray(gzip.decompress((folder / TARBALL).read_bytes()))
    raw[124:135] = b"%011o" % (2 << 30)
    raw[148:156] = b"%06o\0 " % (sum(raw[:148]) + 8 * 32 + sum(raw[156:512]))
    (folder / TARBALL).write_bytes(gzip.compress(bytes(raw)))
    with pytest.raises(InputError, match=r"member pkg/a\.bin: expected") as caught:
        artefacts.fetch(npm_artefact(folder), outputs(tmp_path), mirror_folder=folder)
    assert "\n" not in str(caught.value)
    assert made(tmp_path) == []


def test_a_member_that_a_package_lacks_leaves_nothing(tmp_path):
    one = tarball(tmp_path / "mirror", entry("pkg/a.bin", CONTENT["pkg/a.bin"]))
    with pytest.raises(InputError, match=r"expected the member pkg/b\.bin, found none"):
        artefacts.fetch(one, outputs(tmp_path), mirror_folder=tmp_path / "mirror")
    assert made(tmp_path) == []


def test_a_package_that_is_too_large_or_damaged_leaves_nothing(tmp_path, monkeypatch):
    folder = tmp_path / "mirror"
    one = tarball(folder)
    with monkeypatch.context() as patched:
        patched.setattr(artefacts, "LARGEST_MEMBER_BYTES", 999)
        with pytest.raises(InputError, match=r"pkg/a\.bin: expected at most"):
            artefacts.fetch(one, outputs(tmp_path), mirror_folder=folder)
    whole = (folder / TARBALL).read_bytes()
    for content in (b"<html>not found</html>", whole[: len(whole) // 2], b""):
        (folder / TARBALL).write_bytes(content)
        with pytest.raises(InputError, match="expected a") as caught:
            artefacts.fetch(npm_artefact(folder), outputs(tmp_path), mirror_folder=folder)
        assert "\n" not in str(caught.value)
    assert made(tmp_path) == []
