"""A digest of the code that a rule runs, so that an edited library module reruns its users.

Snakemake notices a changed script, but not a changed module that the script imports.
"""

import ast
import contextlib
import hashlib
import json
import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path

from courtside.study.errors import InputError, StrPath
from courtside.study.execution import files

PACKAGES = {"courtside", "virtualgym"}
# Fields that differ between Python versions, or say where a node stands, not what it does.
IGNORED = {"ctx", "kind", "type_comment", "type_ignores", "type_params"}
# Packages that are imported by another name than they are installed by.
INSTALLED_AS = {
    "backports": "backports-zstd",  # the one such package that is imported
    "cv2": "opencv-python-headless",
    "PIL": "pillow",
    "yaml": "pyyaml",
}


def _rule_digest(paths: Sequence[Path], lock_text: str) -> str:
    """Return the digest of all that a rule runs: `<code>-<packages>`, 64 hexadecimal digits each.

    Packages are those that the code imports itself, as the lock (`name==version` at the start of
    lines, perhaps with markers) pins them: a new version of one reruns what imports it, a new
    version of a tool that no rule imports reruns nothing.
    """
    packages = "\n".join(sorted(_packages(paths, lock_text)))
    return f"{_code_digest(paths)}-{hashlib.sha256(packages.encode()).hexdigest()}"


def _packages(paths: Sequence[Path], lock_text: str) -> set[str]:
    """Return the pins (`name==version` with marker) of the packages that files import."""
    imported = {name for path in paths for name in _parsed(path)[2]}
    wanted = {package_name(INSTALLED_AS.get(name, name)) for name in imported}
    known = pins(lock_text)
    return {pin for name in wanted & set(known) for pin in known[name]}


@cache
def pins(lock_text: str) -> dict[str, list[str]]:
    """Return {name: its pins} of a lock; several where platforms or interpreters differ."""
    found: dict[str, list[str]] = {}
    for line in re.findall(r"^[A-Za-z0-9][^\n\\]*==[^\n\\]*", lock_text, re.M):
        found.setdefault(package_name(re.split(r"\[|==", line)[0]), []).append(line.strip())
    return found


def package_name(name: str) -> str:
    """Return the name of a package as registries compare it: `My.Thing` is `my-thing`."""
    return re.sub(r"[-_.]+", "-", name).lower()


def code_digest(script: StrPath, library: StrPath) -> str:
    """Return the digest of a script and of every library module it reaches, 64 hexadecimal digits.

    It changes with the syntax trees, not with comments, docstrings or formatting. `library` is the
    folder that holds the packages of the library. A syntax error is an `InputError`.
    """
    found = _modules(script, library)
    return _code_digest([Path(script), *(found[name] for name in sorted(found))])


def _code_digest(paths: Sequence[Path]) -> str:
    return hashlib.sha256("\n".join(_parsed(path)[0] for path in paths).encode()).hexdigest()


def modules_of(script: StrPath, library: StrPath) -> set[str]:
    """Return the full names of all library modules and packages that a file reaches."""
    return set(_modules(script, library))


def _modules(script: StrPath, library: StrPath) -> dict[str, Path]:
    """Return {name: file} of all library modules and packages that a file reaches."""
    return _reached(Path(script), lambda path: _links(_parsed(path)[1], Path(library)))


class Remembered:
    """Digests that are kept in a file from run to run, as parsing takes longer than a small plan.

    Entries are found by the SHA-256 of file contents, so that none can be out of date. A missing
    or damaged JSON file `path` costs time only. Each file is read once in the life of an object.
    """

    def __init__(self, path: StrPath, lock_text: str) -> None:
        self._path, self._lock_text = Path(path), lock_text
        self._kept = _read(self._path)
        self._used: dict[str, str] = {}
        self._sha256 = cache(files.sha256)
        self._links = cache(lambda path, library: _links(self._imports(path), library))
        # Entries made by another version of this module, or with another lock, are not used.
        self._own = hashlib.sha256((files.sha256(__file__) + lock_text).encode()).hexdigest()

    def digest(self, script: StrPath, library: StrPath) -> str:
        """Return the digest of all that a script runs, kept where its code was met before."""
        script, library = Path(script), Path(library)
        found = _reached(script, lambda path: self._links(path, library))
        paths = [script, *(found[name] for name in sorted(found))]
        content = "\n".join([self._own, *map(self._sha256, paths)])
        key = hashlib.sha256(content.encode()).hexdigest()
        return self._get(key, lambda: _rule_digest(paths, self._lock_text))

    def save(self) -> None:
        """Write what this run used, if it is new and the file may be written."""
        if self._used != self._kept:
            with contextlib.suppress(OSError, InputError):
                files.write_json(self._path, self._used)
            self._kept = dict(self._used)

    def _imports(self, path: Path) -> list[str]:
        key = f"{self._own} {self._sha256(path)}"
        return self._get(key, lambda: " ".join(_parsed(path)[1])).split()

    def _get(self, key: str, find: Callable[[], str]) -> str:
        if key not in self._used:
            self._used[key] = self._kept[key] if key in self._kept else find()
        return self._used[key]


def _read(path: Path) -> dict[str, str]:
    """Return what was kept, nothing where that cannot be read."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    there = isinstance(content, dict) and all(isinstance(v, str) for v in content.values())
    return content if there else {}


def _reached(
    script: Path, links_of: Callable[[Path], Iterable[tuple[str, Path]]]
) -> dict[str, Path]:
    """Return {name: file} of all modules that a file reaches."""
    found: dict[str, Path] = {}
    waiting = [script]
    while waiting:
        new = {name: file for name, file in links_of(waiting.pop()) if name not in found}
        found |= new
        waiting += new.values()
    return found


def _links(imported: Iterable[str], library: Path) -> list[tuple[str, Path]]:
    """Return (name, file) of the modules that imports name, and of the packages that hold them."""
    parts = [name.split(".") for name in imported]
    names = {".".join(one[: at + 1]) for one in parts for at in range(len(one))}
    files = {name: _file(name, library) for name in names}
    return [(name, file) for name, file in files.items() if file is not None]


def _file(name: str, library: Path) -> Path | None:
    """Return the file of a module, None for a name that is not a module (a function, say)."""
    base = os.path.join(library, *name.split("."))  # noqa: PTH118  many times as fast as `Path`
    candidates = f"{base}.py", f"{base}{os.sep}__init__.py"
    return next((Path(one) for one in candidates if os.path.isfile(one)), None)  # noqa: PTH113


@cache
def _parsed(path: Path) -> tuple[str, tuple[str, ...], frozenset[str]]:
    """Return (tree as text, names imported from the library, other packages imported) of a file."""
    try:
        tree = ast.parse(path.read_text(encoding="utf-8"), filename=str(path))
    except SyntaxError as error:
        raise InputError(
            f"{path}: expected Python, found a syntax error in line {error.lineno}: {error.msg}"
        ) from None
    names = list(_imports(tree))
    inner = tuple(name for name in names if name.split(".")[0] in PACKAGES)
    return _text(tree), inner, frozenset(name.split(".")[0] for name in names) - PACKAGES


def _imports(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        yield from names


def _text(node: object) -> str:
    if isinstance(node, list):
        return "[" + ",".join(_text(item) for item in node) + "]"
    if not isinstance(node, ast.AST):
        return repr(node)
    fields = []
    for name, value in ast.iter_fields(node):
        if name == "body" and isinstance(value, list):
            value = [item for item in value if not _is_text(item)]
        if name not in IGNORED and value is not None and value != []:
            fields.append(f"{name}={_text(value)}")
    return f"{type(node).__name__}({','.join(fields)})"


def _is_text(node: ast.AST) -> bool:
    """Tell docstrings, and other statements that are only a string."""
    return isinstance(node, ast.Expr) and isinstance(getattr(node.value, "value", None), str)
