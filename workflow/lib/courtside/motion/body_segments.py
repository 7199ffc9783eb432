"""Which joints of a skeleton turn and stretch together when it is corrected."""

from dataclasses import dataclass

import numpy as np

from courtside.records import limbs
from courtside.study.errors import InputError

SIDES = ("left", "right")
LIMBS = {  # segment: (joint it begins at, joint it ends at)
    "upper_arm": ("shoulder", "elbow"),
    "forearm": ("elbow", "wrist"),
    "thigh": ("hip", "knee"),
    "shank": ("knee", "ankle"),
}


@dataclass(frozen=True, eq=False)
class Segments:
    """How corrections of segments reach the joints of a skeleton.

    Attributes
    ----------
    names : tuple of str, length G
        `pelvis`, `thorax`, `left_clavicle`, `left_upper_arm`, ...
    share : (J, G) float
        Share of a segment's correction that a joint's frame takes; joints whose row is zero keep their
        rotation against their parent.
    stretches : tuple of str, length B
        `body` (all bones), `upper_arm` (both sides), `upper_arm difference` (left minus right, halved), ...
    stretch : (J, B) float
        Share of each in the logarithm of the factor on the bone that ends at a joint.
    """

    names: tuple
    share: np.ndarray
    stretches: tuple
    stretch: np.ndarray

    @property
    def turned(self):
        """(J,) bool: joints whose frame is corrected itself, not only carried along."""
        return self.share.any(axis=1)

    def kind(self, segment):
        """Return the name of a segment without its side."""
        return segment.removeprefix("left_").removeprefix("right_")


def path(hierarchy, joint):
    """Return the indices of joints from the root to `joint`, both included."""
    found = [joint]
    while hierarchy.parents[found[0]] >= 0:
        found.insert(0, int(hierarchy.parents[found[0]]))
    return found


def segments_of(hierarchy, where="skeleton"):
    """Find the segments of a skeleton that names its limbs' joints as the study does.

    Parameters
    ----------
    hierarchy : courtside.records.hierarchy.Hierarchy
        Holds `left_shoulder`, `left_elbow`, `left_wrist`, `left_hip`, `left_knee`, `left_ankle` and the
        right ones; between the root and the shoulders any number of joints of the spine and clavicles.
    where : str
        Begins the line of an error.

    Returns
    -------
    segments : Segments
        The spine's joints share the corrections of pelvis and thorax by their place between them.

    Raises
    ------
    InputError
        If a joint is missing or is not below the one it should hang from.
    """
    joints = list(hierarchy.joints)
    missing = [name for name in limbs.JOINTS if name not in joints]
    if missing:
        raise InputError(
            f"{where}: expected a joint {missing[0]}, found {', '.join(joints[:8])}, ...; "
            "name its joints by a map of config/skeletons"
        )
    paths = {name: path(hierarchy, joints.index(name)) for name in limbs.JOINTS}
    parts = _trunk(paths) | _limbs(paths, joints, where)
    share = np.zeros((len(joints), len(parts)))
    for column, members in enumerate(parts.values()):
        for joint, part in members:
            share[joint, column] = part
    stretches = _stretches(paths, joints)
    stretch = np.zeros((len(joints), len(stretches)))
    for column, members in enumerate(stretches.values()):
        for joint, part in members:
            stretch[joint, column] = part
    return Segments(tuple(parts), share, tuple(stretches), stretch)


def _spine(paths):
    """Return the joints from the root to the last that both shoulders hang from."""
    both = zip(paths["left_shoulder"], paths["right_shoulder"], strict=False)
    return [left for left, right in both if left == right]


def _trunk(paths):
    spine = _spine(paths)
    along = np.linspace(0, 1, len(spine)) if len(spine) > 1 else np.zeros(1)
    parts = {"pelvis": [(joint, 1 - part) for joint, part in zip(spine, along, strict=True)]}
    if len(spine) > 1:
        parts["thorax"] = list(zip(spine, along, strict=True))
    for side in SIDES:
        girdle = paths[f"{side}_shoulder"][len(spine) : -1]
        if girdle:
            parts[f"{side}_clavicle"] = [(joint, 1.0) for joint in girdle]
    return parts


def _limbs(paths, joints, where):
    parts = {}
    for side in SIDES:
        for name, (start, stop) in LIMBS.items():
            start, stop = f"{side}_{start}", f"{side}_{stop}"
            if joints.index(start) not in paths[stop]:
                raise InputError(
                    f"{where}: expected {stop} below {start}, found it below "
                    f"{joints[paths[stop][-2]]}; mend the map of joint names"
                )
            below = paths[stop][len(paths[start]) - 1 : -1]
            parts[f"{side}_{name}"] = [(joint, 1.0) for joint in below]
    return parts


def _stretches(paths, joints):
    spine = _spine(paths)
    found = {"body": [(joint, 1.0) for joint in range(len(joints))]}
    found["trunk"] = [(joint, 1.0) for joint in spine[1:]]
    bones = {"girdle": len(spine), "pelvis": 1} | dict.fromkeys(LIMBS)
    ends = {"girdle": "shoulder", "pelvis": "hip"} | {name: LIMBS[name][1] for name in LIMBS}
    for name, end in ends.items():
        members = {}
        for side in SIDES:
            first = bones[name] or len(paths[f"{side}_{LIMBS[name][0]}"])
            members[side] = paths[f"{side}_{end}"][first:]
        found[name] = [(joint, 1.0) for side in SIDES for joint in members[side]]
        found[f"{name} difference"] = [(j, 0.5) for j in members["left"]]
        found[f"{name} difference"] += [(j, -0.5) for j in members["right"]]
    return found
