"""Readers that each do one thing that none may, and one that does none.

The watch must tell them apart.
"""

import ctypes
import os
import pickle
import subprocess
import sys
from pathlib import Path

from courtside.study.errors import InputError
from fuzz.format import Format

WHOLE = bytes(range(256)) * 4


def make(folder):
    """Write a file that all readers take."""
    (folder / "whole.bin").write_bytes(WHOLE)


def faulty(fault):
    """Return a reader with a fault that shows in changed files only."""

    def read(path):
        if path.read_bytes() != WHOLE:
            return fault(path)
        return path

    return read


def refuse(path):
    """Refuse as one should."""
    raise InputError(f"{path}: expected whole, found another; write it again")


def unnamed(_path):
    """Refuse without saying what."""
    raise InputError("expected whole, found another")


def lines(path):
    """Refuse in lines that do not print."""
    error = InputError(f"{path}: expected whole")
    error.lines = [f"{path}: expected\nwhole"]
    raise error


def other(_path):
    """Let an error of Python's through."""
    raise KeyError("whole")


def hang(_path):
    """Compute without end."""
    while True:
        pass


def wait(_path):
    """Wait for what never comes."""
    return os.read(os.pipe()[0], 1)


def fill(_path):
    """Take more memory than there may be."""
    return bytearray(2 << 30)


def crash(_path):
    """Crash the process."""
    ctypes.string_at(0)


def end(_path):
    """End the process."""
    os._exit(0)


def escape(_path):
    """Write beside the folder, and take it away again."""
    Path("../escaped.txt").write_text("x", encoding="utf-8")
    Path("../escaped.txt").unlink()


def hidden(_path):
    """Write beside the folder as a library of C does, without Python's knowledge."""
    library = ctypes.CDLL(None)
    library.fclose.argtypes = [ctypes.c_void_p]
    library.fopen.restype = ctypes.c_void_p
    library.fclose(library.fopen(b"../hidden.txt", b"w"))


def unpickle(_path):
    """Load what may be a program."""
    return pickle.loads(pickle.dumps(Path))


def start(_path):
    """Start another program."""
    return subprocess.run([sys.executable, "--version"], check=True)


GOOD = (refuse,)
BAD = (unnamed, lines, other, hang, wait, fill, crash, end, escape, hidden, unpickle, start)
FORMATS = {
    fault.__name__: Format(fault.__name__, 2, make, faulty(fault)) for fault in (*GOOD, *BAD)
}
