"""Refinement of a camera until the court's lines project onto ridges of the picture."""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.calibration.court_lines.evidence import SAMPLE_PX, Fields
from courtside.calibration.court_lines.ridges import direction_off
from courtside.calibration.court_lines.views import Samples, Views
from courtside.geometry import rotations

# ASSUME: all of these are tuned by hand on development sessions.
REACH_PX = (10.0, 5.0, 3.0)  # per 1280 px of width: across the line, round by round
STEP_PX, PIXEL_PX = 0.25, 1.0  # of the search, and of the extent of a pixel across a line
OFF_RAD = np.deg2rad(14.0)
FEWEST = 12  # samples with a ridge near
LENS_SIGMA, FOCAL_SIGMA = 0.1, 0.7  # of `division`; of the focal length in logarithms
EDGE_PX = 0.5  # of a ridge, standard deviation
STEPS = np.array([0.01] * 3 + [0.2] * 3 + [0.02, 0.02])  # rad, m, ln f, division


@dataclass(frozen=True)
class Uncertainty:
    """Standard deviations of what lines on the floor determine of a camera."""

    f_share: float  # of the focal length, relative
    height_m: float
    distance_m: float  # to the court's middle


def refine(seen: Fields, view: Views, along: Samples) -> Views | None:
    """Fit a camera (`Views` of one) to the ridges near its lines; None if they are too few."""
    scale, division = seen.width / 1280, float(view.division[0])
    for reach in REACH_PX:
        for _ in range(2):
            found = _targets(seen, view, along, reach * scale)
            if found is None:
                return None
            residuals = _residuals(view, along, found, max(0.25 * reach * scale, 0.5), division)
            change = scipy.optimize.least_squares(
                residuals, np.zeros(8), loss="soft_l1", x_scale=STEPS, max_nfev=8
            )
            view = moved(view, change.x)
    return view


def moved(view: Views, change: NDArray) -> Views:
    """Return a camera turned (rad, world axes), moved (m), zoomed (ln) and with another lens."""
    turn = rotations.rotation_from_rodrigues(change[:3])
    return Views(
        (view.rotation[0] @ turn)[None],
        view.centre + change[3:6],
        view.f_px * np.exp(change[6]),
        view.division + change[7],
        view.principal,
    )


def uncertainty(seen: Fields, view: Views, along: Samples, middle_m: NDArray) -> Uncertainty | None:
    """Return the uncertainty of a camera fitted to lines; `middle_m` (3,) is the court's middle."""
    found = _targets(seen, view, along, REACH_PX[-1] * seen.width / 1280)
    if found is None:
        return None
    # Neighbouring samples of one line share their errors.
    residuals = _residuals(view, along, found, EDGE_PX * 2, float(view.division[0]))
    base, small = residuals(np.zeros(8)), 1e-4 * STEPS
    columns = [(residuals(np.eye(8)[at] * small[at]) - base) / small[at] for at in range(8)]
    slopes = np.stack(columns, axis=1)
    covariance = np.linalg.pinv(slopes.T @ slopes)
    towards = (view.centre[0] - middle_m) / np.linalg.norm(view.centre[0] - middle_m)
    variance = covariance[6, 6], covariance[5, 5], towards @ covariance[3:6, 3:6] @ towards
    return Uncertainty(*(float(np.sqrt(value)) for value in variance))


@dataclass(frozen=True, eq=False)
class _Targets:
    """Ridges near samples of lines."""

    sample: NDArray  # (M,) int
    xy: NDArray  # (M, 2): px
    normal: NDArray  # (M, 2): across the line
    weight: NDArray  # (M,): square root of the share of a full sample


def _targets(seen: Fields, view: Views, along: Samples, reach_px: float) -> _Targets | None:
    """Return the nearest ridge of the line's direction across the line at each sample."""
    size = np.array(seen.distance.shape[:0:-1])
    place = view.project(along.place)[0]
    tangent = view.project(along.place + along.half) - view.project(along.place - along.half)
    tangent = tangent[0]
    length = np.linalg.norm(tangent, axis=1)
    inside = ((place > 4) & (place < size - 5)).all(axis=1) & (length > 0)
    at = np.flatnonzero(inside)
    normal = np.column_stack([-tangent[at, 1], tangent[at, 0]]) / length[at, None]
    steps = np.arange(-reach_px, reach_px + STEP_PX / 2, STEP_PX)
    around = place[at, None] + steps[:, None] * normal[:, None]
    x, y = np.clip(np.round(around), 0, size - 1).astype(int).transpose(2, 0, 1)
    angle = np.arctan2(tangent[at, 1], tangent[at, 0])[:, None]
    off = direction_off(seen.ridges.angle[y, x], angle)
    cost = np.where(seen.ridges.on[y, x] & (off < OFF_RAD), np.abs(steps), np.inf)
    if not len(at):
        return None
    best = cost.argmin(axis=1)
    hit = np.isfinite(cost[np.arange(len(at)), best])
    if hit.sum() < FEWEST:
        return None
    # A pixel is met at several steps: its middle is meant.
    same = np.isfinite(cost[hit]) & (np.abs(steps - steps[best[hit], None]) <= PIXEL_PX)
    across = (same * steps).sum(axis=1) / same.sum(axis=1)
    target = place[at[hit]] + across[:, None] * normal[hit]
    weight = np.sqrt(np.minimum(length[at[hit]], SAMPLE_PX) / SAMPLE_PX)
    return _Targets(at[hit], target, normal[hit], weight)


def _residuals(view: Views, along: Samples, found: _Targets, sigma_px: float, division: float):
    places = along.place[found.sample]

    def residuals(change: NDArray) -> NDArray:
        trial = moved(view, change)
        off = np.sum((trial.project(places)[0] - found.xy) * found.normal, axis=1)
        lens = (trial.division[0] - division) / LENS_SIGMA, change[6] / FOCAL_SIGMA
        off = np.nan_to_num(off, nan=50.0) / sigma_px * found.weight
        return np.concatenate([off, lens])

    return residuals
