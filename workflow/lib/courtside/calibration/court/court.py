"""A court of known size: named points, the line edges that meet there, painted lines, net."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera_fields
from courtside.study.configuration import yaml_files
from courtside.study.errors import InputError, StrPath

NAME = re.compile(r"[a-z0-9][a-z0-9_-]*")
KEYS = {
    "description", "size_m", "line_width_m", "sigma_m", "points", "sets", "lines_m", "net",
}  # fmt: skip
NET_KEYS: dict[str, tuple[int, ...]] = {
    "y_m": (), "x_m": (2,), "post_height_m": (), "mid_height_m": ()
}  # fmt: skip
ON_EDGE_M = 1e-6  # for rounding only: files state millimetres
# Clicked court points by camera name: (P, 2) px in the order of `Court.points`, NaN where not
# clicked.
ClickedPoints: TypeAlias = Mapping[str, NDArray]
SEE = "see config/courts/badminton.yaml"


@dataclass(frozen=True, eq=False)
class Court:
    """A court: origin in its outer corner, x along its short side, y along its long side, z up."""

    name: str  # as in the file name
    description: str
    size_m: NDArray  # (2,): along x and y, to the outer edges of the lines
    line_width_m: float
    points: tuple[str, ...]
    xyz: NDArray  # (P, 3): m
    edges: tuple[str, ...]  # P: which edges meet at the point, in words
    sigma_m: NDArray  # (P,): how far a real court is from `xyz`, standard deviation per axis
    sets: dict[str, tuple[str, ...]]  # named subsets of `points`; "all" is always there
    lines_m: NDArray  # (L, 4): painted rectangles: x0 y0 x1 y1
    net: dict | None  # `y_m`, `x_m` [left, right], `post_height_m`, `mid_height_m`

    def line_corners(self) -> tuple[NDArray, NDArray]:
        """Return the low and the high corner of each painted rectangle, (L, 2) m each."""
        ends = self.lines_m[:, :2], self.lines_m[:, 2:]
        return np.minimum(*ends), np.maximum(*ends)

    def indices(self, chosen: str | Sequence[str]) -> NDArray:
        """Return the indices in `points` of a set, by its name, or of some points, (n,) int."""
        names = self.sets[chosen] if isinstance(chosen, str) else chosen
        return np.array([self.points.index(name) for name in names], dtype=int)


def read(path: StrPath) -> Court:
    """Read a court file: YAML; `config/courts/badminton.yaml` shows every key.

    Raises `InputError` if a key is missing or unknown, a value is not a number, a set names an
    unknown point, two points are at one place, a line leaves the court, or x is not the short side.
    """
    content = yaml_files.read(path)
    odd = KEYS.symmetric_difference(content)
    if odd:
        raise InputError(
            f"{path}: expected the keys {', '.join(sorted(KEYS))}, found "
            f"{', '.join(sorted(content))}; {SEE}"
        )
    sigma = content["sigma_m"] if isinstance(content["sigma_m"], dict) else {}
    floor_m, raised_m = (
        camera_fields.numbers(path, f"sigma_m {kind}", sigma.get(kind), ())
        for kind in ("floor", "raised")
    )
    points, xyz, edges = _points(path, content["points"])
    lines = content["lines_m"] if isinstance(content["lines_m"], list) else None
    court = Court(
        name=Path(path).stem,
        description=str(content["description"]),
        size_m=camera_fields.numbers(path, "size_m", content["size_m"], (2,)),
        line_width_m=float(
            camera_fields.numbers(path, "line_width_m", content["line_width_m"], ())
        ),
        points=points,
        xyz=xyz,
        edges=edges,
        sigma_m=np.where(xyz[:, 2] > 0, raised_m, floor_m),
        sets={**_sets(path, content["sets"], points), "all": points},
        lines_m=camera_fields.numbers(path, "lines_m", lines, (len(lines or "-"), 4)),
        net=_net(path, content["net"]),
    )
    _check(path, court)
    return court


def _points(path, table) -> tuple[tuple[str, ...], NDArray, tuple[str, ...]]:
    if not isinstance(table, dict) or not table:
        raise InputError(f"{path}: expected points with xyz_m and edges, found none; {SEE}")
    for name, point in table.items():
        complete = isinstance(point, dict) and set(point) == {"xyz_m", "edges"}
        if not NAME.fullmatch(name) or not complete:
            raise InputError(
                f"{path}: points: expected names of a-z, 0-9, _ and -, each with xyz_m and edges, "
                f"found {name}: {camera_fields.short(point)}; {SEE}"
            )
    xyz = [
        camera_fields.numbers(f"{path}: {n}", "xyz_m", p["xyz_m"], (3,)) for n, p in table.items()
    ]
    return tuple(table), np.array(xyz), tuple(str(point["edges"]) for point in table.values())


def _sets(path, table, points) -> dict[str, tuple[str, ...]]:
    if not isinstance(table, dict):
        raise InputError(
            f"{path}: expected sets of points, found {camera_fields.short(table)}; {SEE}"
        )
    for name, members in table.items():
        unknown = (
            [m for m in members if m not in points] if isinstance(members, list) else [members]
        )
        if unknown or len(set(members)) < len(members):
            raise InputError(
                f"{path}: sets: {name}: expected a list of different points, found "
                f"{camera_fields.short(unknown or members)}; correct it"
            )
    return {name: tuple(members) for name, members in table.items()}


def _net(path: StrPath, table: dict | None) -> dict | None:
    if table is None:
        return None
    if not isinstance(table, dict) or set(table) != set(NET_KEYS):
        raise InputError(
            f"{path}: net: expected null or {', '.join(NET_KEYS)}, found "
            f"{camera_fields.short(table)}; {SEE}"
        )
    numbers = {
        key: camera_fields.numbers(f"{path}: net", key, table[key], s)
        for key, s in NET_KEYS.items()
    }
    return {key: value.tolist() for key, value in numbers.items()}


def _check(path: StrPath, court: Court) -> None:
    if not 0 < court.size_m[0] <= court.size_m[1]:
        raise InputError(
            f"{path}: expected size_m as [short side, long side], found {court.size_m.tolist()}; "
            "exchange them"
        )
    apart_m = np.linalg.norm(court.xyz[:, None] - court.xyz, axis=-1)
    first, second = np.unravel_index(np.argmin(apart_m + 1e9 * np.eye(len(apart_m))), apart_m.shape)
    if len(court.points) < 3 or apart_m[first, second] < ON_EDGE_M:
        raise InputError(
            f"{path}: expected three points or more at different places, found "
            f"{court.points[first]} and {court.points[second]} {apart_m[first, second]:g} m apart; "
            "correct them"
        )
    if min(court.line_width_m, court.sigma_m.min()) <= 0:
        raise InputError(
            f"{path}: expected line_width_m and sigma_m above 0, found 0 or less; correct it"
        )
    corners = court.lines_m.reshape(-1, 2)
    if (corners < -ON_EDGE_M).any() or (corners > court.size_m + ON_EDGE_M).any():
        raise InputError(
            f"{path}: expected lines_m inside the court of {camera_fields.times(court.size_m)} m, "
            "found a line beyond it; correct it"
        )


def to_line_centres(court: Court) -> NDArray:
    """Return how far each named point would move if line centres were taken for edges, (P, 3) m.

    Zero for raised points, and along lines whose middle is meant.
    """
    low, high = court.line_corners()
    across = np.argmin(high - low, axis=1)  # the axis that the line's width is measured along
    shift, places = np.zeros_like(court.xyz), court.xyz[:, :2]
    for line in range(len(low)):
        axis = across[line]
        inside = (places >= low[line] - ON_EDGE_M) & (places <= high[line] + ON_EDGE_M)
        on = inside.all(axis=1) & (court.xyz[:, 2] == 0)
        middle = (low[line, axis] + high[line, axis]) / 2
        shift[on, axis] = middle - court.xyz[on, axis]
    return shift
