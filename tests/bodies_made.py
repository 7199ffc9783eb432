"""Body motions for tests, from paths."""

import numpy as np

from courtside.records.keypoints.body_motion import BodyMotion


def body(time_s, xyz, joints, *, source="made", unit_m=0.75, tpose_s=(0.0, 1.0), clap_s=(2.0,)):
    """Return a BodyMotion of paths (T, J, 3) in body units, the same in both frames."""
    return BodyMotion(
        source=source,
        kind="rgb",
        joints=np.array(joints),
        time_s=np.asarray(time_s, float),
        fixed=np.asarray(xyz, float),
        following=np.asarray(xyz, float),
        reason=np.zeros(np.shape(xyz)[:2], np.uint8),
        unit_m=unit_m,
        tpose_s=np.array(tpose_s, float),
        clap_s=np.array(clap_s, float),
    )
