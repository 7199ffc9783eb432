"""For OpenSim: a marker set for the joints of a TRC file, and joint angles as a motion file."""

from collections.abc import Sequence
from xml.etree import ElementTree

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.exports import markers
from courtside.exports.trc import WORLD_AXES
from courtside.records.devices import hierarchy
from courtside.records.keypoints.skeletal_motion import SkeletalMotion
from courtside.study.errors import InputError, StrPath
from courtside.study.execution.files import atomic

VERSION = "40000"
# In the models of Rajagopal et al. 2016 and Beaucage-Gauvreau et al. 2019, which Pose2Sim's joins,
# the origin of a body lies at the joint that connects it to its parent: these positions are exact.
AT_ORIGIN = {
    "shoulder": "humerus_{}",
    "elbow": "ulna_{}",
    "wrist": "hand_{}",
    "hip": "femur_{}",
    "knee": "tibia_{}",
    "ankle": "talus_{}",
}
# ASSUME: of the others only the body is certain; the position, in metres of an unscaled adult (x
# forward, y up, z to the right), is rough, and the marker may move when the model is scaled.
ROUGH = {
    "heel": ("calcn_{}", (0.0, 0.02, 0.0)),
    "foot_index": ("toes_{}", (0.05, 0.0, 0.0)),
    "big_toe": ("toes_{}", (0.05, 0.0, -0.02)),
    "small_toe": ("toes_{}", (0.02, 0.0, 0.04)),
    "pinky": ("hand_{}", (0.0, -0.08, -0.02)),
    "index": ("hand_{}", (0.0, -0.09, 0.02)),
    "thumb": ("hand_{}", (0.02, -0.05, 0.03)),
    "eye": ("head", (0.08, 0.05, 0.03)),
    "eye_inner": ("head", (0.08, 0.05, 0.015)),
    "eye_outer": ("head", (0.07, 0.05, 0.045)),
    "ear": ("head", (0.0, 0.04, 0.08)),
    "mouth": ("head", (0.09, -0.03, 0.025)),
    "nose": ("head", (0.11, 0.01, 0.0)),
    "head_top": ("head", (0.0, 0.17, 0.0)),
    "neck": ("torso", (-0.01, 0.42, 0.0)),
    "mid_hip": ("pelvis", (-0.07, -0.07, 0.0)),
}


def write_markers(path: StrPath, joints: Sequence[str]) -> None:
    """Write the marker set (`.xml`) of joints, named as in `pose2sim.write_project`'s TRC files.

    For models with the bodies `head`, `torso`, `pelvis` and those of the limbs, as Pose2Sim's has.
    Raises `InputError` if the position of a joint on a body is unknown.
    """
    root = ElementTree.Element("OpenSimDocument", Version=VERSION)
    group = ElementTree.SubElement(root, "MarkerSet", name="markerset")
    objects = ElementTree.SubElement(group, "objects")
    for joint, marker in zip(joints, markers.names(joints), strict=True):
        body, place, exact = _place(path, joint)
        entry = ElementTree.SubElement(objects, "Marker", name=marker)
        ElementTree.SubElement(entry, "socket_parent_frame").text = f"/bodyset/{body}"
        ElementTree.SubElement(entry, "location").text = " ".join(f"{value:g}" for value in place)
        ElementTree.SubElement(entry, "fixed").text = str(exact).lower()
    ElementTree.SubElement(group, "groups")
    ElementTree.indent(root)
    with atomic(path) as temporary:
        ElementTree.ElementTree(root).write(temporary, encoding="UTF-8", xml_declaration=True)


def _place(path: StrPath, joint: str) -> tuple[str, tuple[float, float, float], bool]:
    """Return body, position and whether the position is exact."""
    side, part = markers.side_and_part(joint)
    letter = markers.SIDES.get(side, "").lower()
    if side and part in AT_ORIGIN:
        return AT_ORIGIN[part].format(letter), (0.0, 0.0, 0.0), True
    if part not in ROUGH:
        raise InputError(
            f"{path}: expected joints whose place on an OpenSim body is known, found {joint!r}; "
            "leave it out"
        )
    body, (x, y, z) = ROUGH[part]
    return body.format(letter), (x, y, -z if side == "left" and z else z), False


# Coordinates of the model of Rajagopal et al. 2016, and of Pose2Sim's models (`L5_S1`), with our
# angle and its sign.
COORDINATES = {
    "pelvis_tilt": ("pelvis_tilt", -1),
    "pelvis_list": ("pelvis_list", 1),
    "pelvis_rotation": ("pelvis_rotation", 1),
    "lumbar_extension": ("trunk_flexion", -1),
    "lumbar_bending": ("trunk_bending", 1),
    "lumbar_rotation": ("trunk_rotation", 1),
    "L5_S1_Flex_Ext": ("trunk_flexion", -1),
    "L5_S1_Lat_Bending": ("trunk_bending", 1),
    "L5_S1_axial_rotation": ("trunk_rotation", 1),
}
OF_SIDES = {
    "hip_flexion": "hip_flexion",
    "hip_adduction": "hip_adduction",
    "hip_rotation": "hip_internal_rotation",
    "knee_angle": "knee_flexion",
    "ankle_angle": "ankle_dorsiflexion",
    "elbow_flex": "elbow_flexion",
}
ARM = ("arm_flex", "arm_add", "arm_rot")  # of the arm against the trunk, about Z, X, Y
# Middle of the hip joints in the pelvis of Model_Pose2Sim_simple.osim of Pose2Sim 0.10.49, metres.
# ASSUME: unscaled.
MID_HIP_M = np.array([-0.0707, -0.0661, 0.0])
LETTERS = {"left": "l", "right": "r"}


def write_motion(path: StrPath, motion: SkeletalMotion, person: int) -> None:
    """Write one person's joint angles over the fitted frames as `.mot`, degrees and metres.

    Coordinates are named as in the model of Rajagopal et al. 2016 and in Pose2Sim's, which differ
    in the names of the trunk's: a program leaves out those that its model lacks. The ground's axes
    are those of the TRC files. Forearm and wrist are left out: joint centres hardly show their
    turns. An `InputError` if no frame was fitted.
    """
    posed, fitted = motion.posed(person)
    if not fitted.any():
        raise InputError(
            f"{path}: expected a person with fitted frames, found none of "
            f"{motion.person_id[person]!r}; leave the person out of the take"
        )
    degrees = dict(zip(motion.angles.tolist(), motion.angle_deg[person, fitted].T, strict=True))
    _, turned = hierarchy.forward(posed)
    columns = {"time": posed.time_s}
    columns |= {name: sign * degrees[angle] for name, (angle, sign) in COORDINATES.items()}
    pelvis = turned[:, 0][:, WORLD_AXES]  # in the ground, whose Y is up
    places = motion.root[person, fitted][:, WORLD_AXES] - pelvis @ MID_HIP_M
    columns |= {f"pelvis_t{axis}": places[:, at] for at, axis in enumerate("xyz")}
    names = motion.segments.tolist()
    for side, letter in LETTERS.items():
        for name, angle in OF_SIDES.items():
            columns[f"{name}_{letter}"] = degrees[f"{side}_{angle}"]
        arm = turned[:, names.index(f"{side}_humerus")]
        three = _arm_deg(np.swapaxes(turned[:, names.index("thorax")], 1, 2) @ arm, side)
        columns |= {f"{name}_{letter}": three[:, at] for at, name in enumerate(ARM)}
    head = ["Coordinates", "version=1", f"nRows={len(posed.time_s)}", f"nColumns={len(columns)}"]
    head += ["inDegrees=yes", "endheader", "\t".join(columns)]
    with atomic(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as stream:
        stream.write("\n".join(head) + "\n")
        np.savetxt(stream, np.stack(list(columns.values()), axis=1), "%.6f", "\t")


def _arm_deg(rotation: NDArray, side: str) -> NDArray:
    """Return the angles (T, 3) degrees of the arm in the trunk (T, 3, 3), a left one mirrored."""
    mirror = np.array([1.0, 1.0, -1.0 if side == "left" else 1.0])
    turns = scipy.spatial.transform.Rotation.from_matrix(mirror[:, None] * rotation * mirror)
    return np.asarray(turns.as_euler("ZXY", degrees=True))
