"""The stick figure of a person: 12 limb joints, neck and centre of the head."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.records.keypoints.derived_joints import DerivedJoints
from courtside.records.keypoints.skeleton import Skeleton

HEAD = ("neck", "head_centre")


@dataclass(frozen=True, eq=False)
class Stick:
    """The stick figure of a skeleton."""

    joints: tuple[str, ...]  # K: the limb joints, neck, centre of the head, the paper's 14
    bones: tuple[tuple[int, int], ...]  # pairs of them that a line joins
    weights: NDArray  # (K, J): of the skeleton's own joints

    def of(self, places: NDArray) -> NDArray:
        """Return the drawn joints (..., K, n) of a skeleton's own (..., J, n), or NaN."""
        made = [
            np.tensordot(places[..., used, :], row[used], axes=([-2], [0]))
            for row in self.weights
            for used in [np.flatnonzero(row)]
        ]
        return np.stack(made, axis=-2)


def stick(skeleton: Skeleton, table: DerivedJoints) -> Stick:
    """Return the stick figure of a skeleton; `table` defines its neck and head_centre."""
    joints = (*skeleton.groups["limbs"], *HEAD)
    weights = np.stack([table.weights(skeleton.name, name, skeleton.joints) for name in joints])
    limbs = [pair for pair in skeleton.bones if set(pair) <= set(skeleton.groups["limbs"])]
    bones = tuple((joints.index(start), joints.index(stop)) for start, stop in (*limbs, HEAD))
    return Stick(joints, bones, weights)
