"""Errors of 3D joints that residuals do not show: a mixture of good positions and outliers.

The error of a joint, minus the network's known offset, is modelled by a mixture of two normal
distributions: for good positions, and for outliers (a wrong part of the body, an exchanged side, a
hidden limb). The keypoints' own covariance is added to both. The signs of
`reconstruction.error_signs` determine the width of the first and the probability of the second.
Their weights were fitted for each network on development players (`evaluate_joint_errors`). All
views share these errors, and a filter does not remove them.

The development players are virtual. Recorded people differ from them in body and clothes, and their
true joint centres are known only as well as two measuring systems agree on them. `state` therefore
adds a published variance for recorded people (`shared_errors.RECORDED_M`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import scipy
from numpy.typing import NDArray

from courtside.kinematics.shared_errors import RECORDED_M
from courtside.reconstruction import error_signs
from courtside.records.keypoints import keypoints, skeleton
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.study.errors import InputError, StrPath, reading

OUTLIER_M = 0.1  # an error above it is an outlier's: half the length of a forearm
# The stated normal distribution holds this share of the mixture's errors within the same distance
# as the mixture does: most joints keep the narrow width of good places, and one with an outlier's
# probability of a few percent gets a wide one. Bodies that are not in the fit have more outliers
# than the weights say, therefore it is more than the usual 90 %. Chosen on development bodies, each
# left out of the fit, so that 90 % ellipsoids hold well above 60 % of the errors above `OUTLIER_M`
# with two, three and four views (docs/measured/joints.md).
SHARE_HELD = 0.985
GOOD_M = (0.001, 0.1)  # least and most standard deviation of a good place, per axis
START_M, START_LOGIT, START_OUTLIER_M = 0.02, -2.0, 0.08  # where the fit begins
RIDGE = 1e-3, 3e-4  # of weights of good places and of outliers, per squared weight and joint
STEPS = 300  # at most, of the fit
JOINTS = skeleton.LIMBS[1:]  # those with a constant of their own, added to the shoulders'
SIGNS = ("constant", *JOINTS, *error_signs.NAMES)
LAST = "sigma_m"  # the row of standard deviations: the most of a good place, an outlier's
COLUMNS = ["sign", "mean", "spread", "good", "outlier"]
REMAKE = "make it again with the rule evaluate_joint_errors"


@dataclass(frozen=True)
class Model:
    """Weights of `SIGNS` (K,), standardised by their mean and spread (K,)."""

    mean: NDArray
    spread: NDArray
    good: NDArray  # of the logarithm of a good place's standard deviation per axis in metres
    outlier: NDArray  # of the logarithm of an outlier's odds
    sigma_m: float  # standard deviation per axis of an outlier

    def of(self, design: NDArray) -> tuple[NDArray, NDArray]:
        """Return a good place's variance (N,) m2 and an outlier's probability, by `design`."""
        standard = (design - self.mean) / self.spread
        good = np.exp(2 * np.clip(standard @ self.good, *np.log(GOOD_M)))
        return good, scipy.special.expit(standard @ self.outlier)


def design(signs: Mapping[str, NDArray], joints: Sequence[str]) -> NDArray:
    """Return the signs (P, T, 12, K) of the limbs' joints, in the order of `skeleton.JOINTS`.

    `signs` are of `error_signs.of_points` for a record with the named `joints`.
    """
    at = [list(joints).index(joint) for joint in skeleton.JOINTS]
    shape = next(iter(signs.values()))[:, :, at].shape
    part = np.array([joint.split("_")[1] for joint in skeleton.JOINTS])
    columns = [np.ones(shape), *(np.broadcast_to(part == joint, shape) for joint in JOINTS)]
    return np.stack([*columns, *(signs[name][:, :, at] for name in error_signs.NAMES)], axis=-1)


def state(
    points: Keypoints3D, model: Model, signs: Mapping[str, NDArray], *, recorded: bool = False
) -> Keypoints3D:
    """State the errors that residuals do not show: `outlier` and `covariance_network`.

    `points` are raw, with their `signs`. People who are `recorded`, not virtual, have the square of
    `RECORDED_M` more variance. Errors of joints other than those of limbs stay unknown, because the
    fit has no truth for them.
    """
    joints = points.joints.tolist()
    at = [joints.index(joint) for joint in skeleton.JOINTS]
    parts = [
        model.of(design({name: sign[:, part] for name, sign in signs.items()}, joints))
        for part in keypoints.blocks(len(points.time_s))
    ]
    good, share = (np.concatenate(each, axis=1) for each in zip(*parts, strict=True))
    covariance = points.covariance_2d[:, :, at]
    more = recorded * np.array([RECORDED_M[joint.split("_")[1]] ** 2 for joint in skeleton.JOINTS])
    own = np.trace(covariance, axis1=-2, axis2=-1) / 3 + more
    # The upper tail of chi-squared; `scipy.stats` has it too, but takes half a second to import.
    beyond = [scipy.special.chdtrc(3, OUTLIER_M**2 / (own + v)) for v in (good, model.sigma_m**2)]
    known = np.isfinite(covariance).all(axis=(-2, -1))
    outlier, network = points.outlier.copy(), points.covariance_network.copy()
    outlier[:, :, at] = np.where(known, (1 - share) * beyond[0] + share * beyond[1], np.nan)
    variance = np.where(known, stated_variance(good, share, model.sigma_m**2) + more, np.nan)
    network[:, :, at] = variance[..., None, None] * np.eye(3)
    return replace(points, outlier=outlier, covariance_network=network)


def stated_variance(
    good: NDArray, share: NDArray, outlier: float, held: float = SHARE_HELD
) -> NDArray:
    """Return the variance (N,) m2 per axis of the normal distribution stated for a mixture.

    `good` (N,) m2 is the variance of good places, `share` (N,) the probability of an outlier,
    `outlier` m2 its variance. Beyond the distance within which the stated distribution has the
    share `held`, good places alone and outliers alone have at most the rest.
    """
    rest = 1 - held
    parts = ((1 - share, good), (share, outlier))
    squares = [v * scipy.special.chdtri(3, rest / np.maximum(p, rest)) for p, v in parts]
    return np.maximum(*squares) / scipy.special.chdtri(3, rest)


def fit(columns: NDArray, error: NDArray, covariance: NDArray, weight: NDArray) -> Model:
    """Fit a model to errors (N, 3) m of joints, less the network's offset, by likelihood.

    The joints are filtered, because the model is that of errors which a filter does not remove.
    `columns` (N, K) are of `design`, `covariance` (N, 3, 3) m2 that of the keypoints' noise,
    `weight` (N,) how much each joint counts. A `ValueError` if there are fewer joints than weights.
    """
    if len(columns) < 2 * len(SIGNS):
        raise ValueError(f"expected at least {2 * len(SIGNS)} joints, found {len(columns)}")
    mean, spread = columns.mean(axis=0), columns.std(axis=0)
    constant = spread < np.finfo(float).eps
    mean, spread = np.where(constant, 0.0, mean), np.where(constant, 1.0, spread)
    standard, count = (columns - mean) / spread, columns.shape[1]
    own, axes = np.linalg.eigh(covariance)
    squares = np.einsum("nij,ni->nj", axes, error) ** 2
    start = np.zeros(2 * count + 1)
    start[[0, count, -1]] = np.log(START_M), START_LOGIT, np.log(START_OUTLIER_M)
    weight = weight / weight.sum()
    found = scipy.optimize.minimize(
        _loss, start, (standard, own, squares, weight), "L-BFGS-B", True, options={"maxiter": STEPS}
    ).x
    return Model(mean, spread, found[:count], found[count:-1], float(np.exp(found[-1])))


def _loss(weights, standard, own, squares, weight) -> tuple[float, NDArray]:
    """Return minus the mean logarithm of the likelihood, with the ridge, and its gradient."""
    count = standard.shape[1]
    good, outlier, last = weights[:count], weights[count:-1], weights[-1]
    log_m, odds = standard @ good, standard @ outlier
    inside = (log_m > np.log(GOOD_M[0])) & (log_m < np.log(GOOD_M[1]))
    variances = np.exp(2 * np.clip(log_m, *np.log(GOOD_M))), np.full(len(odds), np.exp(2 * last))
    (first, by_first), (second, by_second) = (_normal(own, squares, v) for v in variances)
    first, second = first - np.logaddexp(0, odds), second - np.logaddexp(0, -odds)
    both = np.logaddexp(first, second)
    share = np.exp(second - both)  # an outlier's, given the error
    gradient = np.concatenate(
        [
            standard.T @ (weight * (1 - share) * by_first * 2 * variances[0] * inside),
            standard.T @ (weight * (share - scipy.special.expit(odds))),
            [np.sum(weight * share * by_second * 2 * variances[1])],
        ]
    )
    ridge = np.concatenate([np.full(count, RIDGE[0]), np.full(count, RIDGE[1]), [0.0]])
    ridge[[0, count]] = 0.0
    return ridge @ weights**2 - weight @ both, 2 * ridge * weights - gradient


def _normal(own: NDArray, squares: NDArray, variance: NDArray) -> tuple[NDArray, NDArray]:
    """Return the logarithm of a normal density, without its constant, and its derivative.

    By the `variance` (N,) that is added to those along the axes, `own` (N, 3).
    """
    total = own + variance[:, None]
    log = -0.5 * (np.log(total) + squares / total).sum(axis=1)
    return log, 0.5 * (squares / total**2 - 1 / total).sum(axis=1)


def table(model: Model) -> pd.DataFrame:
    """Return a model as a table of `COLUMNS`."""
    rows = zip(SIGNS, model.mean, model.spread, model.good, model.outlier, strict=True)
    return pd.DataFrame([*rows, (LAST, 0.0, 1.0, GOOD_M[1], model.sigma_m)], columns=COLUMNS)


def read(path: StrPath) -> Model:
    """Read a CSV table of `table`; raise `InputError` if it is not one."""
    with reading(path, "a table of joint errors", REMAKE):
        rows = pd.read_csv(path, comment="#")
        found = list(rows.columns)
        names = rows.reindex(columns=COLUMNS)["sign"].tolist()
        numbers = rows.reindex(columns=COLUMNS[1:]).to_numpy(dtype=float)
    wanted = [*SIGNS, LAST]
    if found != COLUMNS or names != wanted or not np.isfinite(numbers).all():
        raise InputError(
            f"{path}: expected columns {COLUMNS} with numbers for the signs {wanted}, found "
            f"columns {found} and signs {names}; {REMAKE}"
        )
    if (numbers[:, 1] <= 0).any() or numbers[-1, -1] <= 0:
        raise InputError(f"{path}: expected spreads and sigma_m above 0, found others; {REMAKE}")
    mean, spread, good, outlier = numbers[:-1].T
    return Model(mean, spread, good, outlier, float(numbers[-1, -1]))
