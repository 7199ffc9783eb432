"""The edges of painted lines that meet at each named point of a court, and the painted areas."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import ON_EDGE_M, RAISED_M, Court
from courtside.geometry.camera import Camera, project, undistort

LONGEST = 4.0  # ASSUME: times the error across an edge: along edges that cross flat
STEP_M = 1e-3  # along an edge, for its direction in the picture


@dataclass(frozen=True)
class Edge:
    """An edge, or the middle, of one painted line, on which a named point lies."""

    line: int  # row of `Court.lines_m`
    axis: int  # 0 where the edge runs along y at a fixed x, 1 where it runs along x at a fixed y
    at_m: float  # that fixed coordinate
    side: int  # -1: the edge of the lower coordinate, 0: the line's middle, 1: the other edge


def named(court: Court) -> tuple[tuple[Edge, ...], ...]:
    """Find the edges that meet at each of the P points, on the floor.

    Two for a crossing or corner, of different axes; one for the foot of a net post on a side line;
    none for raised points. Where lines of one axis overlap at the point, the longer one counts.
    """
    low, high = court.line_corners()
    return tuple(_at(low, high, xyz) for xyz in court.xyz)


def _at(low: NDArray, high: NDArray, xyz: NDArray) -> tuple[Edge, ...]:
    if xyz[2] > RAISED_M:
        return ()
    across = np.argmin(high - low, axis=1)
    inside = (xyz[:2] >= low - ON_EDGE_M) & (xyz[:2] <= high + ON_EDGE_M)
    best: dict[int, tuple[float, Edge]] = {}
    for line in np.flatnonzero(inside.all(axis=1)):
        axis = int(across[line])
        low_m, high_m = low[line, axis], high[line, axis]
        sides = {-1: low_m, 0: (low_m + high_m) / 2, 1: high_m}
        near = [side for side, at_m in sides.items() if abs(at_m - xyz[axis]) <= ON_EDGE_M]
        length = high[line, 1 - axis] - low[line, 1 - axis]
        if near and length > (best[axis][0] if axis in best else 0):
            best[axis] = length, Edge(int(line), axis, float(xyz[axis]), near[0])
    return tuple(best[axis][1] for axis in sorted(best))


def crossings(camera: Camera, xyz: NDArray) -> NDArray:
    """Return the covariance (P, 2, 2) of a click of unit error across each edge of a point.

    The edges of points (P, 3) on the floor lie along the court's axes. Where they cross at a small
    angle in the picture, a click is inaccurate along them. NaN where the picture does not show
    their directions.
    """
    ends = xyz[:, None] + STEP_M * np.eye(3)[:2]
    along = project(camera, ends.reshape(-1, 3)).reshape(-1, 2, 2) - project(camera, xyz)[:, None]
    with np.errstate(invalid="ignore", divide="ignore"):
        across = along[:, :, ::-1] * [1, -1] / np.linalg.norm(along, axis=2, keepdims=True)
    information = across.transpose(0, 2, 1) @ across
    seen = np.isfinite(information).all(axis=(1, 2))
    extent, axes = np.linalg.eigh(information[seen])
    found = np.full(information.shape, np.nan)
    found[seen] = (axes / np.maximum(extent, LONGEST**-2.0)[:, None]) @ axes.transpose(0, 2, 1)
    return found


def click_covariances(camera: Camera, xyz: NDArray, on_edge: NDArray) -> NDArray:
    """Return `crossings` (P, 2, 2) of the points that lie `on_edge`, (P,) bool; others have 1."""
    covariances = crossings(camera, xyz)
    known = on_edge & np.isfinite(covariances).all(axis=(1, 2))
    return np.where(known[:, None, None], covariances, np.eye(2))


def click_variances(camera: Camera, court: Court) -> NDArray:
    """Return the variance (P, 2) of a click by picture axis, where one across an edge has 1."""
    covariances = click_covariances(camera, court.xyz, on_lines(court))
    return np.diagonal(covariances, axis1=1, axis2=2)


@lru_cache(maxsize=16)
def on_lines(court: Court) -> NDArray:
    """Return which points (P,) bool lie on a painted edge, or the middle of a line."""
    return np.array([len(edges) > 0 for edges in named(court)], dtype=bool)


def post(court: Court, point: int) -> int | None:
    """Return the post of the net, 0 or 1, of the point of an index in `court.points`, or None."""
    if court.net is None:
        return None
    place = court.xyz[point]
    for number, x in enumerate(court.net["x_m"]):
        if np.hypot(place[0] - x, place[1] - court.net["y_m"]) <= ON_EDGE_M:
            return number
    return None


def middle_line(court: Court, line: int) -> tuple[NDArray, NDArray]:
    """Return the ends of the middle of a row of `lines_m`, (2, 3) m, and half its width, (3,) m."""
    low, high = (corners[line] for corners in court.line_corners())
    axis = int(np.argmin(high - low))
    ends = np.array([[*low, 0.0], [*high, 0.0]])
    ends[:, axis] = (low[axis] + high[axis]) / 2
    half = np.zeros(3)
    half[axis] = (high[axis] - low[axis]) / 2
    return ends, half


def stretches(court: Court, length_m: float) -> tuple[NDArray, NDArray]:
    """Cut all lines into stretches of about one length.

    Return the row of `lines_m` (M,) of each, and its ends (M, 2, 3) m on the line's middle.
    """
    found = []
    for line in range(len(court.lines_m)):
        ends, _ = middle_line(court, line)
        n = max(1, round(float(np.linalg.norm(ends[1] - ends[0])) / length_m))
        cuts = ends[0] + np.linspace(0, 1, n + 1)[:, np.newaxis] * (ends[1] - ends[0])
        found += [(line, cuts[at : at + 2]) for at in range(n)]
    rows, ends_m = [line for line, _ in found], [ends for _, ends in found]
    return np.array(rows, dtype=int), np.array(ends_m).reshape(-1, 2, 3)


@dataclass(frozen=True)
class Paint:
    """Areas that a camera expects to be painted."""

    place: Callable[[NDArray], NDArray]  # from px (..., 2) to places (..., 2), smooth
    shows: Callable[[NDArray], NDArray]  # from places (..., 2) to whether there is paint (...)


def paint(camera: Camera, court: Court) -> Paint:
    """Return where a camera expects paint; places are m on the floor, NaN above the horizon."""
    low, high = court.line_corners()
    rotation, centre = camera.cam_from_world[:, :3], camera.centre_in_world

    def place(xy: NDArray) -> NDArray:
        rays = undistort(camera, xy)
        rays = np.concatenate([rays, np.ones((*rays.shape[:-1], 1))], axis=-1) @ rotation
        with np.errstate(divide="ignore", invalid="ignore"):
            on_floor = centre[:2] - rays[..., :2] * (centre[2] / rays[..., 2:])
        return np.where(rays[..., 2:] * centre[2] < 0, on_floor, np.nan)

    def shows(places: NDArray) -> NDArray:
        found = np.zeros(places.shape[:-1], dtype=bool)
        x, y = places[..., 0], places[..., 1]
        for (x0, y0), (x1, y1) in zip(low, high, strict=True):
            found |= (x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)
        return found

    return Paint(place, shows)
