"""Mocopi's 27 joints in a virtual body: hierarchy, and true rotations.

Names, order and axes are those of the app's BVH files [Homma2023, appendix A]: y up, x to the left
of a person who faces z; at rest the arms are straight out to the sides and all rotations are the
identity.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.records.devices.hierarchy import NO_PARENT, Hierarchy
from virtualgym.body import pose_bones, rotations
from virtualgym.body.pose_bones import Posed, Skeleton
from virtualgym.body.stance import SIDES

TIP_M = 0.001  # length of the last bones, as in the app's files
# From mid-hip, metres. The app's root is 4 cm higher, but there the virtual body's spine bends.
ROOT_M = np.array([0.0, 0.0, -0.02])
# Joint, the bone that carries it, the next bone, and the joint's place between their heads, 0 to 1.
# As in the app, the last joint of the torso is just below the neck.
SPINE = (
    ("torso_1", "spine05", "spine04", 0.0),
    ("torso_2", "spine05", "spine04", 0.5),
    ("torso_3", "spine04", "spine03", 0.0),
    ("torso_4", "spine03", "spine02", 0.0),
    ("torso_5", "spine02", "spine01", 0.0),
    ("torso_6", "spine01", "neck01", 0.0),
    ("torso_7", "spine01", "neck01", 0.8),
    ("neck_1", "neck01", "neck02", 0.0),
    ("neck_2", "neck02", "neck03", 0.5),
    ("head", "head", "head", 0.0),
)
TORSO = tuple(joint for joint, *_ in SPINE if joint.startswith("torso"))
# For each side: joint, parent, the bone that turns it, the bone at whose head it is.
ARM = (
    ("shoulder", "torso_7", "clavicle", "clavicle"),
    ("up_arm", "shoulder", "upperarm02", "upperarm01"),
    ("low_arm", "up_arm", "lowerarm02", "lowerarm01"),
    ("hand", "low_arm", "wrist", "wrist"),
)
LEG = (
    ("up_leg", "root", "upperleg02", "upperleg01"),
    ("low_leg", "up_leg", "lowerleg02", "lowerleg01"),
    ("foot", "low_leg", "foot", "foot"),
    ("toes", "foot", pose_bones.TOES, None),
)
SHARED = {  # joints at the same points as joints of the virtual body
    f"{side[0]}_{part}": f"{name.format(side)}"
    for side in SIDES
    for part, name in {
        "up_arm": "{}_shoulder",
        "low_arm": "{}_elbow",
        "hand": "{}_wrist",
        "up_leg": "{}_hip",
        "low_leg": "{}_knee",
        "foot": "{}_ankle",
        "toes": "rig_{}_toe",
    }.items()
}


@dataclass(frozen=True, eq=False)
class Rig:
    """A body's joints.

    Attributes
    ----------
    hierarchy : Hierarchy
        At rest, metres; the root's offset is its height when standing.
    bones : tuple of str
        The bone of `pose_bones.BONES` that carries each joint.
    bone_from_joint : (J, 3, 3) float
        A joint's axes at rest in the axes of the bone's own rest pose.
    root : (3,) float
        The root in the bone's rest pose, metres.
    """

    hierarchy: Hierarchy
    bones: tuple[str, ...]
    bone_from_joint: np.ndarray
    root: np.ndarray

    @classmethod
    def of(cls, skeleton: Skeleton) -> "Rig":
        """Find the joints in a body's skeleton."""
        parents, bones, places = _joints(skeleton)
        names = list(parents)
        turned = np.array([_at_rest(skeleton, name, bones[name]) for name in names])
        offsets = []
        for name in names:
            parent = parents[name]
            if parent is None:
                offsets.append([0.0, places[name][1], 0.0])
                continue
            way = places[name] - places[parent]
            offsets.append(turned[names.index(parent)].T @ way)
        above = [parents[name] for name in names]
        at = [NO_PARENT if parent is None else names.index(parent) for parent in above]
        ends = {"head": [0, TIP_M, 0], "l_hand": [TIP_M, 0, 0], "r_hand": [-TIP_M, 0, 0]}
        ends |= {f"{side[0]}_toes": [0, 0, TIP_M] for side in SIDES}
        shape = Hierarchy(
            joints=tuple(names),
            parents=np.array(at),
            offsets=np.array(offsets),
            ends={name: np.array(end, dtype=float) for name, end in ends.items()},
        )
        return cls(shape, tuple(bones.values()), turned, places["root"])

    def turns(self, posed: Posed) -> NDArray:
        """Return each joint's rotation (J, 3, 3) in the world, for posed bones."""
        return np.array([posed.rotation[bone] for bone in self.bones]) @ self.bone_from_joint

    def place(self, posed: Posed) -> NDArray:
        """Return the root's place in the world, (3,) m."""
        return posed.at("root", self.root)


def _joints(skeleton: Skeleton) -> tuple[dict[str, str | None], dict[str, str], dict[str, NDArray]]:
    """Return each joint's parent, bone and place at rest, in the app's order."""
    heads = skeleton.heads
    root = skeleton.hips + ROOT_M
    parents: dict[str, str | None] = {"root": None}
    bones, places = {"root": "root"}, {"root": root}
    above = "root"
    for name, bone, towards, share in SPINE:
        parents[name], bones[name] = above, bone
        places[name] = (1 - share) * heads[bone] + share * heads[towards]
        above = name
    for limb in (ARM, LEG):
        for side in SIDES:
            for name, parent, bone, head in limb:
                own = f"{side[0]}_{name}"
                hung = parent if parent in parents else f"{side[0]}_{parent}"
                parents[own], bones[own] = hung, bone + pose_bones.SUFFIX[side]
                places[own] = heads[head + pose_bones.SUFFIX[side]] if head else skeleton.toes[side]
    return parents, bones, places


def _at_rest(skeleton: Skeleton, name: str, bone: str) -> NDArray:
    """Return a joint's axes at rest (3, 3) in the body's rest pose, whose arms are not level."""
    side = {"l": "left", "r": "right"}.get(name[0]) if name[1] == "_" else None
    part, heads = name[2:], skeleton.heads
    if side is None or part not in ("up_arm", "low_arm", "hand"):
        return np.eye(3)
    suffix = pose_bones.SUFFIX[side]
    start, end = {
        "up_arm": (heads["upperarm01" + suffix], heads["lowerarm01" + suffix]),
        "low_arm": (heads["lowerarm01" + suffix], heads["wrist" + suffix]),
        "hand": (heads["wrist" + suffix], skeleton.knuckles[side]),
    }[part]
    out = np.array([1.0 if side == "left" else -1.0, 0.0, 0.0])
    return rotations.swing(out, rotations.unit_vector(end - start))
