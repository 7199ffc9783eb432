"""A body in its own axes whose straight arms swing from the T-pose to a clap, as tables for figures."""

import numpy as np
import pandas as pd

from courtside.kinematics import wrist_arcs
from courtside.records.keypoints.body_motion import BodyMotion

HALF_SHOULDERS, ARM = 0.3, 0.7  # units: the wrists of the T-pose are at 1
CLAP_S = 2.0
JOINTS = [f"{side}_{part}" for part in ("shoulder", "wrist") for side in ("left", "right")]


def body(source="mocopi", kind="inertial", depth=1.0, rate_hz=60.0, unit_m=0.75):
    """Return a T-pose until 1 s, and both arms forwards until they meet at 2 s; `depth` multiplies z."""
    time_s = np.arange(0, CLAP_S + 1e-9, 1 / rate_hz)
    meet = np.arccos(-HALF_SHOULDERS / ARM)
    turn = meet * np.clip(time_s - 1, 0, 1)
    xyz = np.zeros((len(time_s), 4, 3))
    for at, sign in enumerate((1, -1)):
        xyz[:, at] = (sign * HALF_SHOULDERS, 0.5, 0)
        xyz[:, at + 2, 0] = sign * (HALF_SHOULDERS + ARM * np.cos(turn))
        xyz[:, at + 2, 1] = 0.5
        xyz[:, at + 2, 2] = depth * ARM * np.sin(turn)
    reason = np.zeros(xyz.shape[:2], np.uint8)
    spans = np.array([0.0, 1.0]), np.array([CLAP_S])
    return BodyMotion(source, kind, np.array(JOINTS), time_s, xyz, xyz, reason, unit_m, *spans)


def tables(bodies, sparc=-1.6):
    """Return (paths, distortion) as the rule that measures arcs writes them."""
    found = {one.source: (one, wrist_arcs.arcs(one)) for one in bodies}
    paths = [wrist_arcs.paths(arc).assign(source=name) for name, (_, arc) in found.items()]
    distortion = [
        wrist_arcs.distortion(arc).assign(source=name, unit_m=one.unit_m, sparc=sparc)
        for name, (one, arc) in found.items()
    ]
    return pd.concat(paths, ignore_index=True), pd.concat(distortion, ignore_index=True)
