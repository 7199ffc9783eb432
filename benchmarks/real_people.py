"""What hall_markers.py and correct_real_footage.py say of recorded people: the table `real-people`.

Joints, lengths and angles of all stages, beside joints that another method put into the same
pictures. No such reference is the truth, and no parameter is chosen by these numbers.
"""

import sys

import numpy as np

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.kinematics import joint_angles, shared_errors
from courtside.records.keypoints import keypoints, skeleton

SIDES = ("left", "right")
PARTS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
SEGMENTS = {
    "upper arm": ("shoulder", "elbow"),
    "forearm": ("elbow", "wrist"),
    "thigh": ("hip", "knee"),
    "shank": ("knee", "ankle"),
}


def limbs(path):
    """Return the limb joints (T, 12, 3) m of the first person of a file of 3D keypoints."""
    points = keypoints.read_3d(path)
    return points.xyz[0][:, [points.joints.tolist().index(name) for name in skeleton.JOINTS]]


def _both(xyz, part):
    """Return the joints (2, T, 3) of the left and the right side."""
    return np.stack([xyz[:, skeleton.JOINTS.index(f"{side}_{part}")] for side in SIDES])


def lengths_mm(xyz, ends):
    """Return the lengths (2, T) mm of a segment between two of `PARTS`, left and right."""
    first, second = (_both(xyz, part) for part in ends)
    return 1e3 * np.linalg.norm(first - second, axis=-1)


def angles_deg(xyz):
    """Return the angles (T,) of `joint_angles.measure`, by name."""
    none = shared_errors.independent(np.zeros((*xyz.shape, 3)))
    return {
        name: angle.degrees
        for name, angle in joint_angles.measure(xyz, none, skeleton.JOINTS).items()
    }


def measures(xyz, other):
    """Return {(measure, unit): (values, two numbers of them)} of limb joints (T, 12, 3) m."""
    found = {}
    for part in PARTS:
        apart = 1e3 * np.linalg.norm(_both(xyz, part) - _both(other, part), axis=-1)
        two = np.nanpercentile(apart, (50, 90))
        found[f"{part}s, distance, median / 90 %, mm", "mm"] = apart, two
    for name, ends in SEGMENTS.items():
        length = lengths_mm(xyz, ends)
        two = np.nanmedian(length), np.nanstd(length)
        found[f"{name}s, length, median / sd, mm", "mm"] = length, two
    true = angles_deg(other)
    for name, angle in angles_deg(xyz).items():
        apart = angle - true[name]
        two = np.nanmean(apart), np.sqrt(np.nanmean(apart**2))
        words = f"{name.replace('_', ' ')}, mean difference / RMSE, degrees"
        found[words, "degrees"] = apart, two
    return found


def rows(where, session, stages, other, command):
    """Yield rows of docs/numbers of the stages {word: (T, 12, 3) m} against the other joints.

    `where` names the recording and the reference, whose own lengths are given, too.
    """
    for stage, xyz in {**stages, "reference": other}.items():
        for (words, unit), (values, two) in measures(xyz, other).items():
            if stage == "reference" and "length" not in words:
                continue
            known, form = np.isfinite(values), "+.1f" if unit == "degrees" else ".0f"
            counts = (int(known.sum()), int((~known).sum()), "benchmark", command)
            about = unit, session, *counts
            label = f"{where}: {words}"
            yield ["real-people", label, f"{stage}_first", f"{two[0]:{form}}", *about]
            yield ["real-people", label, f"{stage}_second", f"{two[1]:{form.strip('+')}}", *about]
