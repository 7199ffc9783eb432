"""Depth of joints behind the skin that a depth camera sees, from bodies with known joints.

A lifted joint is the skin at the joint's place in the picture, moved along the viewing ray. The
depth is measured on development bodies and used for others; so is the distance by which the network
places a joint beyond the end of its limb.
"""

from collections.abc import Sequence
from itertools import product

import numpy as np
import pandas as pd
import scipy
from numpy.typing import NDArray

from courtside.depth.lifting import by_joint
from courtside.evaluation.joints import at_times
from courtside.geometry import rotations
from courtside.records.devices import clocks
from courtside.records.keypoints import skeleton
from courtside.records.truth.take_truth import TakeTruth

COLUMNS = ["joint", "skin_m", "sd_m", "n", "beyond_m", "beyond_sd_m"]


def in_camera(truth: TakeTruth, device: str, person: str, time_s: NDArray) -> NDArray:
    """Return a person's true joints at a depth camera's times (its own clock), (T, K, 3) m.

    They are in the axes of the colour camera; NaN outside the truth's span.
    """
    real = truth.devices[device]
    clock = clocks.Clock(real.offset_s, real.drift_ppm)
    when_s = clock.to_reference(np.asarray(time_s) - real.latency_s)
    at = list(map(str, truth.person_id)).index(person)
    world = at_times(truth.time_s, truth.xyz[at : at + 1], when_s)[0]
    return world @ real.from_world[:, :3].T + real.from_world[:, 3]


def estimate(
    pairs: list[tuple[NDArray, NDArray]],
    joints: Sequence[str],
    true_joints: Sequence[str],
    skin_m: dict[str, float] | None = None,
    beyond_m: dict[str, float] | None = None,
) -> pd.DataFrame:
    """Measure the depth of limb joints behind the skin, and their offset beyond the limb.

    For each joint, both sides together; the end of the limb is that of `skeleton.PARENT`.
    `ValueError` if a joint is never seen.

    `pairs` are the lifted (T, J, 3) and true (T, K, 3) skeletons of clips, in the axes of the
    camera, metres, NaN where missing; `joints` and `true_joints` name the J and the K joints.
    `skin_m` and `beyond_m` were used for lifting; by default `lifting.SKIN_TO_JOINT_M`, and 0.
    """
    used_m = by_joint(skeleton.LIMBS, skin_m)
    rows = []
    for joint, used in zip(skeleton.LIMBS, used_m, strict=True):
        deep, beyond = [], []
        for (found, true), side in product(pairs, ("left", "right")):
            place = dict(zip(joints, np.moveaxis(found, 1, 0), strict=True))
            at = place[f"{side}_{joint}"]
            off = at - true[:, list(true_joints).index(f"{side}_{joint}")]
            deep.append(used - (off * rotations.unit(at)).sum(axis=-1))
            if joint in skeleton.PARENT:
                limb = rotations.unit(at - place[f"{side}_{skeleton.PARENT[joint]}"])
                beyond.append((beyond_m or {}).get(joint, 0.0) + (off * limb).sum(axis=-1))
        depth, deep_sd, count = _spread(deep)
        if not count:
            raise ValueError(f"expected {joint} in a clip, found it in none of {len(pairs)}")
        rows.append((joint, depth, deep_sd, count, *_spread(beyond)[:2]))
    return pd.DataFrame(rows, columns=COLUMNS)


def _spread(parts: list[NDArray]) -> tuple[float, float, int]:
    """Return median, robust standard deviation and number of the known values in some arrays."""
    values = np.concatenate([[], *parts])
    values = values[np.isfinite(values)]
    if not len(values):
        return np.nan, np.nan, 0
    return np.median(values), scipy.stats.median_abs_deviation(values, scale="normal"), len(values)
