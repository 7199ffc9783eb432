"""Bodies too large or too small for people: the scale of the calibration is wrong.

Two cameras agree on everybody, whatever the distance between them, if one is displaced towards the
other or away from it: rays still meet, but bodies become larger or smaller.
"""

from collections.abc import Mapping

import numpy as np

from courtside.calibration.people import metric_scale
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D

# ASSUME: of a stated height. In 59 virtual takes, by four networks, heights by raw joints were
# 0.946 to 1.030 of those stated.
MOST_OFF = 0.15
USUAL_M = (1.0, 2.3)  # ASSUME: heights of people of whom none is stated, children included


def measured_m(points: Keypoints3D) -> dict[str, float]:
    """Return the height of each person by the median lengths of leg and trunk, m.

    Persons of whom too few joints are placed are left out.
    """
    names = [str(joint) for joint in points.joints]
    if not set(skeleton.JOINTS) <= set(names):
        return {}
    at = [names.index(joint) for joint in skeleton.JOINTS]
    heights = {
        str(person): metric_scale.length(xyz[:, at]) / metric_scale.SEEN.mean
        for person, xyz in zip(points.person_id, points.xyz, strict=True)
    }
    return {person: height for person, height in heights.items() if np.isfinite(height)}


def doubt(points: Keypoints3D, stated_m: Mapping[str, float | None]) -> str:
    """Return in one line that nobody has a possible height, empty if somebody has or none is known.

    `stated_m` by person; None where the session states none.
    """
    found, off = measured_m(points), []
    for person, height_m in found.items():
        stated = stated_m.get(person)
        low, high = ((1 - MOST_OFF) * stated, (1 + MOST_OFF) * stated) if stated else USUAL_M
        if low <= height_m <= high:
            return ""
        usual = f"stated: {stated:.2f}" if stated else f"usual: {low} to {high}"
        off.append(f"{person} {height_m:.2f} m tall ({usual} m)")
    if not off:
        return ""
    return (
        f"expected people of their own height, found {', '.join(off)}: the distance between "
        "cameras or the size of the court is wrong, as where cameras are clicked on two courts, or "
        "with the file of another court; or stated heights are wrong"
    )
