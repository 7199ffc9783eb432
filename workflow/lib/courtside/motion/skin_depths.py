"""How deep joints lie behind the skin that a depth camera sees, from bodies whose joints are known.

A lifted joint is the skin at the joint's place in the picture, moved along the viewing ray. How far it has to
be moved is measured on development bodies and used for others.
"""

import numpy as np
import pandas as pd

from courtside.geometry import transforms
from courtside.motion.depth_lift import SKIN_TO_JOINT_M, by_joint
from courtside.motion.pose_errors import at_times
from courtside.records import limbs, sync

COLUMNS = ["joint", "skin_m", "sd_m", "n"]
NORMAL_SPREAD = 1.4826  # standard deviation over median distance from the median, of normal errors


def in_camera(truth, device, person, time_s):
    """Return where a person's joints really were when a depth camera saw them.

    Parameters
    ----------
    truth : courtside.records.take_truth.TakeTruth
    device, person : str
    time_s : (T,) float
        On the device's own clock.

    Returns
    -------
    xyz : (T, K, 3) float
        Metres, in the axes of the colour camera; NaN outside the truth's span.
    """
    real = truth.devices[device]
    clock = sync.Clock(real.offset_s, real.drift_ppm)
    when_s = clock.to_reference(np.asarray(time_s) - real.latency_s)
    at = list(map(str, truth.person_id)).index(person)
    world = at_times(truth.time_s, truth.xyz[at : at + 1], when_s)[0]
    return world @ real.from_world[:, :3].T + real.from_world[:, 3]


def estimate(pairs, joints, true_joints, skin_m=None):
    """Measure how deep the joints of the limbs lie.

    Parameters
    ----------
    pairs : list of ((T, J, 3) float, (T, K, 3) float)
        Lifted and true skeletons of clips, in the axes of the camera, metres; NaN where missing.
    joints, true_joints : sequence of str
        Names of the J and of the K joints.
    skin_m : dict of str to float, optional
        With which they were lifted; `depth_lift.SKIN_TO_JOINT_M` by default.

    Returns
    -------
    table : pandas.DataFrame
        `COLUMNS`: for each joint, both sides together, the median of its depth behind the skin along the
        viewing ray and its robust standard deviation, metres; n, how many it rests on.

    Raises
    ------
    ValueError
        If a joint is never seen.
    """
    used_m = by_joint(limbs.LIMBS, SKIN_TO_JOINT_M if skin_m is None else skin_m)
    rows = []
    for joint, used in zip(limbs.LIMBS, used_m, strict=True):
        names = [f"{side}_{joint}" for side in ("left", "right")]
        deep = np.concatenate([
            used + _behind(found[:, list(joints).index(name)], true[:, list(true_joints).index(name)])
            for found, true in pairs
            for name in names
        ])  # fmt: skip
        deep = deep[np.isfinite(deep)]
        if not len(deep):
            raise ValueError(f"expected {joint} in a clip, found it in none of {len(pairs)}")
        middle = np.median(deep)
        rows.append((joint, middle, NORMAL_SPREAD * np.median(np.abs(deep - middle)), len(deep)))
    return pd.DataFrame(rows, columns=COLUMNS)


def _behind(found, true):
    """Return how far true points (T, 3) are behind found ones, along the ray through the latter, (T,)."""
    return ((true - found) * transforms.unit(found)).sum(axis=-1)
