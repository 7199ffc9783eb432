"""An OpenSim marker set for the joints of a TRC file: the body of the model for each marker."""

from collections.abc import Sequence
from xml.etree import ElementTree

from courtside.exports import markers
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
