"""Where a network places joints, against the joint centres of the virtual body's rig.

A network is trained on what people clicked, not on bones: its hips lie lower, its shoulders higher. That
offset moves with the body. It is fitted on development bodies and clips as a sum of vectors that the
skeleton itself gives, and subtracted elsewhere.
"""

from dataclasses import replace

import numpy as np
import pandas as pd

from courtside.study.errors import InputError

JOINTS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")  # of both sides
PARENTS = {  # the bones next to a joint, from the trunk outwards: (from, to)
    "shoulder": (("shoulder", "elbow"),),
    "elbow": (("shoulder", "elbow"), ("elbow", "wrist")),
    "wrist": (("elbow", "wrist"),),
    "hip": (("hip", "knee"),),
    "knee": (("hip", "knee"), ("knee", "ankle")),
    "ankle": (("knee", "ankle"),),
}
TRUNK = ("out", "up", "forward")  # names of the trunk's vectors, each as long as the trunk
RIDGE = 1e-3  # of the mean square of the vectors: what the clips do not show stays near zero
COLUMNS = ["joint", "vector", "share", "sigma_m", "n"]


def vectors(xyz, joints, side, joint):
    """Return the vectors that a joint's offset may be made of.

    Parameters
    ----------
    xyz : (..., J, 3) float
        Skeletons in the world, metres.
    joints : sequence of str
        Names of J joints.
    side : str
        "left" or "right"
    joint : str
        One of `JOINTS`.

    Returns
    -------
    basis : dict of str to (..., 3) float
        Trunk axes of the trunk's length (`out`: to the joint's own side; `up`; `forward`), and the bones
        beside the joint, `shoulder-elbow` and so on, from the trunk outwards; metres.
    """
    at = {name: xyz[..., list(joints).index(name), :] for name in _names()}
    hips, shoulders = (
        (at[f"left_{part}"] + at[f"right_{part}"]) / 2 for part in ("hip", "shoulder")
    )
    up = shoulders - hips
    length = np.linalg.norm(up, axis=-1, keepdims=True)
    across = (at["left_shoulder"] - at["right_shoulder"]) + (at["left_hip"] - at["right_hip"])
    forward = np.cross(across, up)
    forward = forward / np.linalg.norm(forward, axis=-1, keepdims=True)
    left = np.cross(up, forward)  # as long as the trunk
    out = left if side == "left" else -left
    found = dict(zip(TRUNK, (out, up, forward * length), strict=True))
    for start, stop in PARENTS[joint]:
        found[f"{start}-{stop}"] = at[f"{side}_{stop}"] - at[f"{side}_{start}"]
    return found


def estimate(pairs, joints):
    """Fit the offsets on skeletons whose true joints are known.

    Parameters
    ----------
    pairs : list of ((T, J, 3) float, (T, J, 3) float)
        Estimated and true skeletons of clips, metres; NaN where either is missing.
    joints : sequence of str
        Names of the J joints.

    Returns
    -------
    table : pandas.DataFrame
        `COLUMNS`: for each joint (both sides together) and vector its share; sigma_m, what remains per
        axis; n, how many joints it rests on.

    Raises
    ------
    ValueError
        If a joint is never seen.
    """
    rows = []
    for joint in JOINTS:
        design, offset = [], []
        for found, true in pairs:
            for side in ("left", "right"):
                at = list(joints).index(f"{side}_{joint}")
                basis = np.stack(list(vectors(found, joints, side, joint).values()), axis=-1)
                difference = found[:, at] - true[:, at]
                known = np.isfinite(difference).all(axis=-1) & np.isfinite(basis).all(axis=(-2, -1))
                design.append(basis[known].reshape(-1, basis.shape[-1]))
                offset.append(difference[known].reshape(-1))
        design, offset = np.concatenate(design), np.concatenate(offset)
        if not len(offset):
            raise ValueError(f"expected {joint} in a clip, found it in none of {len(pairs)}")
        shares, sigma_m = _fit(design, offset)
        names = [*TRUNK, *(f"{start}-{stop}" for start, stop in PARENTS[joint])]
        n = len(offset) // 3
        rows += [
            (joint, name, share, sigma_m, n) for name, share in zip(names, shares, strict=True)
        ]
    return pd.DataFrame(rows, columns=COLUMNS)


def correct(points, table):
    """Subtract the offsets from the limb joints of a record.

    Parameters
    ----------
    points : Keypoints3D
    table : pandas.DataFrame
        As `estimate` returns it.

    Returns
    -------
    corrected : Keypoints3D
        Joints without a row are as they were. A joint's offset needs shoulders, hips and the joint's own
        limb; where one of them is missing the joint keeps its place, and so its offset. What a corrected
        joint's offset leaves unexplained is added to its `covariance_2d`.
    """
    joints, xyz = list(points.joints), points.xyz.copy()
    covariance = points.covariance_2d.copy()
    for joint, rows in table.groupby("joint"):
        for side in ("left", "right"):
            at = joints.index(f"{side}_{joint}")
            basis = vectors(points.xyz, joints, side, joint)
            offset = sum(basis[row.vector] * row.share for row in rows.itertuples())
            known = np.isfinite(offset).all(axis=-1)
            xyz[..., at, :] -= np.where(known[..., None], offset, 0.0)
            covariance[..., at, :, :] += rows["sigma_m"].iloc[0] ** 2 * np.eye(3)
    return replace(points, xyz=xyz, covariance_2d=covariance)


def read(path):
    """Read a table of offsets.

    Parameters
    ----------
    path : str or Path
        CSV with `COLUMNS`.

    Raises
    ------
    InputError
        If it is none.
    """
    try:
        table = pd.read_csv(path, comment="#")
        found = list(table.columns)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: expected a table of joint offsets, found {error}") from None
    known = {
        (joint, vector)
        for joint in JOINTS
        for vector in (*TRUNK, *(f"{start}-{stop}" for start, stop in PARENTS[joint]))
    }
    if found != COLUMNS or not set(zip(table["joint"], table["vector"], strict=True)) <= known:
        raise InputError(
            f"{path}: expected columns {COLUMNS} with joints of {JOINTS}, found columns {found} and joints "
            f"{sorted(set(table.get('joint', [])))}; make it anew with the rule evaluate_joint_offsets"
        )
    return table


def _names():
    return [f"{side}_{joint}" for side in ("left", "right") for joint in JOINTS]


def _fit(design, offset):
    normal = design.T @ design
    normal[np.diag_indices_from(normal)] += RIDGE * np.trace(normal) / len(normal)
    shares = np.linalg.solve(normal, design.T @ offset)
    residual = offset - design @ shares
    return shares, float(np.sqrt(np.mean(residual**2)))
