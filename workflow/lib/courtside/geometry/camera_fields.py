"""Fields of calibration files, checked and converted to this study's form."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import rotations
from courtside.study.errors import InputError, StrPath

if TYPE_CHECKING:
    from courtside.geometry.camera import Camera

    Cameras = TypeVar("Cameras", bound=Sequence[Camera])

LARGEST = 1e12  # beyond any length, pixel or lens coefficient
METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
UNSCALED = "unscaled"  # unit of cameras of a session without a court
EXPORT_AGAIN = "export the calibration again or mend the file"


def numbers(where: StrPath, key: str, value: object, *shapes: tuple[int, ...]) -> NDArray:
    """Return a field's `value`, None where missing, as a finite float array of one of `shapes`.

    Raises `InputError` if it is anything else; the message begins with `where` (file and camera)
    and names the `key`.
    """
    array: NDArray | None
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        array = None
    if array is None or array.shape not in shapes or not (np.abs(array) <= LARGEST).all():
        expected = " or ".join("x".join(map(str, shape)) for shape in shapes)
        found = "nothing" if value is None else short(value)
        raise InputError(
            f"{where}: expected {key} as {expected or 'one'} finite number(s), found {found}; "
            f"{EXPORT_AGAIN}"
        )
    return array


def distortions(where: str, value: object, *, fisheye: bool) -> NDArray:
    """Return distortion as k1 k2 p1 p2 k3 (5,), missing ones 0; as it is if further ones are not 0.

    Of a fisheye lens it is k1 k2 k3 k4 (4,).
    """
    if isinstance(value, np.ndarray):
        value = value.ravel()
    if fisheye:
        of_fisheye = numbers(where, "distortions (fisheye = true)", value, (4,), (5,))
        if np.any(of_fisheye[4:]):
            raise InputError(
                f"{where}: expected distortions k1 k2 k3 k4 of a fisheye lens (fisheye = true), "
                f"found a fifth one; {EXPORT_AGAIN}"
            )
        return of_fisheye[:4]
    coefficients = numbers(where, "distortions", value, (4,), (5,), (8,), (12,), (14,))
    if np.any(coefficients[5:]):
        return coefficients
    return np.pad(coefficients[:5], (0, max(0, 5 - len(coefficients))))


def pose(where: str, rotation: object, translation: object, metres: float) -> NDArray:
    """Return `cam_from_world` (3, 4); `metres` is the unit of the translation (3,).

    The rotation is a Rodrigues vector (3,), radians, or a matrix (3, 3). Raises `InputError` if a
    shape is wrong, the matrix is not a rotation or the vector turns more than once; `where` (file
    and camera) begins messages.
    """
    rotation = numbers(where, "rotation", rotation, (3,), (3, 1), (1, 3), (3, 3))
    translation = numbers(where, "translation", translation, (3,), (3, 1), (1, 3))
    if rotation.shape != (3, 3):
        _check_radians(where, float(np.linalg.norm(rotation)))
    try:
        if rotation.shape == (3, 3):
            rotation = rotations.nearest_rotation(rotation)
        else:
            rotation = rotations.rotation_from_rodrigues(rotation.ravel())
    except ValueError as error:
        raise InputError(f"{where}: {error}; {EXPORT_AGAIN}") from error
    return np.column_stack([rotation, translation.ravel() * metres])


def _check_radians(where: str, angle: float) -> None:
    if angle > 2 * np.pi:
        raise InputError(
            f"{where}: expected rotation as a vector in radians, of a length up to 2 pi, found "
            f"{angle:.4g}, as in degrees; multiply it by pi / 180"
        )


def unit_in_metres(where: StrPath, unit: object) -> float:
    """Return the length in metres of a unit that a file or session names: one of `METRES`."""
    if unit == UNSCALED:
        raise InputError(
            f"{where}: expected cameras in metres, found unscaled ones of a session without a "
            "court; give the session a court and click its points"
        )
    if not isinstance(unit, str) or unit not in METRES:
        raise InputError(
            f"{where}: expected unit as one of {', '.join(METRES)}, found {short(unit)}; correct it"
        )
    return METRES[unit]


def check_distinct(path: StrPath, cameras: Cameras) -> Cameras:
    """Return `cameras`; raise `InputError` if there are none or two have the same name."""
    names = [camera.name for camera in cameras]
    if not names:
        raise InputError(f"{path}: expected cameras, found none; {EXPORT_AGAIN}")
    if len(set(names)) < len(names):
        raise InputError(
            f"{path}: expected cameras of different names, found {names}; {EXPORT_AGAIN}"
        )
    return cameras


def toml(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text; raise an error of `study.errors.DAMAGED` if it is none."""
    tables = tomllib.loads(text)
    str(tables)  # raises for numbers of thousands of digits and for endless nesting
    return tables


def short(value: object) -> str:
    """Return a value as one line of at most 80 characters."""
    return " ".join(str(value).split())[:80]


def times(size: Sequence[int] | NDArray) -> str:
    """Return a size in px as text, `1080x1920`."""
    return f"{size[0]}x{size[1]}"
