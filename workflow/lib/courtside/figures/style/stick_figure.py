"""The stick figure that is drawn of a person: 12 limb joints, neck and centre of the head."""

from dataclasses import dataclass

import numpy as np

HEAD = ("neck", "head_centre")


@dataclass(frozen=True, eq=False)
class Stick:
    """What is drawn of a skeleton.

    Attributes
    ----------
    joints : tuple of str, length K
        The limb joints, neck, centre of the head: the paper's 14.
    bones : tuple of (int, int)
        Which of them a line joins.
    weights : (K, J) float
        Of the skeleton's own joints.
    face : list of int
        The skeleton's own joints on the face.
    """

    joints: tuple
    bones: tuple
    weights: np.ndarray
    face: list

    def of(self, places):
        """Return the drawn joints (..., K, n) of a skeleton's own (..., J, n); NaN without a part."""
        made = [
            np.tensordot(places[..., used, :], row[used], axes=([-2], [0]))
            for row in self.weights
            for used in [np.flatnonzero(row)]
        ]
        return np.stack(made, axis=-2)

    def faces_of(self, *places):
        """Return the joints on each face (P, n, 2), of one or more sets of a skeleton's own (P, J, 2)."""
        return np.concatenate([xy[:, self.face] for xy in places], axis=1)


def stick(skeleton, table):
    """Return the stick figure of a skeleton.

    Parameters
    ----------
    skeleton : Skeleton
    table : courtside.records.keypoints.derived_joints.DerivedJoints
        Has a neck and a head_centre for it.
    """
    joints = (*skeleton.groups["limbs"], *HEAD)
    weights = np.stack([table.weights(skeleton.name, name, skeleton.joints) for name in joints])
    limbs = [pair for pair in skeleton.bones if set(pair) <= set(skeleton.groups["limbs"])]
    bones = tuple((joints.index(start), joints.index(stop)) for start, stop in (*limbs, HEAD))
    face = [skeleton.index(joint) for joint in skeleton.groups["face"]]
    return Stick(joints, bones, weights, face)
