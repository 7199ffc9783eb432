"""Writing files and folders so that a half-written one never looks finished."""

import contextlib
import hashlib
import json
import os
import re
import secrets
import shutil
import time
import unicodedata
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from courtside.study.errors import InputError, StrPath, reading

CHUNK_BYTES = 1 << 20
PHOTOS = (".jpg", ".jpeg", ".png", ".tif", ".tiff", ".bmp", ".webp")  # that are read
# Names that `atomic` and `atomic_folder` give.
UNFINISHED = re.compile(r"\..+\.[0-9a-f]{8}(\.\w+)?")
WINDOWS = os.name == "nt"
WAITS_S = (0.1, 0.2, 0.3, 0.4)  # for a program that has a file open only shortly, as scanners do


@contextlib.contextmanager
def atomic(path: StrPath) -> Iterator[Path]:
    """Give a temporary path beside `path`; rename it to `path` when the block ends well.

    The temporary file keeps the suffix, because some writers choose the format by it, and is
    deleted if the block raises. Missing parent folders of `path` are made.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.{secrets.token_hex(4)}{path.suffix}")
    try:
        yield temporary
        _rename(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


@contextlib.contextmanager
def atomic_folder(path: StrPath) -> Iterator[Path]:
    """Give a new folder beside `path`; rename it to `path` when the block ends well.

    It is deleted if the block raises, and `path` stays as it was. Missing parent folders are made;
    a folder `path` is replaced.
    """
    path = Path(path)
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
    old = temporary.with_suffix(".old")
    temporary.mkdir(parents=True)
    try:
        yield temporary
        if path.exists():  # a folder that is not empty cannot be renamed over
            _rename(path, old)
        try:
            _rename(temporary, path)
        except (OSError, InputError):  # on Windows, a program may have one of its files open
            if old.exists():
                _rename(old, path)
            raise
    finally:
        for rest in (temporary, old):
            shutil.rmtree(rest, ignore_errors=True)


def _rename(path: Path, new: Path) -> None:
    """Rename a file, over an older one too, or a folder.

    Windows refuses it while a program has the file open, so there it is tried again for a second.
    """
    for wait_s in WAITS_S if WINDOWS else ():
        try:
            path.replace(new)
            return
        except PermissionError:
            time.sleep(wait_s)
    try:
        path.replace(new)
    except PermissionError as error:
        if not WINDOWS:
            raise
        raise InputError(
            f"{new}: expected the right to write it, found: {error.strerror}; close the programs "
            "that have it open, then give the same command again"
        ) from error


def seen_from(path: StrPath, folder: StrPath = ".") -> str:
    """Return a path relative to a folder, with `/`; absolute between drives of Windows."""
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:
        return Path(path).resolve().as_posix()


def misspelt(path: str, root: StrPath = ".") -> str:
    """Return the advice on a path from `root` where nothing is, if something is nearly there.

    It may differ in capital letters, in how accents are stored (macOS takes them apart from their
    letters), or in the signs between folders, which are backslashes on Windows alone. Empty if
    nothing is.
    """
    if path.startswith("~"):
        return "write the whole path in place of ~"
    near = _nearly(path, Path(root))
    if near is None:
        return ""
    if unicodedata.normalize("NFC", near) == unicodedata.normalize("NFC", path):
        return (
            "a name there looks the same, but its accents are stored in another way: copy the name "
            "from a list of the files, or rename the file"
        )
    return f"did you mean {near!r}?"


def _nearly(path: str, root: Path) -> str | None:
    """Return the path of what is there in place of a misspelt one, as that is written."""
    found = Path()
    for part in Path(path.replace("\\", "/")).parts:
        at = root / found
        try:
            others = [] if (at / part).exists() else [one.name for one in at.iterdir()]
        except (OSError, ValueError):
            return None
        alike = [name for name in others if _plain(name) == _plain(part)] if others else [part]
        if len(alike) != 1:
            return None
        found /= alike[0]
    return found.as_posix() if (root / found).exists() else None


def _plain(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


def delete_unfinished(folder: StrPath) -> None:
    """Delete what killed jobs left below a folder; only when no job is running there."""
    found = [path for path in Path(folder).rglob(".*") if UNFINISHED.fullmatch(path.name)]
    for path in found:
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


def write_json(path: StrPath, content: Any) -> None:
    """Write a JSON file that people can read, whole or not at all."""
    with atomic(path) as temporary:
        temporary.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8", newline="\n")


def read_json(path: StrPath, advice: str = "make it again") -> Any:
    """Read a JSON file; an `InputError` with `advice` where it is missing or no JSON."""
    with reading(path, "JSON", advice):
        return json.loads(Path(path).read_text(encoding="utf-8-sig"))


def sha256(path: StrPath) -> str:
    """Return the SHA-256 of a file as 64 hexadecimal digits, reading it in pieces."""
    digest = hashlib.sha256()
    with Path(path).open("rb") as stream:
        while chunk := stream.read(CHUNK_BYTES):
            digest.update(chunk)
    return digest.hexdigest()
