"""The error that a user can mend, and how a reader makes it of whatever a damaged file raises."""

import contextlib
import csv
import lzma
import struct
import tokenize
import zipfile
import zlib

LONGEST = 1000  # characters of a line
SHORT = 200  # of what a library says
# What Python's readers of text, JSON, TOML, CSV and archives, numpy and pandas raise on damaged files; and
# what looking for something in their content raises that is not there.
DAMAGED = (ValueError, OSError, EOFError, LookupError, TypeError, AttributeError, ArithmeticError)
DAMAGED += (RuntimeError, MemoryError, SyntaxError, tokenize.TokenError, csv.Error, struct.error)
DAMAGED += (zipfile.BadZipFile, zlib.error, lzma.LZMAError)
SPARE_MEMORY = "end other programs, or run fewer jobs at a time with --cores 1"


class InputError(ValueError):
    """Something the user gave is wrong; its message is one line, shown without a traceback.

    The message names the file, camera or take, what was expected, what was found, and what to do.

    Parameters
    ----------
    *lines : str
        One; several where several things are wrong at once. What does not print is written as in Python's
        texts, and the middle of an endless line is left out: parts of them come out of files.
    """

    def __init__(self, *lines):
        self.lines = [_one_line(line) for line in lines]
        super().__init__("\n".join(self.lines))


def _one_line(text):
    text = _shortened(str(text))  # first, for a file may have been put in whole
    if text.isprintable():
        return text
    return _shortened(
        "".join(
            letter if letter.isprintable() else letter.encode("unicode_escape").decode()
            for letter in text
        )
    )


def _shortened(text):
    if len(text) <= LONGEST:
        return text
    return f"{text[: LONGEST // 2]} ... {text[-LONGEST // 3 :]}"


def said(error):
    """Return what an error of a library says, or else its name, as one short line."""
    try:
        text = " ".join(str(error).split())
    except ValueError:  # of a number too long to be written
        text = ""
    return text[:SHORT] or type(error).__name__


@contextlib.contextmanager
def reading(path, what, advice="make it again", *, kinds=DAMAGED):
    """Turn whatever a damaged file raises within the block into one `InputError`.

    Parameters
    ----------
    path : str or Path
        The file; or file and place in it.
    what : str
        What was expected.
    advice : str
        What to do.
    kinds : tuple of type
        Exceptions that mean damage here; `InputError` itself always passes.

    Raises
    ------
    InputError
    """
    try:
        yield
    except InputError:
        raise
    except kinds as error:
        if isinstance(error, MemoryError):
            # The file asks for too much, or the machine has too little.
            advice = f"{advice}; or, if the file is whole, {SPARE_MEMORY}"
        raise InputError(f"{path}: expected {what}, found: {said(error)}; {advice}") from error
