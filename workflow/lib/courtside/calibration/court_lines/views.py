"""Many cameras at once, and points along the lines of a court."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court import line_edges
from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera

NEAREST_M = 0.3  # ASSUME: nothing nearer is seen
FIT_STEPS = 100  # radii at which two lens models are made alike
ALIKE_M = 0.001  # rounding: lines nearer than this, after half a turn of the court, are one


@dataclass(frozen=True, eq=False)
class Views:
    """Cameras (B) with square pixels, one principal point and the division model of lenses.

    A point at the distance r from the axis is seen at q, where r = q / (1 + division q^2)
    (Fitzgibbon 2001). For small distortion that is k1 alone; it also holds for wide lenses.
    """

    rotation: NDArray  # (B, 3, 3): from the world
    centre: NDArray  # (B, 3): in the world, m
    f_px: NDArray  # (B,)
    division: NDArray  # (B,): on the z = 1 plane; negative: barrel
    principal: NDArray  # (2,): px

    def __getitem__(self, which: NDArray | slice | list[int]) -> "Views":
        """Return some of the cameras."""
        return Views(
            self.rotation[which], self.centre[which], self.f_px[which], self.division[which],
            self.principal,
        )  # fmt: skip

    def __len__(self) -> int:
        """Return how many cameras there are."""
        return len(self.f_px)

    def project(self, floor: NDArray) -> NDArray:
        """Return px (B, N, 2) of points of the floor (N, 2) m; NaN where they are not seen."""
        away = floor - self.centre[:, None, :2]
        in_cam = np.einsum("bij,bnj->bni", self.rotation[:, :, :2], away)
        in_cam -= (self.rotation[:, :, 2] * self.centre[:, 2:])[:, None]
        depth = np.where(in_cam[..., 2:] > NEAREST_M, in_cam[..., 2:], np.nan)
        place = in_cam[..., :2] / depth
        bent = 4 * self.division[:, None, None] * np.sum(place**2, axis=-1, keepdims=True)
        with np.errstate(invalid="ignore"):
            place *= 2 / (1 + np.sqrt(1 - bent))
        return place * self.f_px[:, None, None] + self.principal


def join(views: list[Views]) -> Views:
    """Return all cameras of several `Views` of one picture."""
    rows = ("rotation", "centre", "f_px", "division")
    rotation, centre, f_px, division = (
        np.concatenate([getattr(one, row) for one in views]) for row in rows
    )
    return Views(rotation, centre, f_px, division, views[0].principal)


def to_camera(
    view: Views, name: str, size: tuple[int, int], scale: float, within_px: float
) -> Camera:
    """Return the only camera of `Views` for a picture of a size, `scale` times larger.

    Its k1 to k3 are fitted to the division model, at most `within_px` (of the picture of `Views`)
    from the principal point.
    """
    matrix = np.diag([view.f_px[0] * scale, view.f_px[0] * scale, 1.0])
    matrix[:2, 2] = (view.principal + 0.5) * scale - 0.5
    rotation = view.rotation[0]
    pose = np.column_stack([rotation, -rotation @ view.centre[0]])
    k1, k2, k3 = _polynomial(float(view.division[0]), within_px / float(view.f_px[0]))
    return Camera(name, size, matrix, np.array([k1, k2, 0, 0, k3]), pose)


def _polynomial(division: float, reach: float) -> NDArray:
    """Return k1, k2, k3 (3,) nearest to the division model, up to where it shows points."""
    seen = np.linspace(0, reach, FIT_STEPS)
    away = seen / (1 + division * seen**2)
    powers = np.column_stack([away**3, away**5, away**7])
    return np.linalg.lstsq(powers, seen - away, rcond=None)[0]


@dataclass(frozen=True, eq=False)
class Samples:
    """Points along the middle of a court's painted lines."""

    place: NDArray  # (N, 2): m
    half: NDArray  # (N, 2): half the way to the next point, m
    line: NDArray  # (N,) int: row of the court's `lines_m`


def samples(court: Court, step_m: float) -> Samples:
    """Return points about `step_m` apart along all lines of a court."""
    line, ends = line_edges.stretches(court, step_m)
    return Samples(ends.mean(axis=1)[:, :2], (ends[:, 1] - ends[:, 0])[:, :2] / 2, line)


def is_symmetric(court: Court) -> bool:
    """Say whether half a turn about its middle leaves a court's lines as they are."""
    low, high = court.line_corners()
    rows = np.column_stack([low, high])
    turned = np.column_stack([court.size_m - high, court.size_m - low])
    apart = np.abs(rows[:, None] - turned).max(axis=2)
    return bool((apart.min(axis=1, initial=np.inf) < ALIKE_M).all())


def half_turned(view: Views, court: Court) -> Views:
    """Return cameras that see a court turned by half a turn about its middle as these see it."""
    turn = np.diag([-1.0, -1.0, 1.0])
    centre = view.centre @ turn + np.array([*court.size_m, 0])
    return replace(view, rotation=view.rotation @ turn, centre=centre)


def outline(view: Views, court: Court) -> NDArray:
    """Return px (B, 9, 2) of the court's corners, middles of sides and middle."""
    x, y = court.size_m
    grid = np.array([[i * x / 2, j * y / 2] for j in range(3) for i in range(3)])
    return view.project(grid)
