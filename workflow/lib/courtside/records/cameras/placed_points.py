"""Points at known places, seen by fixed cameras: one CSV row for each point and camera."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.records.user_tables import number, table
from courtside.study.errors import InputError, StrPath

PLACE, PIXEL = ("x_m", "y_m", "z_m"), ("x_px", "y_px")
COLUMNS = ("camera", *PIXEL, *PLACE)
NAMED = "point"  # a further column, for points with names of their own
SAME_M = 1e-3  # rounding: points nearer than this are one point


@dataclass(frozen=True, eq=False)
class PlacedPoints:
    """Points at known places, and where cameras see them."""

    points: tuple[str, ...]  # P names; a point without one is named by its place
    xyz: NDArray  # (P, 3): m, z up
    clicks: dict[str, NDArray]  # (P, 2) px by camera; NaN where not clicked
    left_out: tuple[str, ...] = ()  # cameras of the file that were not asked for

    def of(self, camera: str) -> NDArray:
        """Return the indices of the points that a camera sees, (n,) int."""
        return np.flatnonzero(np.isfinite(self.clicks[camera]).all(axis=1))


def read(path: StrPath, cameras: Sequence[str]) -> PlacedPoints:
    """Read points at known places.

    The CSV has the columns camera, x_px, y_px (px of the video's size, first pixel's centre at
    (0, 0)), x_m, y_m, z_m (right-handed, z up) and perhaps point, a name. Rows with one place, to a
    millimetre, are one point. Rows of other cameras than `cameras` are left out. An `InputError` if
    the file is no such table, a number is none, one camera has a point twice, or a name has two
    places.
    """
    names: list[str] = []
    places: list[list[float]] = []
    left_out: dict[str, None] = {}
    seen: dict[tuple[str, str], tuple[int, list[float]]] = {}
    for line, row in table(path, COLUMNS, (NAMED,)):
        where, camera = f"{path}: line {line}", row["camera"]
        if camera not in cameras:
            left_out[camera] = None
            continue
        place = [number(where, key, row[key]) for key in PLACE]
        name = row.get(NAMED) or _name(place)
        if name not in names:
            names.append(name)
            places.append(place)
        there = places[names.index(name)]
        if np.abs(np.subtract(there, place)).max() > SAME_M:
            raise InputError(
                f"{where}: expected point {name} at {_name(there)} m, as before, found it at "
                f"{_name(place)} m; correct its place or its name"
            )
        if (camera, name) in seen:
            raise InputError(
                f"{where}: expected one click for point {name} in camera {camera}, found another "
                f"in line {seen[camera, name][0]}; delete one"
            )
        seen[camera, name] = line, [number(where, key, row[key]) for key in PIXEL]
    found = {camera: np.full((len(names), 2), np.nan) for camera in cameras}
    for (camera, name), (_, xy) in seen.items():
        found[camera][names.index(name)] = xy
    xyz = np.array(places).reshape(-1, 3)
    return PlacedPoints(tuple(names), xyz, found, tuple(left_out))


def _name(place: Sequence[float]) -> str:
    # 12 digits keep the millimetres of survey coordinates; adding 0 makes -0 to 0.
    return "(" + ", ".join(f"{round(value, 3) + 0.0:.12g}" for value in place) + ")"
