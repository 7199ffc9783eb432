"""Checksums of many large files, computed again only for a file whose size or date changed."""

import hashlib
import time
from collections.abc import Callable, Iterable
from pathlib import Path

from courtside.study.errors import DAMAGED, StrPath
from courtside.study.execution import files

FORMAT = 1
# A file that changed a moment ago may change again within one tick of the file system's clock.
SETTLED_NS = 2_000_000_000


def of_path(path: StrPath) -> str:
    """Return the SHA-256 of a file, or of a folder: of names and checksums of all its files."""
    path = Path(path)
    return _of_folder(path, files.sha256) if path.is_dir() else files.sha256(path)


def _of_folder(folder: Path, of_file: Callable[[Path], str | None]) -> str:
    digest = hashlib.sha256()
    for file in members(folder):
        digest.update(f"{file.relative_to(folder).as_posix()}\0{of_file(file)}\n".encode())
    return digest.hexdigest()


def members(folder: StrPath) -> list[Path]:
    """Return all files in a folder, in the order of their names, without Snakemake's time stamp."""
    found = (path for path in Path(folder).rglob("*") if path.is_file())
    return sorted(path for path in found if path.name != ".snakemake_timestamp")


class Checksums:
    """The checksums of a study's inputs, kept in one JSON file between runs.

    A file that cannot be read as such is taken for an empty one. A folder is looked at once: many
    results rest on the same recordings. `until` has the date, ns, of the newest file that was made
    directly from an input: Snakemake does not see another input that is no newer than this. Of
    files in `doubtful` nothing is known.
    """

    def __init__(self, path: StrPath) -> None:
        self.path = Path(path)
        self.known, self.until = self._read()
        self.folders: dict[Path, str] = {}
        self.doubtful: set[str] = set()
        self.changed = False

    def _read(self) -> tuple[dict[str, list], dict[str, int]]:
        try:
            content = files.read_json(self.path)
            if content["format"] != FORMAT:
                return {}, {}
            known = {
                name: [int(size), int(stamp_ns), str(value)]
                for name, (size, stamp_ns, value) in content["files"].items()
            }
            until = content.get("until", {})
            return known, {name: int(stamp_ns) for name, stamp_ns in until.items()}
        except DAMAGED:
            return {}, {}

    def of(self, path: StrPath) -> str | None:
        """Return the SHA-256 of a file or folder; None if there is none, or it is in doubt."""
        path = Path(path)
        if str(path) in self.doubtful:
            return None
        if path.is_dir():
            if path not in self.folders:
                self.folders[path] = _of_folder(path, self.of)
            return self.folders[path]
        try:
            state = path.stat()
        except FileNotFoundError:
            return None
        stamp = [state.st_size, state.st_mtime_ns]
        kept = self.known.get(str(path))
        if kept and kept[:2] == stamp:
            return kept[2]
        value = files.sha256(path)
        if time.time_ns() - state.st_mtime_ns > SETTLED_NS:
            self.known[str(path)] = [*stamp, value]
            self.changed = True
        return value

    def confirm(self, path: StrPath) -> bool:
        """Return whether a file has the content that is known; if so, its date is known, too."""
        name, state = str(Path(path)), Path(path).stat()
        size, stamp_ns, sha256 = self.known[name]
        if state.st_size != size or files.sha256(path) != sha256:
            return False
        self.known[name] = [size, state.st_mtime_ns, sha256]
        self.until[name] = max(stamp_ns, self.until.get(name, 0))
        self.changed = True
        return True

    def doubt(self, paths: Iterable[StrPath]) -> None:
        """Forget files: results were made from other ones, or may have been."""
        self.doubtful.update(str(Path(path)) for path in paths)
        for name in self.doubtful & self.known.keys():
            del self.known[name]
            self.changed = True

    def use(self, path: StrPath, made_ns: int) -> None:
        """Keep the date of a file that was made from another one, if that is as it is known.

        Of one that was copied or exchanged since, only `of` reads the content again.
        """
        name = str(Path(path))
        if name not in self.known or made_ns <= self.until.get(name, 0) or not Path(path).is_file():
            return
        state = Path(path).stat()
        if self.known[name][:2] == [state.st_size, state.st_mtime_ns]:
            self.until[name] = made_ns
            self.changed = True

    def write(self) -> None:
        """Write what is known of files that still exist."""
        if not self.changed:
            return
        there = {name: kept for name, kept in sorted(self.known.items()) if Path(name).exists()}
        until = {name: self.until[name] for name in there if name in self.until}
        files.write_json(self.path, {"format": FORMAT, "files": there, "until": until})
        self.changed = False
