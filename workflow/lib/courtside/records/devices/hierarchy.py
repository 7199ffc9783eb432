"""A body as a device gives it: a tree of joints, and their rotations over time."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

NO_PARENT = -1
HELD_S = 0.2  # ASSUME: nobody holds every joint still to the last digit for this long


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """Joints and their parents."""

    # Names, parents before their children; a file may use one name for two joints
    joints: tuple[str, ...]
    # (J,) int: index of each joint's parent, below its own; `NO_PARENT` for a root
    parents: NDArray
    # (J, 3) float: position of each joint's origin in its parent's axes at rest, metres
    offsets: NDArray
    # (3,) float: tips of the last bones (BVH's End Sites) in their joint's axes, metres; of the
    # first joint of each name
    ends: dict[str, NDArray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        size = len(self.joints)
        if self.parents.shape != (size,) or self.offsets.shape != (size, 3):
            raise ValueError(
                f"{size} joints, parents {self.parents.shape}, offsets {self.offsets.shape}"
            )
        if size and not ((self.parents >= NO_PARENT) & (self.parents < np.arange(size))).all():
            raise ValueError("every joint's parent comes before it (or is NO_PARENT)")


@dataclass(frozen=True, eq=False)
class PosedHierarchy:
    """A hierarchy in motion."""

    hierarchy: Hierarchy
    time_s: NDArray  # (T,) float: seconds on the device's own clock
    # (T, J, 3) float: each joint's origin in its parent's axes, metres: the device's own values,
    # else the offset. A root's is its position in the device's world
    translation: NDArray
    parent_from_joint: NDArray  # (T, J, 3, 3) float: rotation of each joint's axes in its parent's

    def __post_init__(self) -> None:
        shape = (len(self.time_s), len(self.hierarchy.joints), 3)
        if self.translation.shape != shape or self.parent_from_joint.shape != (*shape, 3):
            raise ValueError(
                f"translation is {self.translation.shape}, parent_from_joint "
                f"{self.parent_from_joint.shape}: expected {shape} and {(*shape, 3)}"
            )


def forward(posed: PosedHierarchy) -> tuple[NDArray, NDArray]:
    """Compute every joint's pose in the device's world: forward kinematics.

    Returns the joints' origins (T, J, 3), metres, and the rotations (T, J, 3, 3) of their axes.
    """
    # The joint axis comes first here: each joint's frames are then contiguous in memory, and one
    # matrix product per joint solves all frames.
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


def held_s(posed: PosedHierarchy) -> list[tuple[float, float]]:
    """Return from when until when every frame repeats one pose, s: a suit lost its sensors."""
    repeats = (np.diff(posed.parent_from_joint, axis=0) == 0).all(axis=(1, 2, 3))
    edges = np.flatnonzero(np.diff(repeats, prepend=False, append=False)).reshape(-1, 2)
    return [(first, last) for first, last in posed.time_s[edges] if last - first >= HELD_S]


def still(shape: Hierarchy, turns: NDArray) -> PosedHierarchy:
    """Return one frame of joints at their offsets, with rotations (J, 3, 3) in their parents."""
    return PosedHierarchy(shape, np.zeros(1), shape.offsets[None], turns[None])


def at_rest(shape: Hierarchy) -> NDArray:
    """Return the places (J, 3) of the joints where none is turned, metres."""
    return forward(still(shape, np.tile(np.eye(3), (len(shape.joints), 1, 1))))[0][0]
