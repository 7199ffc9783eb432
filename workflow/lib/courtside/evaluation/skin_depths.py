"""How deep joints lie behind the skin that a depth camera sees, from bodies whose joints are known.

A lifted joint is the skin at the joint's place in the picture, moved along the viewing ray. How far it has to
be moved is measured on development bodies and used for others; so is how far the network places it beyond the
end of its limb.
"""

from itertools import product

import numpy as np
import pandas as pd

from courtside.depth.lifting import SKIN_TO_JOINT_M, by_joint
from courtside.evaluation.joints import at_times
from courtside.geometry import rotations
from courtside.records.devices import clocks
from courtside.records.keypoints import skeleton

COLUMNS = ["joint", "skin_m", "sd_m", "n", "beyond_m", "beyond_sd_m"]
NORMAL_SPREAD = 1.4826  # standard deviation over median distance from the median, of normal errors


def in_camera(truth, device, person, time_s):
    """Return where a person's joints really were when a depth camera saw them.

    Parameters
    ----------
    truth : courtside.records.truth.take_truth.TakeTruth
    device, person : str
    time_s : (T,) float
        On the device's own clock.

    Returns
    -------
    xyz : (T, K, 3) float
        Metres, in the axes of the colour camera; NaN outside the truth's span.
    """
    real = truth.devices[device]
    clock = clocks.Clock(real.offset_s, real.drift_ppm)
    when_s = clock.to_reference(np.asarray(time_s) - real.latency_s)
    at = list(map(str, truth.person_id)).index(person)
    world = at_times(truth.time_s, truth.xyz[at : at + 1], when_s)[0]
    return world @ real.from_world[:, :3].T + real.from_world[:, 3]


def estimate(pairs, joints, true_joints, skin_m=None, beyond_m=None):
    """Measure how deep the joints of the limbs lie, and how far beyond their limbs they are placed.

    Parameters
    ----------
    pairs : list of ((T, J, 3) float, (T, K, 3) float)
        Lifted and true skeletons of clips, in the axes of the camera, metres; NaN where missing.
    joints, true_joints : sequence of str
        Names of the J and of the K joints.
    skin_m : dict of str to float, optional
        With which they were lifted; `lifting.SKIN_TO_JOINT_M` by default.
    beyond_m : dict of str to float, optional
        With which they were lifted; 0 where absent.

    Returns
    -------
    table : pandas.DataFrame
        `COLUMNS`: for each joint, both sides together, the median of its depth behind the skin along the
        viewing ray and its robust standard deviation, metres; n, how many it rests on; and of how far it is
        placed beyond the end of its limb (`skeleton.PARENT`), NaN for shoulder and hip.

    Raises
    ------
    ValueError
        If a joint is never seen.
    """
    used_m = by_joint(skeleton.LIMBS, SKIN_TO_JOINT_M if skin_m is None else skin_m)
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


def _spread(parts):
    """Return the median of what is known in some arrays, its robust standard deviation, how many it is."""
    values = np.concatenate([[], *parts])
    values = values[np.isfinite(values)]
    if not len(values):
        return np.nan, np.nan, 0
    middle = np.median(values)
    return middle, NORMAL_SPREAD * np.median(np.abs(values - middle)), len(values)
