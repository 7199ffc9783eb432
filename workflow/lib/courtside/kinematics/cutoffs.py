"""Cut-off frequencies for groups of joints: by residual analysis, or as stated."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.kinematics import filtering
from courtside.records import tables
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import InputError, StrPath
from courtside.study.execution import log

RESIDUAL = "residual"  # in place of a number: choose by residual analysis
TAIL = 0.5  # ASSUME: above this share of the highest candidate the residual is noise alone
HIGHEST = 0.45  # of the frame rate; the filter needs less than half
STEP_HZ = 0.5  # ASSUME: fine enough, as the result is interpolated between candidates
MIN_FRAMES = 30  # ASSUME: fewer give no steady residual
COLUMNS = ["group", "cutoff_hz", "order", "noise_mm", "candidate_hz", "residual_mm"]


@dataclass(frozen=True, eq=False)
class Choice:
    """A chosen cut-off and the residual analysis behind it."""

    cutoff_hz: float
    # candidates_hz, residual_m: (N,), root mean square difference per axis between raw and filtered
    # path; empty for a stated number.
    candidates_hz: NDArray
    residual_m: NDArray
    noise_m: float  # standard deviation per axis of the noise found; NaN for a stated number


def candidates(rate_hz: float) -> NDArray:
    """Return the candidates (N,) Hz: from 1 Hz to 0.45 of the frame rate, at most 20 Hz."""
    return np.arange(1.0, min(HIGHEST * rate_hz, 20.0) + 1e-9, STEP_HZ)


def choose_cutoff(
    xyz: NDArray,
    rate_hz: float,
    order: int = 4,
    *,
    place: str = "filter_motion.cutoff_hz",
) -> Choice:
    """Choose by residual analysis the lowest cut-off that removes no more motion than noise passes.

    `xyz` (T, ..., 3) are raw paths of one group of joints, short gaps filled, NaN in gaps; with
    fewer than 30 known frames, or at a rate that allows no candidate, an `InputError`. The lowest
    or highest of `candidates` is the result where none fits. `order` is the effective order of the
    filter, `place` what the error names: file and key.

    Winter 2009, sec. 2.2.4.3 fits a straight line to the tail of the residual over the cut-off and
    takes the cut-off whose residual equals the line's value at 0 Hz, the noise. That tail is
    straight only by eye. For white noise of standard deviation s the squared residual in the tail
    is s^2 r(f), where the share r of the noise that the filter removes follows from its
    coefficients: a line through the origin, whose slope is the median of residual^2 / r over the
    candidates above half the highest. With the share p(f) that passes, motion lost equals noise
    passed where residual^2 = s^2 (r + p).

    Of noise that is correlated from frame to frame only the fast part is seen; the slow part counts
    as motion, and the cut-off becomes higher. A take that is mostly slow gets a low cut-off, which
    blunts its few fast moments: state a number where peaks matter.
    """
    candidates_hz = candidates(rate_hz)
    lines = np.reshape(xyz, (len(xyz), -1, 3))
    n_known = np.count_nonzero(np.any(np.isfinite(lines).all(axis=2), axis=1))
    if n_known < MIN_FRAMES:
        raise InputError(
            f"{place}: expected {MIN_FRAMES} known frames or more to choose a cut-off from, found "
            f"{n_known}; state a number of Hz in config.yaml, or in `override` of the session"
        )
    if not len(candidates_hz):
        raise InputError(
            f"{place}: expected {1 / HIGHEST:.3g} frames per second or more to choose a cut-off "
            f"from, found {rate_hz:.3g}; state a number of Hz in config.yaml, or in `override` of "
            "the session"
        )
    residual = np.array([_residual(lines, rate_hz, cutoff, order) for cutoff in candidates_hz])
    shares = [_shares(rate_hz, float(cutoff), order) for cutoff in candidates_hz]
    stopped, passed = np.transpose(shares)
    tail = candidates_hz >= TAIL * candidates_hz[-1]
    noise = float(np.sqrt(np.median(residual[tail] ** 2 / stopped[tail])))
    excess = residual - noise * np.sqrt(stopped + passed)
    return Choice(_crossing(candidates_hz, excess), candidates_hz, residual, noise)


def _residual(lines: NDArray, rate_hz: float, cutoff_hz: float, order: int) -> float:
    moved = lines - filtering.zero_lag_points(lines, rate_hz, cutoff_hz, order)
    return float(np.sqrt(np.nanmean(np.square(moved))))


def _shares(rate_hz: float, cutoff_hz: float, order: int) -> tuple[float, float]:
    """Return the shares of white noise's variance that the filter removes and passes."""
    n_frames = int(np.ceil(4 * rate_hz / cutoff_hz)) + 1
    passing = filtering.zero_lag(np.eye(n_frames), rate_hz, cutoff_hz, order)[n_frames // 2]
    stopping = (np.arange(n_frames) == n_frames // 2) - passing
    return stopping @ stopping, passing @ passing


def _crossing(candidates_hz: NDArray, excess: NDArray) -> float:
    """Return the lowest cut-off at which the excess falls to 0, by linear interpolation."""
    below = np.flatnonzero(excess <= 0)
    if not len(below) or below[0] == 0:
        return float(candidates_hz[below[0] if len(below) else -1])
    at = below[0]
    share = excess[at - 1] / (excess[at - 1] - excess[at])
    return float(candidates_hz[at - 1] + share * (candidates_hz[at] - candidates_hz[at - 1]))


def by_group(
    points: Keypoints3D,
    skeleton: Skeleton,
    wanted: Mapping[str, float | str],
    order: int = 4,
    *,
    path: StrPath,
) -> dict[str, Choice]:
    """Return the cut-off of each group of joints: the stated number, or `RESIDUAL`'s choice.

    `points` are of `skeleton_filter.prepare`, from the file `path`, which errors name. `wanted`
    maps groups of the skeleton to Hz or `RESIDUAL`. A number above `HIGHEST` of the frame rate is
    lowered to that, and the log says so in one line.
    """
    wanted = _lowered(wanted, points.rate_hz)
    choices = {}
    for group, value in wanted.items():
        if value == RESIDUAL:
            chosen = [
                at for at, joint in enumerate(points.joints) if joint in skeleton.groups[group]
            ]
            paths = points.xyz[:, :, chosen].swapaxes(0, 1)
            choices[group] = choose_cutoff(
                paths, points.rate_hz, order=order, place=f"{path}: filter_motion.cutoff_hz.{group}"
            )
        else:
            choices[group] = Choice(float(value), np.zeros(0), np.zeros(0), float("nan"))
    return choices


def _lowered(wanted: Mapping[str, float | str], rate_hz: float) -> dict[str, float | str]:
    """Return cut-offs (Hz, or `RESIDUAL`) of which none is above what the frame rate allows."""
    most = np.floor(100 * HIGHEST * rate_hz) / 100 if np.isfinite(rate_hz) else np.inf
    high = [name for name, value in wanted.items() if value != RESIDUAL and float(value) > most]
    if high:
        log.logger.warning(
            "filter_motion.cutoff_hz: %s lowered to %.2f Hz, the most at %.4g frames per second",
            ", ".join(f"{name} {wanted[name]:g}" for name in high),
            most,
            rate_hz,
        )
    return {name: float(most) if name in high else value for name, value in wanted.items()}


def table(choices: Mapping[str, Choice], order: int) -> pd.DataFrame:
    """Return how the cut-offs of each group were chosen, and the filter's effective order.

    `COLUMNS`: group, cutoff_hz, order, noise_mm (found by the analysis, per axis), candidate_hz,
    residual_mm; one row with the last three empty if the cut-off was stated.
    """
    rows = []
    for group, choice in choices.items():
        pairs = list(zip(choice.candidates_hz, choice.residual_m, strict=True))
        for candidate, residual in pairs or [(float("nan"), float("nan"))]:
            about = (group, choice.cutoff_hz, order, 1000 * choice.noise_m)
            rows.append((*about, candidate, 1000 * residual))
    return pd.DataFrame(rows, columns=COLUMNS).round(4)


def read(path: StrPath) -> tuple[dict[str, float], int]:
    """Read a `table`: the cut-off of each group (Hz), and the effective order of the filter."""
    rows = tables.read(path, "a table of cut-offs", _fault).drop_duplicates("group")
    chosen = dict(zip(rows["group"], rows["cutoff_hz"].astype(float), strict=True))
    return chosen, int(rows["order"].iloc[0])


def _fault(rows: pd.DataFrame) -> str:
    if list(rows.columns) != COLUMNS:
        return f"columns {list(rows.columns)}"
    numbers = rows[["cutoff_hz", "order"]].to_numpy(dtype=float)
    return "" if len(rows) and (numbers > 0).all() else "a row without a cut-off"
