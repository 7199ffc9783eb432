"""The numbers of a calibration file, whatever it holds, checked and brought to one form."""

import tomllib

import numpy as np

from courtside.geometry import rotations
from courtside.study.errors import InputError

LARGEST = 1e12  # beyond any length, pixel or coefficient of a lens
METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001}
UNSCALED = "unscaled"  # unit of cameras of a session without a court
EXPORT_AGAIN = "export the calibration again or mend the file"


def numbers(where, key, value, *shapes):
    """Return `value` as a finite float array of one of `shapes`.

    Parameters
    ----------
    where : str
        File and camera, to begin the message with.
    key : str
        What is read.
    value : object
        As the file holds it; None where it is missing.
    *shapes : tuple of int

    Returns
    -------
    array : ndarray of float

    Raises
    ------
    InputError
        If it is anything else.
    """
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        array = None
    if array is None or array.shape not in shapes or not (np.abs(array) <= LARGEST).all():
        expected = " or ".join("x".join(map(str, shape)) for shape in shapes)
        found = "nothing" if value is None else short(value)
        raise InputError(
            f"{where}: expected {key} as {expected or 'one'} finite number(s), found {found}; {EXPORT_AGAIN}"
        )
    return array


def five_coefficients(where, value):
    """Return distortion as k1 k2 p1 p2 k3 of any list that holds these, and zeros beyond."""
    if isinstance(value, np.ndarray):
        value = value.ravel()
    coefficients = numbers(where, "distortions", value, (4,), (5,), (8,), (12,), (14,))
    if np.any(coefficients[5:]):
        raise InputError(
            f"{where}: expected distortions k1 k2 p1 p2 k3, found {len(coefficients)} that are not zero "
            "beyond the fifth; calibrate with OpenCV's standard five-coefficient model"
        )
    return np.pad(coefficients[:5], (0, max(0, 5 - len(coefficients))))


def pose(where, rotation, translation, metres):
    """Return `cam_from_world` (3, 4).

    Parameters
    ----------
    where : str
        File and camera: begins messages.
    rotation : (3,) or (3, 3) array_like
        Rodrigues vector, radians, or matrix.
    translation : (3,) array_like
    metres : float
        Unit of the translation.

    Raises
    ------
    InputError
        If a shape is wrong or the matrix is no rotation.
    """
    rotation = numbers(where, "rotation", rotation, (3,), (3, 1), (1, 3), (3, 3))
    translation = numbers(where, "translation", translation, (3,), (3, 1), (1, 3))
    try:
        if rotation.shape == (3, 3):
            rotation = rotations.nearest_rotation(rotation)
        else:
            rotation = rotations.rotation_from_rodrigues(rotation.ravel())
    except ValueError as error:
        raise InputError(f"{where}: {error}; {EXPORT_AGAIN}") from error
    return np.column_stack([rotation, translation.ravel() * metres])


def unit_in_metres(where, unit):
    """Return the length of a unit that a file names: m, cm or mm."""
    if unit == UNSCALED:
        raise InputError(
            f"{where}: expected cameras in metres, found unscaled ones of a session without a "
            "court; give the "
            "session a court and click its points"
        )
    if not isinstance(unit, str) or unit not in METRES:
        raise InputError(
            f"{where}: expected unit as one of {', '.join(METRES)}, found {short(unit)}; correct it"
        )
    return METRES[unit]


def check_distinct(path, cameras):
    """Return `cameras`; raise `InputError` if there is none, or two have one name."""
    names = [camera.name for camera in cameras]
    if not names or len(set(names)) < len(names):
        raise InputError(
            f"{path}: expected cameras of different names, found {names}; {EXPORT_AGAIN}"
        )
    return cameras


def toml(text):
    """Return the tables of a TOML text; raise an error of `study.errors.DAMAGED` where it is none."""
    tables = tomllib.loads(text)
    str(tables)  # of numbers of thousands of digits, and brackets without end, nothing can be said
    return tables


def short(value):
    """Return a value as at most 80 characters of one line."""
    return " ".join(str(value).split())[:80]


def times(size):
    """Return a size in px as text, `1080x1920`."""
    return f"{size[0]}x{size[1]}"
