"""For OpenSim: a marker set for the joints of a TRC file, and joint angles as a motion file."""

from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from courtside.exports import markers, opensim_model
from courtside.records.devices import hierarchy
from courtside.records.keypoints.skeletal_motion import SkeletalMotion
from courtside.study.errors import StrPath
from courtside.study.execution import log
from courtside.study.execution.files import atomic

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
    A joint whose place on these is unknown gets no marker: OpenSim ignores it in the TRC file.
    """
    root = ElementTree.Element("OpenSimDocument", Version=opensim_model.VERSION)
    group = ElementTree.SubElement(root, "MarkerSet", name="markerset")
    objects = ElementTree.SubElement(group, "objects")
    unplaced = []
    for joint, marker in zip(joints, markers.names(joints), strict=True):
        found = _place(joint)
        if found is None:
            unplaced.append(joint)
            continue
        body, place, exact = found
        entry = ElementTree.SubElement(objects, "Marker", name=marker)
        ElementTree.SubElement(entry, "socket_parent_frame").text = f"/bodyset/{body}"
        ElementTree.SubElement(entry, "location").text = " ".join(f"{value:g}" for value in place)
        ElementTree.SubElement(entry, "fixed").text = str(exact).lower()
    if unplaced:
        message = "%s: no markers for %d joints such as %s: their places on a body are unknown"
        log.logger.info(message, Path(path).name, len(unplaced), unplaced[0])
    ElementTree.SubElement(group, "groups")
    ElementTree.indent(root)
    with atomic(path) as temporary:
        ElementTree.ElementTree(root).write(temporary, encoding="UTF-8", xml_declaration=True)


def _place(joint: str) -> tuple[str, tuple[float, float, float], bool] | None:
    """Return body, position and whether the position is exact; None where it is unknown."""
    side, part = markers.side_and_part(joint)
    letter = markers.SIDES.get(side, "").lower()
    if side and part in AT_ORIGIN:
        return AT_ORIGIN[part].format(letter), (0.0, 0.0, 0.0), True
    if part not in ROUGH:
        return None
    body, (x, y, z) = ROUGH[part]
    return body.format(letter), (x, y, -z if side == "left" and z else z), False


# The trunk's coordinates in Pose2Sim's default model: ours, and the share of one of its six coupled
# joints. Its constraints give the other five 6.1429, 9.781 and 4.5625 times the angle of this one.
L5_S1 = {
    "L5_S1_Flex_Ext": ("lumbar_extension", 1 / 7.1429),
    "L5_S1_Lat_Bending": ("lumbar_bending", 1 / 10.781),
    "L5_S1_axial_rotation": ("lumbar_rotation", 1 / 5.5625),
}
ARM = ("arm_flex", "arm_add", "arm_rot")  # of the arm against the trunk, about Z, X, Y


def write_motion(path: StrPath, motion: SkeletalMotion, person: int) -> None:
    """Write one person's coordinates over the fitted frames as `.mot`, degrees and metres.

    They are those of the person's own model (`opensim_model`), of the model of Rajagopal et al.
    2016 and of Pose2Sim's default model, whose arms hang on the trunk; these share most names. A
    program leaves out those that its model lacks. Without a fitted frame the file has no rows.
    """
    posed, _ = motion.posed(person)
    columns = {"time": posed.time_s} | opensim_model.coordinates(motion, person)
    columns |= {name: share * columns[own] for name, (own, share) in L5_S1.items()}
    _, turned = hierarchy.forward(posed)
    names = motion.segments.tolist()
    for side, letter in opensim_model.LETTERS.items():
        mirror = -1 if side == "left" else 1
        arm = turned[:, names.index(f"{side}_humerus")]
        arm = np.swapaxes(turned[:, names.index("thorax")], 1, 2) @ arm
        three = opensim_model.euler_deg(arm) * [1, mirror, mirror]
        columns |= {f"{name}_{letter}": three[:, at] for at, name in enumerate(ARM)}
    head = ["Coordinates", "version=1", f"nRows={len(posed.time_s)}", f"nColumns={len(columns)}"]
    head += ["inDegrees=yes", "endheader", "\t".join(columns)]
    with atomic(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as stream:
        stream.write("\n".join(head) + "\n")
        np.savetxt(stream, np.stack(list(columns.values()), axis=1), "%.6f", "\t")
