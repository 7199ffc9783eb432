"""Steps: turns of a camera in place that fit epipolar residuals better than one pose.

In each row, the joints seen by two cameras give epipolar residuals, linear in the turn of either
camera. Their normal equations, summed over time, tell for each camera and each time how much better
a step fits than none: the cost is linear in rows.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.people import held_out
from courtside.calibration.people.adjustment import LOSS
from courtside.calibration.people.views import Seen
from courtside.geometry import camera as camera_models
from courtside.geometry import epipolar, rotations
from courtside.geometry.camera import Camera
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA

# ASSUME: limits that tell knocks of 0.4 degrees from none on development takes.
LEAST_S = 1.0  # of people seen on either side of a knock
LEAST_GAIN = 15.0  # of a step, chi-squared of 3, to be tried: errors of cameras make 20 to 200
LEAST_RAD = np.radians(0.1)  # smaller steps are how a network errs in different postures
USUAL_RAD = np.radians(0.5)  # about each axis: keeps a turn small that is badly seen
BLOCK_S = 1.0  # residuals err alike within it
GRID = 60  # times at which a camera may be turned or put back, before the best are refined


@dataclass(frozen=True, eq=False)
class Step:
    """A candidate: the turn (3,) rad of a camera at a time, and its chi-squared of 3."""

    camera: int
    time_s: float
    turn: NDArray
    gain: float
    until_s: float = np.inf  # when it is put back
    others: tuple["Step", ...] = ()  # of cameras turned at the same time, to measure with it

    @property
    def put_back(self) -> bool:
        """Whether the camera is put back within the take."""
        return bool(np.isfinite(self.until_s))

    def during(self, time_s: NDArray) -> NDArray:
        """Return at which times the camera is turned."""
        return (time_s >= self.time_s) & (time_s < self.until_s)


def clearest(
    cameras: Sequence[Camera], seen: Seen, min_score: float, at_s: Sequence[float] | None
) -> list[Step]:
    """Return each camera's clearest step, or those at given times, where they stand out."""
    equations = _equations(cameras, seen, min_score)
    times, row = np.unique(seen.time_s, return_inverse=True)
    order = np.argsort(row, kind="stable")
    first = np.flatnonzero(np.diff(row[order], prepend=-1))
    sums = [np.add.reduceat(part[:, order], first, axis=1) for part in equations]
    found = []
    for camera, (matrix, right) in enumerate(zip(*sums, strict=True)):
        when = [(one, np.inf) for one in at_s] if at_s else _spans(matrix, right, times)
        for span in when:
            step = _step(equations, seen, camera, *span)
            if step and step.gain >= LEAST_GAIN and np.linalg.norm(step.turn) >= LEAST_RAD:
                found.append(step)
    return found


def blocks(seen: Seen, fewest: int = held_out.BLOCKS) -> NDArray:
    """Return the block of time of its track (T,) int of each row: of 1 s, in short takes less."""
    long_s = min(BLOCK_S, np.ptp(seen.time_s) / fewest)
    block = np.stack([seen.track, seen.time_s // long_s])
    return np.unique(block, axis=1, return_inverse=True)[1].ravel()


def _equations(cameras: Sequence[Camera], seen: Seen, min_score: float) -> list[NDArray]:
    """Return normal equations of each camera's turn in each row, (C, T, 3, 3) and (C, T, 3).

    Of epipolar residuals; a view's scatter is in heights of the person.
    """
    rays = []
    for camera, xy in zip(cameras, seen.xy, strict=True):
        straight = camera_models.undistort(camera, xy)
        rays.append(rotations.unit(np.insert(straight, 2, 1.0, axis=-1)))
    shape = len(cameras), len(seen.track)
    matrix, right = np.zeros((*shape, 3, 3)), np.zeros((*shape, 3))
    used = np.nan_to_num(seen.score) >= min_score
    for pair in combinations(range(len(cameras)), 2):
        a, b = (cameras[at] for at in pair)
        base = rotations.unit(b.centre_in_world - a.centre_in_world)
        of_a, of_b = (
            rays[at] @ one.cam_from_world[:, :3] for at, one in zip(pair, (a, b), strict=True)
        )
        slopes = np.cross(of_b, base), np.cross(base, of_a)  # of the residual, by either ray
        variance = sum(
            (seen.height_px[at] / epipolar.focal_px(cameras[at]))[:, None] ** 2
            * (slope**2).sum(axis=-1)
            / np.maximum(seen.score[at], min_score)
            for at, slope in zip(pair, slopes, strict=True)
        )
        off = np.cross(of_a, of_b) @ base / np.sqrt(variance)
        known = np.isfinite(off) & used[pair[0]] & used[pair[1]]
        if not known.any():
            continue
        scatter = MEDIAN_TO_SIGMA * np.median(np.abs(off[known])) + np.finfo(float).tiny
        off = np.where(known, off, 0.0) / scatter
        weight = known / (1 + (off / LOSS) ** 2)
        for at, ray, slope in zip(pair, (of_a, of_b), slopes, strict=True):
            by_turn = np.cross(ray, slope) @ cameras[at].cam_from_world[:, :3].T
            by_turn = np.nan_to_num(by_turn / (scatter * np.sqrt(variance))[..., None])
            matrix[at] += np.einsum("tj,tji,tjk->tik", weight, by_turn, by_turn)
            right[at] += np.einsum("tj,tji,tj->ti", weight, by_turn, off)
    return [matrix, right]


def _spans(matrix: NDArray, right: NDArray, times: NDArray) -> list[tuple[float, float]]:
    """Return when a camera is best turned: for good, and until it is put back, if it can be."""
    ahead = [np.cumsum(np.concatenate([0 * part[:1], part]), axis=0) for part in (matrix, right)]
    rows = np.flatnonzero((times >= times[0] + LEAST_S) & (times <= times[-1] - LEAST_S))
    if not len(rows):
        return []
    first = rows[_gains(ahead, rows, len(times)).argmax()]
    spans = [(float(times[first]), np.inf)]
    grid = rows[np.unique(np.linspace(0, len(rows) - 1, GRID).astype(int))]
    starts, stops = np.array(list(combinations(grid, 2)), dtype=int).reshape(-1, 2).T
    long = times[stops] - times[starts] >= LEAST_S
    if not long.any():
        return spans
    stop = stops[long][_gains(ahead, starts[long], stops[long]).argmax()]
    for _ in range(2):  # refined in turn
        early = rows[times[rows] <= times[stop] - LEAST_S]
        start = early[_gains(ahead, early, stop).argmax()]
        late = rows[times[rows] >= times[start] + LEAST_S]
        stop = late[_gains(ahead, start, late).argmax()]
    return [*spans, (float(times[start]), float(times[stop]))]


def _gains(ahead: Sequence[NDArray], first, stop) -> NDArray:
    """Return how much turns from rows up to others lower the cost (N,), from sums before rows."""
    matrix, right = ahead
    ridge = (1e-6 * np.trace(matrix[-1]) + 1e-12) * np.eye(3)  # also of a camera that sees nobody

    def cost(one: NDArray, other: NDArray) -> NDArray:
        return (np.linalg.solve(one + ridge, other[..., None])[..., 0] * other).sum(axis=-1)

    during = matrix[stop] - matrix[first], right[stop] - right[first]
    return cost(*during) + cost(matrix[-1] - during[0], right[-1] - during[1])


def _step(equations, seen: Seen, camera: int, time_s: float, until_s: float) -> Step | None:
    """Return the step at a time; None where a side says too little.

    Residuals err alike: its covariance is from their sums over blocks of time.
    """
    after, turns, spread = (seen.time_s >= time_s) & (seen.time_s < until_s), [], []
    block = blocks(seen, fewest=1)
    for side in (~after, after):
        matrix, right = (part[camera, side] for part in equations)
        total = matrix.sum(axis=0)
        if np.linalg.matrix_rank(total) < 3:
            return None
        turns.append(np.linalg.solve(total, right.sum(axis=0)))
        left = right - matrix @ turns[-1]
        sums = np.stack([np.bincount(block[side], axis) for axis in left.T], axis=1)
        inverse = np.linalg.inv(total)
        spread.append(inverse + inverse @ sums.T @ sums @ inverse)
    step, information = turns[1] - turns[0], np.linalg.inv(spread[0] + spread[1])
    shrunk = np.linalg.solve(information + np.eye(3) / USUAL_RAD**2, information @ step)
    return Step(camera, time_s, shrunk, float(step @ information @ step), until_s)
