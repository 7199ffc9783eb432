"""The record of a device for the fit of the skeletal model: uniform times, errors by joint."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from courtside.body_model import segments
from courtside.geometry import interpolation
from courtside.records.keypoints import missing_reason, skeleton
from courtside.records.keypoints.keypoints import Keypoints3D

EVEN_S = 5e-5  # ASSUME: a deviation from uniform times that has no effect
# ASSUME: where a joint cannot be interpolated, a frame this near stands for it: stamps in
# milliseconds are off by as much, and a wrist at 10 m/s moves by 10 mm.
STANDS_FOR_S = 1e-3
LONGEST_STEPS = 2.5  # longest gap that is interpolated, in steps: one missing frame


def observed(points: Keypoints3D, sigma_m: Mapping[str, float]) -> Keypoints3D:
    """Return the joints of the model at uniform times, with stated errors.

    `points` are of one device, without errors. `sigma_m` are standard deviations per axis by limb
    joint without its side, `knee` for both knees. The whole error is taken as noise, because errors
    that are common to many frames cannot be separated. Errors of other joints stay unknown.
    """
    points = even(points)
    on = [at for at, joint in enumerate(points.joints.tolist()) if segments.segment_of(joint)]
    points = points.some_joints(on)
    parts = [skeleton.without_side(joint) for joint in points.joints.tolist()]
    stated = np.isin(parts, list(sigma_m))[:, None, None] & np.ones((3, 3), bool)
    variance = np.square([sigma_m.get(part, 0.0) for part in parts])[:, None, None] * np.eye(3)
    known = np.isfinite(points.xyz).all(axis=-1)[..., None, None]
    return replace(
        points,
        covariance_2d=np.where(known, variance, np.nan),
        covariance_network=np.where(known & stated, 0.0, np.nan),
    )


def even(points: Keypoints3D) -> Keypoints3D:
    """Return the record of one device at uniform times, from its first frame to its last.

    The step is the time between two frames. Positions between frames are interpolated, across one
    missing frame at most, or else those of a frame within `STANDS_FOR_S`: neighbours of a missing
    joint stay. All other values are those of the nearest frame.
    """
    time_s = points.time_s
    if len(time_s) < 3:
        return points
    step_s = interpolation.frame_step_s(time_s)
    count = round((time_s[-1] - time_s[0]) / step_s) + 1
    wanted_s = np.linspace(time_s[0], time_s[-1], count)
    if count == len(time_s) and np.abs(wanted_s - time_s).max() <= EVEN_S:
        return points
    taken = points.frames(interpolation.nearest(time_s, wanted_s))
    longest_s = LONGEST_STEPS * step_s
    xyz = np.stack([interpolation.between(time_s, one, wanted_s, longest_s) for one in points.xyz])
    near = np.abs(taken.time_s - wanted_s) <= STANDS_FOR_S
    xyz = np.where(near[:, None, None] & np.isnan(xyz), taken.xyz, xyz)
    lost = np.isnan(xyz[..., 0]) & (taken.reason == missing_reason.OK)
    reason = np.where(lost, missing_reason.UNSEEN, taken.reason).astype(points.reason.dtype)
    return replace(taken, time_s=wanted_s, xyz=xyz, reason=reason)
