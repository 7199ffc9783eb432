"""Errors of 3D joints against an optical marker system with a clock and a frame of its own.

The time shift and one rigid motion are found from the compared joints themselves, because nothing
else ties the two: an error of time or place that is the same for the whole take is hidden. The
scale is not fitted. It is stated, and an error of scale counts.
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import scipy
from numpy.typing import NDArray

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.evaluation import joints
from courtside.geometry.similarity import Sim3, kabsch
from courtside.statistics import moving_blocks
from courtside.statistics.normal_errors import ellipsoid, mahalanobis
from courtside.study.errors import InputError

# Compared, with the names that marker systems give them. A marker system's `Hand` is its wrist.
# Shoulders, hip centre and spine are left out: of many systems they are clavicles and other places.
JOINTS = {
    f"{side}_{part}": f"{side[0].upper()}{name}"
    for side in ("left", "right")
    for part, name in {
        "hip": "Hip",
        "knee": "Knee",
        "ankle": "Ankle",
        "elbow": "Elbow",
        "wrist": "Hand",
    }.items()
}
MOST_S = 0.5  # of the time shifts that are tried, to either side
STEP_S = 0.02  # ASSUME: of the first search over time shifts; a wrist turns within 0.1 s
SOFT_M = 0.03  # ASSUME: errors below it have full weight in the motion, larger ones less
FEWEST = 0.5  # ASSUME: of the joints: a shift that leaves fewer beside the truth is no match
ROUNDS = 20  # of its weights, which settle in about ten
BLOCK_S = 0.5  # errors of neighbouring frames are alike: blocks of frames are resampled
ALL = "all"
COLUMNS = ["joint", "n", "missing_percent", "median_mm", "median_from_mm", "median_to_mm", "p90_mm"]
COLUMNS += ["p90_from_mm", "p90_to_mm", "coverage_90_percent"]


@dataclass(frozen=True, eq=False)
class Fit:
    """How a take lies in the marker system's time and frame."""

    shift_s: float  # the marker system's time less the take's
    truth_from_world: Sim3  # of scale 1
    # Extent of the measured joints over that of the true ones: 1.01 is 1 % too large. It is stated,
    # not taken out of the errors.
    scale: float
    error: NDArray  # (T, J, 3): measured minus true, m, in the world's axes; NaN where missing
    known: NDArray  # (T,) bool: frames with truth


def fit(time_s: NDArray, xyz: NDArray, true_s: NDArray, true_xyz: NDArray) -> Fit:
    """Find the time shift and the rigid motion of least error, robustly.

    Measured joints (T, J, 3) m at `time_s` (T,), true ones (U, J, 3) m, the same joints, at
    `true_s` (U,). Both times are taken from their first value; shifts of up to `MOST_S` to either
    side are tried. The error that is least is the mean distance of all joints. Raises `InputError`
    where no shift leaves half of the joints to compare.
    """
    own_s, other_s = time_s - time_s[0], true_s - true_s[0]

    def moved(shift_s: float) -> NDArray:
        return joints.at_times(other_s, true_xyz[None], own_s + shift_s)[0]

    def cost(shift_s: float) -> float:
        true = moved(shift_s)
        both = _both(xyz, true)
        if both.sum() < max(3, FEWEST * _placed(xyz).sum()):
            return np.inf
        motion = _motion(xyz[both], true[both])
        return float(np.linalg.norm(motion.points(xyz[both]) - true[both], axis=1).mean())

    tried = np.arange(-MOST_S, MOST_S + STEP_S / 2, STEP_S)
    costs = [cost(shift) for shift in tried]
    if not np.isfinite(costs).any():
        raise InputError("truth: expected joints at the take's times, found none; check its times")
    near = tried[int(np.argmin(costs))]
    found = scipy.optimize.minimize_scalar(
        cost, bounds=(near - STEP_S, near + STEP_S), method="bounded"
    )
    true = moved(float(found.x))
    both = _both(xyz, true)
    motion = _motion(xyz[both], true[both])
    error = (motion.points(xyz) - true) @ motion.rotation  # back into the world's axes
    scale = _scale(motion.points(xyz[both]), true[both])
    shift_s = float(true_s[0] - time_s[0] + found.x)
    return Fit(shift_s, motion, scale, error, np.isfinite(true).all(axis=(1, 2)))


def _placed(xyz: NDArray) -> NDArray:
    return np.isfinite(xyz).all(axis=-1)


def _both(xyz: NDArray, true: NDArray) -> NDArray:
    return _placed(xyz) & _placed(true)


def _motion(xyz: NDArray, true: NDArray) -> Sim3:
    """Return the rigid motion from points (N, 3) to others that a few bad ones hardly move."""
    weight = np.ones(len(xyz))
    for _ in range(ROUNDS):
        share = (weight / weight.sum())[:, None]
        middle, true_middle = (share * xyz).sum(axis=0), (share * true).sum(axis=0)
        rotation, _ = kabsch((share * (true - true_middle)).T @ (xyz - middle))
        motion = Sim3(1.0, rotation, true_middle - rotation @ middle)
        weight = _weight(motion.points(xyz), true)
    return motion


def _weight(moved: NDArray, true: NDArray) -> NDArray:
    return 1 / np.maximum(np.linalg.norm(moved - true, axis=1), SOFT_M)


def _scale(moved: NDArray, true: NDArray) -> float:
    """Return the scale of moved points (N, 3) over the true ones, weighted as the motion was."""
    weight = _weight(moved, true)[:, None]
    true = true - (weight * true).sum(axis=0) / weight.sum()
    moved = moved - (weight * moved).sum(axis=0) / weight.sum()
    return float((weight * moved * true).sum() / (weight * true**2).sum())


def table(
    names: list[str], found: Fit, covariance: NDArray, rate_hz: float, doubtful: Sequence[str] = ()
) -> pd.DataFrame:
    """Return the errors by joint and of all together, with 95 % intervals: `COLUMNS`.

    `covariance` (T, J, 3, 3) m2 is what the record states; `rate_hz` are its frames per second.
    Where the truth of some joints is `doubtful`, all without them are a further group.
    The intervals resample blocks of `BLOCK_S`: they hold for this person and take alone.
    """
    groups = {ALL: list(range(len(names)))}
    if doubtful:
        sure = [at for at, name in enumerate(names) if name not in doubtful]
        groups[f"{ALL} but {', '.join(doubtful)}"] = sure
    groups |= {name: [at] for at, name in enumerate(names)}
    block = max(1, round(BLOCK_S * rate_hz))
    rows = []
    for name, at in groups.items():
        error, spread = found.error[found.known][:, at], covariance[found.known][:, at]
        rows.append({"joint": name, **_summary(error, spread, block)})
    return pd.DataFrame(rows, columns=COLUMNS)


def _summary(error: NDArray, covariance: NDArray, block: int) -> dict[str, Any]:
    distance = 1000 * np.linalg.norm(error, axis=-1)
    placed = np.isfinite(distance)
    row: dict[str, Any] = {"n": int(placed.sum()), "missing_percent": 100 * (1 - placed.mean())}
    if not placed.any():
        return row
    drawn = [np.percentile(one, (50, 90)) for one in _drawn(distance, block)]
    ends = np.percentile(drawn, (2.5, 97.5), axis=0)
    found = np.percentile(distance[placed], (50, 90))
    for at, key in enumerate(("median", "p90")):
        row[f"{key}_mm"], (row[f"{key}_from_mm"], row[f"{key}_to_mm"]) = found[at], ends[:, at]
    stated = placed & np.isfinite(covariance).all(axis=(-2, -1))
    if stated.any():
        inside = mahalanobis(error[stated], covariance[stated]) <= ellipsoid(0.9)
        row["coverage_90_percent"] = 100 * inside.mean()
    return row


def _drawn(distance: NDArray, block: int) -> list[NDArray]:
    """Return the distances, of (T, J), of takes resampled by blocks of frames."""
    counts = moving_blocks.counts([len(distance)], [block])
    drawn = (np.repeat(distance, often, axis=0) for often in counts)
    return [one[np.isfinite(one)] for one in drawn if np.isfinite(one).any()]
