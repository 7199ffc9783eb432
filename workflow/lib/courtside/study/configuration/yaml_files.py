"""YAML files without YAML's surprises: no duplicate keys, names stay text."""

from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from typing import Any

import yaml

from courtside.study.errors import InputError, StrPath, reading

LARGEST_BYTES = 1 << 20  # the largest that is read within seconds
DEEPEST = 40  # levels
MOST = 200_000  # values, those of an alias counted each time
LARGEST = 10**4000  # Python refuses to write out longer numbers
LEVELS = "begin the keys of one level in the same column"
Content = dict[str, Any]  # of a YAML file, or of a part of it


class _StrictLoader(yaml.SafeLoader):
    """A safe loader that refuses a key given twice."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict:
        """Build a dictionary; raise where a key repeats or is not text."""
        seen = set()
        for key_node, _ in node.value:
            if key_node.tag == "tag:yaml.org,2002:merge":
                continue
            key = self.construct_object(key_node, deep=True)
            problem = ""
            if not isinstance(key, str):
                scalar = isinstance(key_node, yaml.ScalarNode)
                written = " ".join(key_node.value.split()) if scalar else repr(key)
                problem = f"expected a name, found {written or 'nothing'}; put it in quotes"
                if node.flow_style and type(key) in (int, float):  # `no` is a bool
                    problem += ", or, if it is the rest of a number such as 1,74, write 1.74"
            elif key[:1].isspace() and key[0] != " ":  # of Japanese input, or one that never breaks
                problem = f"found a wide space (U+{ord(key[0]):04X}); write plain spaces"
            elif key in seen:
                problem = f"expected each key once, found {key!r} again"
            if problem:
                line = f"line {key_node.start_mark.line + 1}"
                raise yaml.constructor.ConstructorError(problem=f"{line}: {problem}")
            seen.add(key)
        return super().construct_mapping(node, deep)


def read(path: StrPath) -> Content:
    """Read a YAML file that holds a mapping; an `InputError` names the line that is wrong."""
    with reading(path, "a readable YAML file", "save it as UTF-8", kinds=(OSError, UnicodeError)):
        text = Path(path).read_text(encoding="utf-8-sig")
    if len(text) > LARGEST_BYTES:
        raise InputError(f"{path}: expected YAML as people write it, found {len(text)} characters")
    # PyYAML lets Python's own errors through for 2026-02-30, or for !!int without a number.
    with reading(path, "dates and numbers that exist", "correct them"):
        try:
            content = yaml.load(text, Loader=_StrictLoader)  # a subclass of SafeLoader
        except yaml.YAMLError as error:
            mark = getattr(error, "problem_mark", None)
            where = f"{path}: line {mark.line + 1}" if mark else path
            problem = getattr(error, "problem", None) or str(error).splitlines()[0]
            raise InputError(f"{where}: {problem}{_advice(problem)}") from None
        except RecursionError:
            raise InputError(f"{path}: expected YAML, found too deep nesting") from None
    if not isinstance(content, dict):
        found = "nothing" if content is None else type(content).__name__
        raise InputError(
            f"{path}: expected keys and values, found {found}; write them as `key: value`, or give "
            "the right file"
        )
    _check_extent(path, content)
    return content


def check(paths: Iterable[StrPath]) -> None:
    """Raise an `InputError` with the faults of a study's files, which Snakemake has read by itself.

    Of a key that is there twice it takes the last value. Files of JSON are left to it, and pipes.
    """
    faults = []
    for path in (p for p in paths if Path(p).is_file() and Path(p).suffix != ".json"):
        try:
            read(path)
        except InputError as error:
            faults += error.lines
    if faults:
        raise InputError(*faults)


def file_of(key: str, content: Content, own: str, default: Path) -> str:
    """Return the file in which the value of a key such as `sweep.n_images` stands, for messages.

    Of a content that was merged from a `default` file and a user's `own`: the default one if it
    has the same value.
    """
    if default.is_file() and same(key, content, _of_default(default, default.stat().st_mtime_ns)):
        return str(default)
    return own


@lru_cache(maxsize=1)
def _of_default(path: Path, mtime_ns: int) -> Content:
    """Read the default file once for all faults of a configuration."""
    return read(path)


def same(key: str, one: Any, other: Any) -> bool:
    """Return whether two contents have the same value of a key.

    Where `one` does not have the key, the last level of it that `one` has is compared.
    """
    for part in key.split("."):
        if not (isinstance(one, dict) and part in one):
            break
        if not (isinstance(other, dict) and part in other):
            return False  # though the value may be null
        one, other = one[part], other[part]
    return one == other


def _advice(problem: str) -> str:
    """Return what to do about PyYAML's words for the commonest mistakes."""
    if "'\\t'" in problem:
        return "; write spaces in place of tabs, for YAML allows no tabs before keys"
    if problem.startswith("mapping values"):
        return f"; {LEVELS}, and put a text that holds a colon in quotes"
    if problem.startswith(("expected <block end>", "could not find expected ':'")):
        return f"; {LEVELS}, write `key: value`, and begin only the entries of a list with `-`"
    return ""


def _check_extent(path: StrPath, content: Content) -> None:
    """Refuse huge content, which aliases and hexadecimal numbers make of a few bytes."""
    waiting, count = [(content, 1)], 0
    while waiting:
        value, depth = waiting.pop()
        count += 1
        if depth > DEEPEST or count > MOST:
            found = "too deep nesting" if depth > DEEPEST else "aliases of aliases"
            raise InputError(f"{path}: expected YAML as people write it, found {found}")
        if isinstance(value, int) and abs(value) >= LARGEST:
            raise InputError(
                f"{path}: expected numbers that exist, found one of thousands of digits"
            )
        inner = value.values() if isinstance(value, dict) else value
        if isinstance(value, dict | list | tuple | set):
            waiting += [(part, depth + 1) for part in inner]
