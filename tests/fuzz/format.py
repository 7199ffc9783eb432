"""What a format is: how its first files are made, how they are read, how many cases it gets."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Format:
    """An input format of the study.

    Attributes
    ----------
    name : str
    cases : int
        Changed files that are read.
    make : callable
        Writes the files, or folders, to start from into an empty folder; all of them can be read.
    read : callable
        Reads a file or folder as the study does, holds the value against what it must be, and
        returns it.
    only : str
        Pattern of the names, within a folder, of the files that are changed.
    refuses : bool
        Whether it refuses damage; one that does not says in its value what is wrong.
    """

    name: str
    cases: int
    make: Callable
    read: Callable
    only: str = "*"
    refuses: bool = True

    def changeable(self, folder):
        """Return the files of a folder that may be changed, in the order of their names."""
        return sorted(path for path in folder.rglob(self.only) if path.is_file())


def require(fact, what):
    """Raise where a value is not what every reader promises."""
    if not fact:
        raise AssertionError(what)
