"""A court of known size: named points, the line edges that meet there, painted lines, net."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from courtside.study.configuration import schemas
from courtside.study.errors import InputError, StrPath

ON_EDGE_M = 1e-6  # for rounding only: files state millimetres
RAISED_M = 0.05  # ASSUME: floors are flat to this; points above it are on posts, nets or walls
# ASSUME: of points that no court file names, as of those in config/courts: standard deviations, m.
PLACED_M = {"floor": 0.005, "raised": 0.015}
# Clicked court points by camera name: (P, 2) px in the order of `Court.points`, NaN where not
# clicked.
ClickedPoints: TypeAlias = Mapping[str, NDArray]


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

    @property
    def on_floor(self) -> NDArray:
        """Which points lie on the floor, (P,) bool."""
        return ~is_raised(self.xyz)

    @property
    def placed(self) -> bool:
        """Whether its points have places of their own, and no edges of lines (`of_places`)."""
        return not any(self.edges)

    def other_end(self) -> NDArray:
        """Return the index of the point to which half a turn brings each one (P,); -1: none."""
        turned = np.array([*self.size_m, 0.0]) + self.xyz * [-1, -1, 1]
        apart_m = np.linalg.norm(turned[:, None] - self.xyz, axis=-1)
        return np.where(apart_m.min(axis=1) < ON_EDGE_M, apart_m.argmin(axis=1), -1)

    def turned(self, view: NDArray) -> NDArray:
        """Return views (P, 2) of points named as if the court were turned by half a turn."""
        other_end = self.other_end()
        return np.where((other_end >= 0)[:, None], view[other_end], np.nan)

    def indices(self, chosen: str | Sequence[str]) -> NDArray:
        """Return the indices in `points` of a set, by its name, or of some points, (n,) int."""
        names = self.sets[chosen] if isinstance(chosen, str) else chosen
        return np.array([self.points.index(name) for name in names], dtype=int)


def read(path: StrPath) -> Court:
    """Read a court file: YAML; `config/courts/badminton.yaml` shows every key.

    Raises `InputError` if the file is not as its schema says, a set names an unknown point, two
    points are at one place, a line leaves the court, or x is not the short side.
    """
    content = schemas.read(path, "court")
    points = tuple(content["points"])
    for name, members in content["sets"].items():
        if unknown := [member for member in members if member not in points]:
            raise InputError(
                f"{path}: sets.{name}: expected points of the court, found {unknown}; correct it"
            )
    xyz = np.array([point["xyz_m"] for point in content["points"].values()], dtype=float)
    sigma_m, net = content["sigma_m"], content["net"]
    court = Court(
        name=Path(path).stem,
        description=content["description"],
        size_m=np.array(content["size_m"], dtype=float),
        line_width_m=float(content["line_width_m"]),
        points=points,
        xyz=xyz,
        edges=tuple(point["edges"] for point in content["points"].values()),
        sigma_m=np.where(is_raised(xyz), sigma_m["raised"], sigma_m["floor"]).astype(float),
        sets={name: tuple(members) for name, members in content["sets"].items()} | {"all": points},
        lines_m=np.array(content["lines_m"], dtype=float).reshape(-1, 4),
        net=net and {key: np.array(value, dtype=float).tolist() for key, value in net.items()},
    )
    _check(path, court)
    return court


def is_raised(xyz: NDArray) -> NDArray:
    """Return which points (P, 3) m lie above the floor, (P,) bool."""
    return xyz[:, 2] > RAISED_M


def of_places(name: str, points: Sequence[str], xyz: NDArray) -> Court:
    """Return points at any places (P, 3) m as a court without lines; its size is their extent."""
    xyz = np.asarray(xyz, dtype=float)
    return Court(
        name=name,
        description=f"{len(points)} points at known places",
        size_m=np.ptp(xyz[:, :2], axis=0),
        line_width_m=0.0,
        points=tuple(points),
        xyz=xyz,
        edges=("",) * len(points),
        sigma_m=np.where(is_raised(xyz), PLACED_M["raised"], PLACED_M["floor"]),
        sets={"all": tuple(points)},
        lines_m=np.zeros((0, 4)),
        net=None,
    )


def _check(path: StrPath, court: Court) -> None:
    if court.size_m[0] > court.size_m[1]:
        raise InputError(
            f"{path}: expected size_m as [short side, long side], found {court.size_m.tolist()}; "
            "exchange them"
        )
    apart_m = np.linalg.norm(court.xyz[:, None] - court.xyz, axis=-1)
    first, second = np.unravel_index(np.argmin(apart_m + 1e9 * np.eye(len(apart_m))), apart_m.shape)
    if apart_m[first, second] < ON_EDGE_M:
        raise InputError(
            f"{path}: expected points at different places, found "
            f"{court.points[first]} and {court.points[second]} {apart_m[first, second]:g} m apart; "
            "correct them"
        )
    low, high = court.line_corners()
    beyond = ((low < -ON_EDGE_M) | (high > court.size_m + ON_EDGE_M)).any(axis=1)
    if beyond.any():
        x, y = court.size_m
        found = [f"line {at + 1} {court.lines_m[at].tolist()}" for at in np.flatnonzero(beyond)]
        more = f" and {len(found) - 1} more" if len(found) > 1 else ""
        raise InputError(
            f"{path}: lines_m: expected lines inside the court, from its corner at 0, 0 to {x:g}, "
            f"{y:g} (size_m), found {found[0]}{more} beyond it; correct the line or size_m"
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
        on = inside.all(axis=1) & court.on_floor
        middle = (low[line, axis] + high[line, axis]) / 2
        shift[on, axis] = middle - court.xyz[on, axis]
    return shift
