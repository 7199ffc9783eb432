"""`InputError`, for faults that a user can correct, and how readers of files raise it on damage."""

import contextlib
import csv
import difflib
import lzma
import os
import struct
import sysconfig
import tarfile
import tokenize
import zipfile
import zlib
from collections.abc import Iterator, Sequence
from typing import TypeAlias, TypeVar

StrPath: TypeAlias = str | os.PathLike  # of a file or folder
LONGEST = 1000  # characters of a line
SHORT = 200  # of what a library says
# What readers of text, JSON, TOML, CSV and archives, numpy and pandas raise on damaged files
# (tests/fuzz), and what a missing key or entry of the content raises.
RAISED_BY_READERS: tuple[type[Exception], ...] = (
    *(ValueError, OSError, EOFError, LookupError, ArithmeticError, RuntimeError, MemoryError),
    *(SyntaxError, tokenize.TokenError, csv.Error, struct.error),
    *(zipfile.BadZipFile, tarfile.TarError, zlib.error, lzma.LZMAError),
)
# Damage if code of a library raises them (PyYAML for `!!timestamp x`), else faults of our own code:
# `require_type` checks the types of content that we take apart.
AMBIGUOUS = (TypeError, AttributeError)
LIBRARIES = tuple(sysconfig.get_path(key) for key in ("stdlib", "platstdlib", "purelib", "platlib"))
# For blocks that take parsed content apart without checking its types.
DAMAGED: tuple[type[Exception], ...] = (*RAISED_BY_READERS, *AMBIGUOUS)
Kind = TypeVar("Kind")
SPARE_MEMORY = "end other programs, or run fewer jobs at a time with --cores 1"


class InputError(ValueError):
    """Something the user gave is wrong; its message is one line, shown without a traceback.

    The message names the file, camera or take, what was expected, what was found, and what to do;
    it has several lines if several things are wrong at once. Unprintable characters are escaped,
    and the middle of an endless line is left out: parts of the lines come out of files.
    """

    def __init__(self, *lines: object) -> None:
        self.lines = [_one_line(line) for line in lines]
        super().__init__("\n".join(self.lines))


def _one_line(text: object) -> str:
    short = _shortened(str(text))  # first: it may hold a whole file
    escaped = (c if c.isprintable() else c.encode("unicode_escape").decode() for c in short)
    return _shortened("".join(escaped))


def _shortened(text: str) -> str:
    if len(text) <= LONGEST:
        return text
    return f"{text[: LONGEST // 2]} ... {text[-LONGEST // 3 :]}"


def few(names: Sequence[str], n_named: int) -> str:
    """Return at most so many names in words; the others are counted."""
    more = f" and {len(names) - n_named} more" if len(names) > n_named else ""
    return ", ".join(names[:n_named]) + more


def nearest(name: str, known: Sequence[str], otherwise: str) -> str:
    """Return the advice for a name that is not known: the nearest one, else `otherwise`."""
    close = difflib.get_close_matches(name, known, n=1)
    return f"did you mean {close[0]!r}?" if close else otherwise


def message(error: BaseException) -> str:
    """Return the message of a library's error, or else the error's name, as one short line."""
    if isinstance(error, KeyError) and error.args and " " not in str(error.args[0]):
        return f"no {error}"[:SHORT]  # the key alone, in quotes
    if isinstance(error, IndexError):
        return "fewer entries"
    try:
        text = " ".join(str(getattr(error, "strerror", None) or error).split())
    except ValueError:  # of a number too long to be written
        text = ""
    return text[:SHORT] or type(error).__name__


@contextlib.contextmanager
def reading(
    path: StrPath,
    what: str,
    advice: str = "make it again",
    *,
    kinds: tuple[type[Exception], ...] = RAISED_BY_READERS,
) -> Iterator[None]:
    """Turn the exceptions that a damaged file causes within the block into one `InputError`.

    `path` is the file, or file and place in it; `what` was expected; `advice` says what to do.
    `kinds` are the exceptions that mean damage here; by default what readers raise, and a TypeError
    or AttributeError out of a library's code. All others pass, and so does `InputError` itself.
    """
    caught: tuple[type[Exception], ...] = (*kinds, *AMBIGUOUS)
    try:
        yield
    except InputError:
        raise
    except caught as error:
        libraries = kinds is RAISED_BY_READERS and _raised_by_library(error)
        if not (isinstance(error, kinds) or libraries):
            raise
        if isinstance(error, MemoryError):
            # The file asks for too much, or the machine has too little.
            advice = f"{advice}; or, if the file is whole, {SPARE_MEMORY}"
        found = message(error)
        if isinstance(error, OSError) and error.filename and str(error.filename) != str(path):
            found = f"{found}: {error.filename}"  # a file of the folder that was read
        raise InputError(f"{path}: expected {what}, found: {found}; {advice}") from error


@contextlib.contextmanager
def about(what: StrPath) -> Iterator[None]:
    """Begin the lines of an `InputError` within the block with the file or key they are about."""
    try:
        yield
    except InputError as error:
        raise InputError(*(f"{what}: {line}" for line in error.lines)) from None


def _raised_by_library(error: BaseException) -> bool:
    """Return whether Python code of a library raised an exception, not ours."""
    innermost = error.__traceback__
    while innermost is not None and innermost.tb_next is not None:
        innermost = innermost.tb_next
    return innermost is not None and innermost.tb_frame.f_code.co_filename.startswith(LIBRARIES)


def require_type(value: object, kind: type[Kind]) -> Kind:
    """Return a part of a file's parsed content; raise `ValueError` if it is of another type."""
    if not isinstance(value, kind):
        raise ValueError(f"{type(value).__name__} in place of {kind.__name__}")
    return value


def require_scalar(value: object) -> float | str:
    """Return a number of a file's parsed content, or a text that may be one, as `require_type`."""
    if not isinstance(value, int | float | str):
        raise ValueError(f"{type(value).__name__} in place of a number")
    return value
