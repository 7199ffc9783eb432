"""Camera positions that project lines of a court onto lines of the picture."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.calibration.court_lines import views
from courtside.calibration.court_lines.floor_frames import FloorFrame, Pieces
from courtside.calibration.court_lines.views import Views

# ASSUME: all of these are tuned by hand on development sessions.
MOST_LINES = 18  # of the picture, in each direction
PARALLEL_RAD = np.deg2rad(2.0)
OFF_PX = 2.0  # per 1280 px of width: of a line of the picture
JOINED_M = 0.12  # lines of the court nearer than this are one
HEIGHT_M = (0.9, 16.0)  # of a camera above the floor
BEYOND_M, BEYOND_LENGTHS = 10.0, 2.0  # farthest from the court's middle, with its long side
KEPT, PER_KEPT = 40, 5  # places along one axis, and for each along the other
GRID_STEPS, PER_GRID = 240, 1  # places along an axis whose lines are not found in the picture


@dataclass(frozen=True, eq=False)
class _Axis:
    """Lines across one axis: in the picture, for a camera 1 m high, and on the court."""

    at: NDArray  # (L,): where lines of the picture are
    tolerance: NDArray  # (L,)
    weight: NDArray  # (L,)
    court_m: NDArray  # (K,): where lines of the court are
    far_m: float  # of a camera from their middle

    def score(self, height_m: NDArray, place_m: NDArray) -> NDArray:
        """Score places (N,) by lines that meet, each counted once."""
        if not len(self.at):
            return np.zeros(len(height_m))
        expected = (self.court_m - place_m[:, None]) / height_m[:, None]
        off = np.abs(expected[:, :, None] - self.at) / (3 * self.tolerance)
        close = np.maximum(0, 1 - off) * self.weight
        return np.minimum(close.max(axis=2).sum(axis=1), close.max(axis=1).sum(axis=1))

    def pairs(self) -> tuple[NDArray, NDArray]:
        """Return heights and places that put two lines of the court on two of the picture."""
        i, j = np.triu_indices(len(self.at), 1)
        a, b = np.triu_indices(len(self.court_m), 1)
        apart, first = np.abs(self.at[j] - self.at[i]), np.minimum(self.at[i], self.at[j])
        height = (self.court_m[b] - self.court_m[a]) / np.maximum(apart, 1e-9)[:, None]
        place = self.court_m[a] - height * first[:, None]
        good = (height > HEIGHT_M[0]) & (height < HEIGHT_M[1])
        good &= np.abs(place - self.court_m.mean()) < self.far_m
        return height[good], place[good]

    def others(self, height_m: float) -> tuple[NDArray, NDArray]:
        """Return places at a height that put one line on one, and their scores, best first."""
        place = (self.court_m - height_m * self.at[:, None]).ravel()
        place = place[np.abs(place - self.court_m.mean()) < self.far_m]
        score = self.score(np.full(len(place), height_m), place)
        best = np.argsort(-score)[:PER_KEPT]
        return place[best], score[best]

    def grid(self) -> NDArray:
        """Return places all along the axis, evenly apart."""
        return self.court_m.mean() + np.linspace(-self.far_m, self.far_m, GRID_STEPS)


def find(
    frame: FloorFrame,
    ends: NDArray,
    court: Court,
    width: float,
    division: float,
    principal: NDArray,
) -> list[Views]:
    """Return cameras with a floor frame that project lines of a court onto lines of the picture.

    Two lines of the picture, matched to two of the court, give the height and one coordinate. The
    other coordinate comes from one matched line or, for the best, from a grid. `ends` as for
    `floor_frames.find`.
    """
    found = []
    for quarter in (0, 1) if views.is_symmetric(court) else (0, 1, 2, 3):
        axes = frame.axes
        for _ in range(quarter):
            axes = np.stack([axes[1], -axes[0], axes[2]])
        both = _axes(axes, frame.f_px, ends, court, width)
        places = [_places(*both), _places(*both[::-1])[:, [1, 0, 2]]]
        for centre in places:
            if len(centre):
                n = len(centre)
                rotation = np.broadcast_to(axes.T, (n, 3, 3))
                lens = np.full(n, frame.f_px), np.full(n, division)
                found.append(Views(rotation, centre, *lens, principal))
    return found


def _axes(axes: NDArray, f_px: float, ends: NDArray, court: Court, width: float) -> list[_Axis]:
    """Return the lines across the floor's two axes."""
    pieces = Pieces.of(ends)
    tangent, length = pieces.tangent, pieces.length
    low, high = court.line_corners()
    across, far_m = np.argmin(high - low, axis=1), BEYOND_M + BEYOND_LENGTHS * court.size_m[1]

    def on_floor(xy: NDArray) -> NDArray:
        rays = np.column_stack([xy, np.full(len(xy), f_px)]) @ axes.T
        return rays[:, :2] / np.where(rays[:, 2:] < -0.01 * f_px, -rays[:, 2:], np.nan)

    below = np.isfinite(on_floor(ends[:, :2]) + on_floor(ends[:, 2:])).all(axis=1)
    found = []
    for axis in (0, 1):
        sine = np.abs(pieces.off(axes[1 - axis], f_px))
        good = below & (sine < PARALLEL_RAD + 1 / length)
        step = OFF_PX * width / 1280 * np.column_stack([-tangent[good, 1], tangent[good, 0]])
        places = [on_floor(pieces.middle[good] + by * step)[:, axis] for by in (-1, 0, 1)]
        seen = np.isfinite(places).all(axis=0)
        tolerance = np.abs(places[2] - places[0])[seen] / 2
        lines = _merged(places[1][seen], np.maximum(tolerance, 1e-6), length[good][seen])
        court_m = _joined(((low + high) / 2)[across == axis, axis])
        found.append(_Axis(*lines, court_m, far_m))
    return found


def _merged(at: NDArray, tolerance: NDArray, length: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Merge pieces of one line; return place, tolerance and weight of the longest lines."""
    free, rows = np.ones(len(at), dtype=bool), []
    for first in np.argsort(-length):
        if free[first]:
            near = free & (np.abs(at - at[first]) < np.maximum(tolerance[first], tolerance / 2))
            near[first] = True
            free &= ~near
            weight = length[near] / tolerance[near] ** 2
            place = np.sum(at[near] * weight) / weight.sum()
            least = min(tolerance[near].min(), tolerance[first])
            rows.append((place, 1.5 * least, length[near].sum()))
    rows.sort(key=lambda row: -row[2])
    at, tolerance, length = np.array(rows[:MOST_LINES]).reshape(-1, 3).T
    return at, tolerance, np.sqrt(np.minimum(length, 300))


def _joined(places: NDArray) -> NDArray:
    """Return sorted places, those nearer than `JOINED_M` to the one before as one, (K,)."""
    places = np.sort(places)
    group = np.cumsum(np.diff(places, prepend=places[:1]) > JOINED_M)
    return np.bincount(group, places) / np.bincount(group)


def _places(first: _Axis, second: _Axis) -> NDArray:
    """Return centres (N, 3) m: along the first axis, along the second, height."""
    height, place = first.pairs()
    if not len(height):
        return np.zeros((0, 3))
    score = first.score(height, place)
    kept: list[int] = []
    for at in np.argsort(-score)[: 3 * KEPT]:
        log_ratio = np.abs(np.log(height[at] / height[kept]))
        if ((log_ratio > 0.01) | (np.abs(place[at] - place[kept]) > 0.05)).all():
            kept.append(int(at))
    found = []
    for rank, at in enumerate(kept[:KEPT]):
        along = second.others(height[at])[0]
        if rank < PER_GRID:
            along = np.concatenate([along, second.grid()])
        found += [(place[at], other, height[at]) for other in along]
    return np.array(found).reshape(-1, 3)
