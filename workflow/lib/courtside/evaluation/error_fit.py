"""What the model of joint errors is fitted on: development players, seen by fewer cameras too."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.evaluation import joints
from courtside.evaluation.joints import Truth
from courtside.reconstruction import error_signs, fusion, joint_correction, joint_errors
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints import skeleton as limbs
from courtside.records.keypoints.skeleton import Skeleton

# ASSUME: weight of a joint by the number of cameras of its set: all sets of four cameras of one
# size together count about as much as the one of four.
WEIGHT = {2: 0.25, 3: 0.4}


def joints_of(
    seen: Sequence[Footage],
    skeleton: Skeleton,
    sex_of: Mapping[str, str | None],
    table: pd.DataFrame | None,
    truth: Truth,
    options: Mapping[str, Any],
) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Return what `joint_errors.fit` needs of one take and set of cameras.

    Columns (N, K), errors less the network's offset (N, 3) m, covariance (N, 3, 3) m2 and weights
    (N,) of the limbs' joints that are placed and true. `table` holds the offsets; None, where a
    network has none, leaves them in the errors. `options` are those of the triangulation.
    """
    cameras, views = [one.camera for one in seen], [one.view for one in seen]
    clocks = [one.clock for one in seen]
    raw = fusion.triangulate_take(cameras, views, skeleton, list(sex_of), clocks=clocks, **options)
    xy, score = error_signs.keypoints_used(views, clocks, raw, skeleton)
    signs = error_signs.of_points(cameras, raw, xy, score, skeleton)
    placed = raw
    if table is not None:
        placed = replace(raw, xyz=raw.xyz - joint_correction.offsets(raw, table, sex_of))
    names, error, _ = joints.errors(placed, truth.joints.tolist(), joints.true_places(raw, truth))
    error = error[:, :, [names.index(joint) for joint in limbs.JOINTS]]
    at = [raw.joints.tolist().index(joint) for joint in limbs.JOINTS]
    covariance, columns = (
        raw.covariance_2d[:, :, at],
        joint_errors.design(signs, raw.joints.tolist()),
    )
    known = np.isfinite(error).all(axis=-1) & np.isfinite(covariance).all(axis=(-2, -1))
    weight = np.full(int(known.sum()), WEIGHT.get(len(seen), 1.0))
    return columns[known], error[known], covariance[known], weight
