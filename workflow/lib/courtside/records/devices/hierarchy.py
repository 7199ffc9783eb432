"""A body as its device tells it: joints hung from one another, and their rotations over time."""

from dataclasses import dataclass, field

import numpy as np

NO_PARENT = -1


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """Joints and what each hangs from.

    Attributes
    ----------
    joints : tuple of str
        Names, parents before their children; a file may name two joints alike.
    parents : (J,) int
        Index of each joint's parent, below its own; `NO_PARENT` for a root.
    offsets : (J, 3) float
        Place of each joint's origin in its parent's axes at rest, metres.
    ends : dict of str to (3,) float
        Tips of the last bones (BVH's End Sites) in their joint's axes, metres. Of joints named
        alike, the first one's.
    """

    joints: tuple
    parents: np.ndarray
    offsets: np.ndarray
    ends: dict = field(default_factory=dict)

    def __post_init__(self):
        size = len(self.joints)
        if self.parents.shape != (size,) or self.offsets.shape != (size, 3):
            raise ValueError(
                f"{size} joints, parents {self.parents.shape}, offsets {self.offsets.shape}"
            )
        if size and not ((self.parents >= NO_PARENT) & (self.parents < np.arange(size))).all():
            raise ValueError("every joint's parent comes before it (or is NO_PARENT)")


@dataclass(frozen=True, eq=False)
class PosedHierarchy:
    """A hierarchy in motion.

    Attributes
    ----------
    hierarchy : Hierarchy
        The joints.
    time_s : (T,) float
        Seconds on the device's own clock.
    translation : (T, J, 3) float
        Each joint's origin in its parent's axes, metres: what the device tells, else the offset.
        A root's is its place in the device's world.
    parent_from_joint : (T, J, 3, 3) float
        Rotation of each joint's axes in its parent's.
    """

    hierarchy: Hierarchy
    time_s: np.ndarray
    translation: np.ndarray
    parent_from_joint: np.ndarray

    def __post_init__(self):
        shape = (len(self.time_s), len(self.hierarchy.joints), 3)
        if self.translation.shape != shape or self.parent_from_joint.shape != (*shape, 3):
            raise ValueError(
                f"translation is {self.translation.shape}, parent_from_joint "
                f"{self.parent_from_joint.shape}: expected {shape} and {(*shape, 3)}"
            )


def forward(posed):
    """Place every joint in the device's world: forward kinematics.

    Parameters
    ----------
    posed : PosedHierarchy
        Joints in their parents' axes.

    Returns
    -------
    xyz : (T, J, 3) float
        Joint origins in the device's world, metres.
    world_from_joint : (T, J, 3, 3) float
        Rotation of each joint's axes in the device's world.

    Notes
    -----
    One matrix product per joint, for all frames at once.
    """
    # Joints lead while solving: each joint's frames then lie together in memory.
    local = np.ascontiguousarray(np.moveaxis(posed.parent_from_joint, 1, 0), dtype=float)
    places = np.ascontiguousarray(np.moveaxis(posed.translation, 1, 0), dtype=float)
    turned, xyz = np.empty_like(local), np.empty_like(places)
    for joint, parent in enumerate(posed.hierarchy.parents):
        if parent == NO_PARENT:
            turned[joint], xyz[joint] = local[joint], places[joint]
            continue
        np.matmul(turned[parent], local[joint], out=turned[joint])
        xyz[joint] = xyz[parent] + (turned[parent] @ places[joint][:, :, None])[:, :, 0]
    return np.moveaxis(xyz, 0, 1), np.moveaxis(turned, 0, 1)
