"""For OpenSim: a subject's skeletal model as `.osim`, and its coordinates as in the `.mot` file.

Joints turn as in the fit: no joint has more degrees of freedom, no muscle or limit is added. The
format is that of OpenSim 4 (`OpenSimDocument`).
"""

from collections.abc import Sequence
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.exports.trc import WORLD_AXES
from courtside.kinematics import centre_of_mass
from courtside.records.keypoints.skeletal_motion import SkeletalMotion
from courtside.records.keypoints.skeleton import without_side
from courtside.study.errors import StrPath
from courtside.study.execution.files import atomic

VERSION = "40000"
# Each segment's turns in its parent, one after the other about its own axes, by the coordinates'
# names and signs on the right side; the left one is mirrored. Names and signs are those of the
# models of Rajagopal et al. 2016 and of Pose2Sim (neck), where these have such a coordinate.
TURNS = {
    "pelvis": ("ZXY", (("pelvis_tilt", 1), ("pelvis_list", 1), ("pelvis_rotation", 1))),
    "thorax": ("ZXY", (("lumbar_extension", 1), ("lumbar_bending", 1), ("lumbar_rotation", 1))),
    "head": ("ZXY", (("neck_flexion", 1), ("neck_bending", 1), ("neck_rotation", 1))),
    "clavicle": ("XY", (("clavicle_elevation", -1), ("clavicle_protraction", 1))),
    "humerus": (
        "ZXY",
        (("glenohumeral_flexion", 1), ("glenohumeral_adduction", 1), ("glenohumeral_rotation", 1)),
    ),
    "forearm": ("ZY", (("elbow_flex", 1), ("forearm_pronation", 1))),
    "hand": ("ZX", (("wrist_flexion", 1), ("wrist_ulnar_deviation", 1))),
    "femur": ("ZXY", (("hip_flexion", 1), ("hip_adduction", 1), ("hip_rotation", 1))),
    "tibia": ("ZY", (("knee_angle", -1), ("knee_internal_rotation", 1))),
    "foot": ("ZX", (("ankle_angle", 1), ("ankle_inversion", 1))),
}
LETTERS = {"left": "l", "right": "r"}
# Middle of the hip joints in the pelvis of Model_Pose2Sim_simple.osim of Pose2Sim 0.10.49, metres.
# ASSUME: unscaled. The pelvis has its origin there in our model too: one `.mot` serves both.
MID_HIP_M = np.array([-0.0707, -0.0661, 0.0])
PARTS = {  # names of segments in the table of masses
    "femur": "thigh", "tibia": "shank", "humerus": "upper_arm", "forearm": "forearm",
    "head": "head", "hand": "hand", "foot": "foot",
}  # fmt: skip
TRUNK = ("pelvis", "thorax", "clavicle")
EARS = ("left_ear", "right_ear")
LOWER_TRUNK = {"m": 11.17, "f": 12.47}  # percent of the body's mass: the pelvis (de Leva 1996)
CLAVICLE = 0.5  # ASSUME: percent of the body's mass on each, which the thorax has less
DENSITY = 1050.0  # ASSUME: kg/m3 of every segment; Winter 2009, table 4.1 has 1040 to 1190
BODY_MASS_INDEX = 22.0  # ASSUME: kg/m2 of a subject whose mass is not stated
UNFITTED = "No frame was fitted: no length is known"
LEG = 0.491  # length of thigh and shank, share of the height (Winter 2009, fig. 4.1)
# ASSUME: up to which an angle goes on beyond 180 degrees: an arm that points up, or its turn about
# itself, swings round 180 by less; beyond, the arm came round by the back and is lowered.
FAR_DEG = 240.0
# Ranges of coordinates: metres; turns of those that count them (ASSUME: never so many); of others
WIDE_M, COUNTED, OTHERS = 100.0, 1000, 1
COUNTING = ("pelvis_", "glenohumeral")


def body(segment: str) -> str:
    """Return the name of a segment's body: `femur_l` for `left_femur`."""
    side, _, part = segment.partition("_")
    return f"{part}_{LETTERS[side]}" if side in LETTERS else segment


def turns(segment: str) -> list[tuple[int, str, int]]:
    """Return axis, coordinate and sign of each of a segment's turns in its parent."""
    side, _, part = segment.partition("_")
    letters, named = TURNS[part if side in LETTERS else segment]
    ending = f"_{LETTERS[side]}" if side in LETTERS else ""
    axes = ["XYZ".index(letter) for letter in letters]
    return [
        (axis, name + ending, -sign if side == "left" and axis != 2 else sign)
        for axis, (name, sign) in zip(axes, named, strict=True)
    ]


def coordinates(motion: SkeletalMotion, person: int) -> dict[str, NDArray]:
    """Return the coordinates of one person's fitted frames by name, degrees and metres, (T,) each.

    The ground's axes are those of the TRC files. The turns of the pelvis and the shoulders go on
    beyond 180 degrees over the whole take: OpenSim puts splines through them.
    """
    fitted = np.isfinite(motion.root[person]).all(axis=1)
    found: dict[str, NDArray] = {}
    for at, segment in enumerate(motion.segments.tolist()):
        turned = motion.parent_from_segment[person, fitted, at]
        if motion.parents[at] < 0:
            turned = turned[:, WORLD_AXES]
            place = motion.root[person, fitted][:, WORLD_AXES] - turned @ MID_HIP_M
            found |= {f"pelvis_t{axis}": place[:, k] for k, axis in enumerate("xyz")}
        own = turns(segment)
        if len(own) == 2:
            split = _hinges_deg(turned, own[0][0], own[1][0])
        else:
            counts = own[0][1].startswith(COUNTING)
            split = (continuous_deg if counts else euler_deg)(turned)
        found |= {name: sign * split[:, k] for k, (_, name, sign) in enumerate(own)}
    return found


def euler_deg(turned: NDArray) -> NDArray:
    """Return the angles (T, 3) degrees of rotations (T, 3, 3) about Z, then X, then Y.

    Of the two sets that make a rotation it is that whose second angle is within 90 degrees. The
    others go on beyond 180 degrees up to `FAR_DEG` without a jump, and never further: near gimbal
    lock noise moves them anyhow, and a turn that they gained there would last to the end.
    """
    first = scipy.spatial.transform.Rotation.from_matrix(turned).as_euler("ZXY", degrees=True)
    for at in range(1, len(first)):
        last = first[at - 1]
        near = last + (first[at] - last + 180) % 360 - 180
        first[at] = np.where(np.abs(near) <= FAR_DEG, near, first[at])
    return np.asarray(first)


def continuous_deg(turned: NDArray) -> NDArray:
    """Return such angles without a jump: of both sets and all turns those nearest the last ones.

    They move as the segment does, but the same rotation may have others later in the take.
    """
    found = scipy.spatial.transform.Rotation.from_matrix(turned).as_euler("ZXY", degrees=True)
    for at in range(1, len(found)):
        both = np.stack([found[at], found[at] * [1, -1, 1] + 180])
        steps = (both - found[at - 1] + 180) % 360 - 180
        found[at] = found[at - 1] + steps[np.abs(steps).sum(axis=1).argmin()]
    return np.asarray(found)


def _hinges_deg(turned: NDArray, one: int, other: int) -> NDArray:
    """Return the angles (T, 2) degrees of rotations about one axis and then about another."""
    third, sign = 3 - one - other, 1 if (other - one) % 3 == 1 else -1
    first = np.arctan2(sign * turned[:, third, other], turned[:, other, other])
    second = np.arctan2(sign * turned[:, one, third], turned[:, one, one])
    return np.degrees(np.stack([first, second], axis=1))


def write(
    path: StrPath,
    motion: SkeletalMotion,
    person: int,
    *,
    mass_kg: float | None = None,
    sex: str | None = None,
) -> None:
    """Write one person's model (`.osim`): bodies, joints, and the network's joints as markers.

    Markers are named as in the TRC files, coordinates as in `coordinates`; all lengths are those of
    the fit, their standard deviations are in the credits. Masses and their centres are those of de
    Leva (1996); inertia about them is that of a cylinder along Y, as long as from joint to joint
    where the segment has a next one, else as wide as long. Without a fitted frame no length is
    known, and the model has no bodies.
    """
    fitted = bool(np.isfinite(motion.root[person]).all(axis=1).any())
    root = Element("OpenSimDocument", Version=VERSION)
    model = SubElement(root, "Model", name=str(motion.person_id[person]))
    _text(model, "credits", _credits(motion, person) if fitted else UNFITTED)
    _text(model, "length_units", "meters")
    _text(model, "force_units", "N")
    _text(model, "gravity", (0, -9.80665, 0))
    SubElement(model, "Ground", name="ground")
    bodies, joints, markers = (
        SubElement(SubElement(model, kind, name=kind.lower()), "objects")
        for kind in ("BodySet", "JointSet", "MarkerSet")
    )
    if fitted:
        _add_bodies(bodies, joints, motion, person, mass_kg, sex)
        _add_markers(markers, motion, person)
    ElementTree.indent(root)
    with atomic(path) as temporary:
        ElementTree.ElementTree(root).write(temporary, encoding="UTF-8", xml_declaration=True)


def _add_bodies(
    bodies: Element,
    joints: Element,
    motion: SkeletalMotion,
    person: int,
    mass_kg: float | None,
    sex: str | None,
) -> None:
    masses = _masses(motion, person, mass_kg, sex)
    centres = _centres(motion, person, masses, sex)
    for at, segment in enumerate(motion.segments.tolist()):
        size = _cylinder(motion, person, at, masses[at])
        _add_body(bodies, body(segment), masses[at], centres[at] + _origin(at), *size)
        parent = motion.parents[at]
        above = "/ground" if parent < 0 else f"/bodyset/{body(motion.segments[parent])}"
        _add_joint(joints, segment, above, motion.offsets[person, at] + _origin(parent))


def _add_markers(markers: Element, motion: SkeletalMotion, person: int) -> None:
    places = _places(motion, person)
    for joint, at, place in zip(motion.joints, motion.segment_of, places, strict=True):
        entry = SubElement(markers, "Marker", name=str(joint))
        _text(entry, "socket_parent_frame", f"/bodyset/{body(motion.segments[at])}")
        _text(entry, "location", place)
        _text(entry, "fixed", "true")


def _origin(segment: int) -> NDArray:
    """Return where a segment's own origin lies in its body, metres; of the ground the ground's."""
    return MID_HIP_M if segment == 0 else np.zeros(3)


def _places(motion: SkeletalMotion, person: int) -> NDArray:
    """Return the places (J, 3) m of the network's joints in their bodies."""
    return motion.places[person] + np.array([_origin(at) for at in motion.segment_of.tolist()])


def _masses(motion: SkeletalMotion, person: int, mass_kg: float | None, sex: str | None) -> NDArray:
    """Return the mass of each segment (S,) kg; without a sex the mean of men and women."""
    if mass_kg is None:
        names = motion.segments.tolist()
        bones = [names.index(name) for name in ("left_tibia", "left_foot")]
        leg = np.linalg.norm(motion.offsets[person, bones], axis=1).sum()
        mass_kg = BODY_MASS_INDEX * float(leg / LEG) ** 2
    shares = [_shares(motion, one) for one in ((sex,) if sex in ("m", "f") else ("m", "f"))]
    mean = np.mean(shares, axis=0)
    return mass_kg * mean / mean.sum()


def _shares(motion: SkeletalMotion, sex: str) -> NDArray:
    table = {name: one.mass[sex] for name, one in centre_of_mass.SEGMENTS.items()}
    found = {segment: table[part] for segment, part in PARTS.items()}
    found |= {"pelvis": LOWER_TRUNK[sex], "clavicle": CLAVICLE}
    found["thorax"] = table["trunk"] - LOWER_TRUNK[sex] - 2 * CLAVICLE
    return np.array([found[without_side(name)] for name in motion.segments.tolist()])


def _centres(motion: SkeletalMotion, person: int, masses: NDArray, sex: str | None) -> NDArray:
    """Return the centre of mass (S, 3) m of each segment from its origin, in its axes.

    As `centre_of_mass` has them: of limbs on the bone, of the hand on the forearm's line, of the
    trunk on the line from mid-shoulder to mid-hip of a straight back, of the head between the ears.
    Of feet, and of heads without ears, it is the mean of their points.
    """
    names, offsets = motion.segments.tolist(), motion.offsets[person]
    centres = np.zeros_like(offsets)
    for at, name in enumerate(names):
        part, below = without_side(name), np.flatnonzero(motion.parents == at)
        if len(below):
            place = centre_of_mass.place(PARTS[part], sex) if part in PARTS else 0.5
            centres[at] = place * offsets[below[0]]
        elif part == "hand":
            centres[at] = (centre_of_mass.place("hand", sex) - 1) * offsets[at]
        else:
            points = motion.places[person]
            own = (motion.segment_of == at) & points.any(axis=1)
            ears = own & np.isin(motion.joints, EARS)
            own = ears if ears.any() else own
            centres[at] = points[own].mean(axis=0) if own.any() else 0
    return _with_trunk(motion, person, masses, centres, centre_of_mass.place("trunk", sex))


def _with_trunk(
    motion: SkeletalMotion, person: int, masses: NDArray, centres: NDArray, place: float
) -> NDArray:
    """Return the centres with that of the thorax such that the trunk's lies at its place."""
    names = motion.segments.tolist()
    origins = np.zeros_like(centres)  # in the pelvis, of a body with all joints at zero
    for at, above in enumerate(motion.parents.tolist()):
        origins[at] = motion.offsets[person, at] + (origins[above] if above >= 0 else 0)
    shoulders, hips = (
        origins[[names.index(f"{side}_{bone}") for side in LETTERS]].mean(axis=0)
        for bone in ("humerus", "femur")
    )
    trunk = [at for at, name in enumerate(names) if without_side(name) in TRUNK]
    thorax = names.index("thorax")
    lacking = (1 - place) * shoulders + place * hips - origins[trunk] - centres[trunk]
    centres[thorax] += masses[trunk] @ lacking / masses[thorax]
    return centres


def _cylinder(motion: SkeletalMotion, person: int, at: int, mass_kg: float) -> tuple[float, float]:
    """Return half height and radius, metres, of a segment."""
    below = np.flatnonzero(motion.parents == at)
    height = abs(motion.offsets[person, below[0], 1]) if len(below) else 0.0
    half = height / 2 or (mass_kg / (2 * np.pi * DENSITY)) ** (1 / 3)
    return float(half), float(np.sqrt(mass_kg / (2 * np.pi * DENSITY * half)))


def _credits(motion: SkeletalMotion, person: int) -> str:
    """Return the lengths with their standard deviations in words."""
    apart = np.linalg.norm(motion.offsets[person], axis=1)
    lines = [
        f"{body(motion.segments[parent])} to {body(segment)} {length:.4f} ({sigma:.4f})"
        for segment, parent, length, sigma in zip(
            motion.segments, motion.parents, apart, motion.offset_sigma_m[person], strict=True
        )
        if parent >= 0
    ]
    return "Distances of joints (standard deviation), m: " + ", ".join(lines)


def _text(parent: Element, tag: str, value: object) -> None:
    """Add an element with a text, or with numbers."""
    one = SubElement(parent, tag)
    if isinstance(value, str):
        one.text = value
    else:
        one.text = " ".join(f"{number:.9g}" for number in np.atleast_1d(np.asarray(value)))


def _add_body(
    parent: Element, name: str, mass_kg: float, centre: NDArray, half: float, radius: float
) -> None:
    entry = SubElement(parent, "Body", name=name)
    frame = SubElement(SubElement(entry, "components"), "PhysicalOffsetFrame", name="middle")
    shown = SubElement(SubElement(frame, "attached_geometry"), "Cylinder", name="shown")
    _text(shown, "socket_frame", "..")
    _text(shown, "radius", radius)
    _text(shown, "half_height", half)
    _text(frame, "socket_parent", "..")
    _text(frame, "translation", centre)
    _text(frame, "orientation", (0, 0, 0))
    across = mass_kg * (3 * radius**2 + 4 * half**2) / 12
    _text(entry, "mass", mass_kg)
    _text(entry, "mass_center", centre)
    _text(entry, "inertia", (across, mass_kg * radius**2 / 2, across, 0, 0, 0))


def _add_joint(parent: Element, segment: str, above: str, place: NDArray) -> None:
    """Add the joint that connects a segment to the body `above`, at a position in that body."""
    own = turns(segment)
    joint = SubElement(parent, "CustomJoint", name=f"{body(segment)}_joint")
    _text(joint, "socket_parent_frame", "above")
    _text(joint, "socket_child_frame", "below")
    moves = [f"pelvis_t{axis}" for axis in "xyz"] if above == "/ground" else []
    listed = SubElement(joint, "coordinates")
    for name in [*(name for _, name, _ in own), *moves]:
        entry = SubElement(listed, "Coordinate", name=name)
        turned = 2 * np.pi * (COUNTED if name.startswith(COUNTING) else OTHERS)
        most = WIDE_M if name in moves else turned
        _text(entry, "range", (-most, most))
        _text(entry, "clamped", "false")
    frames = SubElement(joint, "frames")
    child = (0, 0, 0)
    for name, path, where in (
        ("above", above, place),
        ("below", f"/bodyset/{body(segment)}", child),
    ):
        frame = SubElement(frames, "PhysicalOffsetFrame", name=name)
        _text(frame, "socket_parent", path)
        _text(frame, "translation", where)
        _text(frame, "orientation", (0, 0, 0))
    how = SubElement(joint, "SpatialTransform")
    axes = [(axis, sign, name) for axis, name, sign in own]
    axes += [(axis, 1, "") for axis in range(3) if axis not in [one[0] for one in own]]
    for number, (axis, sign, name) in enumerate(axes, start=1):
        _add_axis(how, f"rotation{number}", sign * np.eye(3)[axis], name)
    for axis in range(3):
        _add_axis(how, f"translation{axis + 1}", np.eye(3)[axis], moves[axis] if moves else "")


def _add_axis(parent: Element, name: str, axis: Sequence[float] | NDArray, by: str) -> None:
    """Add one axis of a joint that turns or moves by a coordinate, or not at all."""
    entry = SubElement(parent, "TransformAxis", name=name)
    _text(entry, "coordinates", by)
    _text(entry, "axis", axis)
    if by:
        _text(SubElement(entry, "LinearFunction", name="function"), "coefficients", (1, 0))
    else:
        _text(SubElement(entry, "Constant", name="function"), "value", 0)
