"""Means over a take of the motion of each joint, for the comparison of networks."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.statistics import longitudinal

HIPS = ("left_hip", "right_hip")


def table(points: Keypoints3D, label: Mapping[str, str]) -> pd.DataFrame:
    """Measure every joint of a take independently of its position and direction.

    The points must be filtered, because noise lengthens a path. `label` is as for
    `longitudinal.read`, without model. `longitudinal.COLUMNS`: mean height above the floor (mm),
    mean speed (m/s, between neighbouring frames), and mean distance to the middle of the hips (mm),
    over the frames that have them.
    """
    names = list(map(str, points.joints))
    middle = points.xyz[:, :, [names.index(hip) for hip in HIPS]].mean(axis=2, keepdims=True)
    step_m = np.linalg.norm(np.diff(points.xyz, axis=1), axis=-1)
    found = {
        ("height", "mm"): 1000 * points.xyz[..., 2],
        ("speed", "m/s"): step_m / np.diff(points.time_s)[:, None],
        ("reach", "mm"): 1000 * np.linalg.norm(points.xyz - middle, axis=-1),
    }
    rows = [
        (str(person), f"{joint}_{what}_mean", pd.Series(values[at, :, place]).mean(), unit)
        for at, person in enumerate(points.person_id)
        for place, joint in enumerate(names)
        for (what, unit), values in found.items()
    ]
    table = pd.DataFrame(rows, columns=["person", "measure", "value", "unit"])
    return longitudinal.labelled(table, {**label, "model": points.model})
