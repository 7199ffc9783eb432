"""How often ellipsoids of joints and intervals of measures hold the truth; flags of outliers."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import scipy
from numpy.typing import NDArray

from courtside.evaluation import joints
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.statistics.normal_errors import ellipsoid, mahalanobis

LEVELS = (10, 20, 30, 40, 50, 60, 70, 80, 90, 95, 99)  # percent: nominal shares
HELD = [f"held_{level}" for level in LEVELS]
COUNTS = ["n", *HELD, "n_large", "n_flagged", "n_flagged_large"]
SIZES_MM = (0, 50, 100, 300)  # lower ends of the groups by size of the error
MOST_VIEWS = 4  # more count as these
FLAGGED = 0.5  # a joint is flagged if it is more probably an outlier than not


def counts(points: Keypoints3D, names: Sequence[str], true_xyz: NDArray) -> pd.DataFrame:
    """Count the limbs' joints whose error lies in their ellipsoids, by groups.

    `names` are those of the true joints, `true_xyz` (P, T, K, 3) m: at the record's times. A row
    for all joints and for each joint, size of the error and number of views (`by`, `group`): `n`
    joints with truth and covariance; `held_90` of them in the ellipsoid that should hold 90 %, and
    so on; `n_large` with an error above 100 mm, `n_flagged` as outliers, `n_flagged_large` with
    both.
    """
    found, error, covariance = joints.errors(points, names, true_xyz)
    limbs = [at for at, name in enumerate(found) if name in skeleton.JOINTS]
    own = [points.joints.tolist().index(found[at]) for at in limbs]
    error, covariance = error[:, :, limbs], covariance[:, :, limbs]
    known = np.isfinite(error).all(axis=-1) & np.isfinite(covariance).all(axis=(-2, -1))
    part = np.array([found[at].split("_")[1] for at in limbs])
    rows = _rows(error[known], covariance[known], points.outlier[:, :, own][known])
    rows["all"] = "limbs"
    rows["joint"] = np.broadcast_to(part, known.shape)[known]
    rows["views"] = np.minimum(points.n_views[:, :, own][known], MOST_VIEWS)
    groups = [
        rows.groupby(by)[COUNTS].sum().rename_axis("group").reset_index().assign(by=by)
        for by in ("all", "joint", "error", "views")
    ]
    whole = pd.concat(groups, ignore_index=True)
    whole["group"] = whole["group"].astype(str)
    return whole[["by", "group", *COUNTS]]


def _rows(error: NDArray, covariance: NDArray, outlier: NDArray) -> pd.DataFrame:
    """Return one row for each joint, with ones and zeros in `COUNTS`."""
    distance = mahalanobis(error, covariance)
    size_m = np.linalg.norm(error, axis=1)
    large, flagged = size_m > joints.LARGE_M, outlier > FLAGGED
    held = {
        name: distance <= ellipsoid(level / 100) for name, level in zip(HELD, LEVELS, strict=True)
    }
    numbers = {"n": np.ones(len(error)), **held, "n_large": large, "n_flagged": flagged}
    numbers["n_flagged_large"] = large & flagged
    size = np.array(SIZES_MM)[np.searchsorted(SIZES_MM, 1000 * size_m, side="right") - 1]
    return pd.DataFrame(numbers).astype(int).assign(error=size)


def of_measures(found: Mapping[str, tuple[NDArray, NDArray]]) -> pd.DataFrame:
    """Count the values of measures that lie in their intervals, with the columns of `counts`.

    `found` gives for each measure the errors and their stated standard deviations, (N,) each; those
    without either are left out. A row for each measure, `by` of "measure".
    """
    rows = []
    for name, (error, sigma) in found.items():
        known = np.isfinite(error) & np.isfinite(sigma)
        ratio = np.abs(error[known]) / sigma[known]
        held = {
            key: int((ratio <= _half_width(k)).sum()) for key, k in zip(HELD, LEVELS, strict=True)
        }
        rows.append({"by": "measure", "group": name, "n": int(known.sum()), **held})
    return pd.DataFrame(rows).reindex(columns=["by", "group", *COUNTS], fill_value=0)


def _half_width(level: int) -> float:
    """Return half the interval that holds a share, in percent, of normal errors, in sigmas."""
    return float(scipy.special.ndtri((1 + level / 100) / 2))


def pooled(rows: pd.DataFrame, keys: Sequence[str]) -> pd.DataFrame:
    """Add up tables of `counts` by keys, and say shares in percent.

    `held_90_percent` and so on; `precision_percent` and `recall_percent` of the flag for errors
    above 100 mm, empty where none is flagged or none is as large.
    """
    found = rows.groupby([*keys, "by", "group"], sort=False)[COUNTS].sum().reset_index()
    for name in HELD:
        found[f"{name}_percent"] = 100 * found.pop(name) / found["n"]
    for name, of in (("precision", "n_flagged"), ("recall", "n_large")):
        share = found["n_flagged_large"] / found[of].replace(0, np.nan)
        found[f"{name}_percent"] = 100 * share
    return found
