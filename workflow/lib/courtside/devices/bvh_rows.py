"""The rows of a BVH file: text -> numbers, checked."""

import re

import numpy as np

from courtside.study.errors import InputError

LARGEST = 1e9  # of any number: sums and products of such stay finite
MAX_DIGITS = 40
MAX_PER_CHANNEL = 100  # characters of a row for each channel, blanks included
NUMBER = re.compile(r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
EXPORT_AGAIN = "export the file again"


def is_number(word, least=-LARGEST, most=LARGEST):
    """Say whether a word is a plain decimal number between two bounds.

    Parameters
    ----------
    word : str
    least, most : float
        The bounds, included.
    """
    return (
        len(word) <= MAX_DIGITS
        and NUMBER.fullmatch(word) is not None
        and least <= float(word) <= most
    )


def shown(word):
    """Return a word as an error shows it: short, on one line."""
    if not word:
        return "nothing"
    return repr(word if len(word) <= MAX_DIGITS else word[:MAX_DIGITS] + "...")


def read_rows(path, text, at, n_frames, n_channels):
    """Read the rows at the end of a BVH file.

    Parameters
    ----------
    path : str or Path
        For the errors.
    text : str
        The whole file.
    at : int
        Where in it the rows begin.
    n_frames, n_channels : int
        Rows and columns that there must be.

    Returns
    -------
    rows : (T, C) float

    Raises
    ------
    InputError
        If there are more or fewer rows, or a row is not so many finite numbers.
    """
    lines = text[at:].split("\n")
    filled = [line for line in lines if line and not line.isspace()]
    if len(filled) != n_frames:
        raise InputError(
            f"{path}: expected {n_frames} rows of motion as `Frames:` says, found {len(filled)}; "
            "the file may be cut off, or correct the count"
        )
    if not n_frames:
        return np.empty((0, n_channels))
    if not n_channels:
        raise InputError(f"{path}: expected a channel in some joint, found none; {EXPORT_AGAIN}")
    _check_width(path, lines, text.count("\n", 0, at) + 1, n_channels)
    try:
        rows = np.loadtxt(filled, comments=None, ndmin=2)
    except ValueError:
        rows = np.empty((0, 0))
    if rows.shape != (n_frames, n_channels) or not (np.abs(rows) <= LARGEST).all():
        raise _bad_row(path, lines, text.count("\n", 0, at) + 1, n_channels)
    return rows


def _check_width(path, lines, first, n_channels):
    """Refuse rows so wide that splitting them would already take long."""
    most = MAX_PER_CHANNEL * n_channels
    for number, line in enumerate(lines, start=first):
        if len(line) > most:
            raise InputError(
                f"{path}: line {number}: expected {n_channels} numbers, one for each channel, "
                f"found a line of {len(line)} characters; {EXPORT_AGAIN}"
            )


def _bad_row(path, lines, first, n_channels):
    """Return the error of the first row that is not `n_channels` numbers."""
    for number, line in enumerate(lines, start=first):
        words = line.split()
        if words and len(words) != n_channels:
            return InputError(
                f"{path}: line {number}: expected {n_channels} numbers, one for each channel, "
                f"found {len(words)}; {EXPORT_AGAIN}"
            )
        for word in words:
            if not is_number(word):
                return InputError(
                    f"{path}: line {number}: expected finite numbers of at most {LARGEST:g}, "
                    f"found {shown(word)}; {EXPORT_AGAIN}"
                )
    return InputError(
        f"{path}: expected rows of {n_channels} numbers, found others; {EXPORT_AGAIN}"
    )
