"""The clicked points of a session, and a check of their positions camera by camera.

All points of a camera may be wrong by one shift. The picture of this camera cannot show this,
because shifted points only shift the camera. Points of other cameras at the same places show it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court import court as court_files
from courtside.calibration.court.court import ClickedPoints, Court
from courtside.records.cameras import clicks, placed_points
from courtside.records.cameras.placed_points import PlacedPoints
from courtside.study.errors import InputError, StrPath

NEAR_M = 0.1  # ASSUME: places meant to be one differ by less, rounding of one of them included
MOVED = 0.8  # ASSUME: of a camera's points: so many must meet others once they are moved
LEFT = 1 / 3  # ASSUME: and no more than so many as they are
FEWEST = 4  # ASSUME: points that meet others after one shift; fewer may do so by chance


@dataclass(frozen=True, eq=False)
class Shift:
    """What must be added to all places of one camera's points."""

    camera: str
    by_m: NDArray  # (3,)
    n_points: int
    n_met: int  # of them, once moved
    n_before: int  # of them, as they are

    def __str__(self) -> str:
        small = [
            f"{key} is {abs(by):.2f} m too {'small' if by > 0 else 'large'}"
            for key, by in zip(("x_m", "y_m", "z_m"), self.by_m, strict=True)
            if abs(by) >= NEAR_M / 2
        ]
        return (
            f"camera {self.camera}: expected its {self.n_points} points at places that points of "
            f"other cameras have, found {self.n_before} there, and {self.n_met} once all are "
            f"moved by one shift: of this camera's points {', '.join(small)}; correct them"
        )


def shifts(placed: PlacedPoints) -> list[Shift]:
    """Return the shifts of cameras whose points meet those of other cameras only after one.

    Only shifts of less than half the usual distance between neighbouring points are found: a longer
    one may lead from one line of a court to the next. Of two cameras alone, both are found.
    """
    found = []
    for camera in placed.clicks:
        others = [name for name in placed.clicks if name != camera]
        seen = [placed.of(name) for name in others]
        there = np.unique(np.concatenate(seen)) if seen else np.zeros(0, dtype=int)
        own = placed.xyz[placed.of(camera)]
        if len(own) >= FEWEST and len(there) >= FEWEST:
            shift = _shift(camera, own, placed.xyz[there])
            found += [shift] if shift else []
    return found


def _shift(camera: str, own: NDArray, others: NDArray) -> Shift | None:
    before = _met(own, others).sum()
    if before > LEFT * len(own):
        return None
    steps = (others[:, None] - own).reshape(-1, 3)
    steps = steps[np.linalg.norm(steps, axis=1) < _spacing(others) / 2]
    counts = [_met(own + step, others).sum() for step in steps]
    if not counts or max(counts) < max(FEWEST, MOVED * len(own)):
        return None
    step = steps[int(np.argmax(counts))]
    met = _met(own + step, others)
    apart = np.linalg.norm(others[:, None] - (own + step)[met], axis=-1)
    by_m = np.median(others[apart.argmin(axis=0)] - own[met], axis=0)
    return Shift(camera, by_m, len(own), int(met.sum()), int(before))


def _met(own: NDArray, others: NDArray) -> NDArray:
    """Say which of some places (N, 3) have another one near, (N,) bool."""
    return np.linalg.norm(own[:, None] - others, axis=-1).min(axis=1) < NEAR_M


def _spacing(xyz: NDArray) -> float:
    """Return the median distance of places (N, 3) to the nearest that is not the same, m."""
    apart = np.linalg.norm(xyz[:, None] - xyz, axis=-1)
    return float(np.median(np.where(apart < NEAR_M, np.inf, apart).min(axis=1)))


def read(
    clicks_csv: StrPath, court_yaml: StrPath, cameras: Sequence[str], placed: bool
) -> tuple[Court, ClickedPoints]:
    """Return the court and the clicks of a session; `placed` points are returned as a court.

    Raises `InputError` if a file is invalid, or if all points of a camera are shifted.
    """
    if not placed:
        court = court_files.read(court_yaml)
        return court, clicks.read(clicks_csv, cameras, list(court.points))
    points = placed_points.read(clicks_csv, cameras)
    if wrong := shifts(points):
        raise InputError(*(f"{clicks_csv}: {one}" for one in wrong))
    return court_files.of_places("points", points.points, points.xyz), points.clicks
