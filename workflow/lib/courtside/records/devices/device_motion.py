"""The skeleton of a take from one device or one single-view method: a file between rules."""

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from courtside.records import npz
from courtside.records.devices.hierarchy import Hierarchy, PosedHierarchy
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.study.errors import InputError, StrPath, reading

FORM = "courtside device motion 2"
# Of `posed` in the file; no joints where there is none.
ROTATIONS = {
    "hierarchy": ("str", ("H",)),
    "parents": ("int", ("H",)),
    "offsets": ("float", ("H", "3")),
    "end_joints": ("str", ("E",)),
    "ends": ("float", ("E", "3")),
    "translation": ("float", ("T", "H", "3")),
    "parent_from_joint": ("float", ("T", "H", "3", "3")),
}
NO_JOINTS = Hierarchy((), np.empty(0, int), np.empty((0, 3)))


@dataclass(frozen=True, eq=False)
class DeviceMotion:
    """One skeleton over time, in the device's own frame and on its own clock."""

    source: str  # `mocopi`, `d415-rgb`, `d415-depth` or `cameras`
    kind: str  # `inertial`, `rgb`, `rgbd` or `cameras`
    joints: Annotated[NDArray, "str J"]  # names as in `config/skeletons/`
    time_s: Annotated[NDArray, "float T"]  # on the device's own clock
    xyz: Annotated[NDArray, "float T J 3"]  # metres, in the device's own axes; NaN where missing
    reason: Annotated[NDArray, "int T J"]  # uint8: codes of `missing_reason`
    # False for frames that nobody performed, like the rest pose in the first row of a mocopi file
    performed: Annotated[NDArray, "bool T"]
    # The same motion as rotations, where the device gives them: same times and names of joints, in
    # the device's own order. Stored as `ROTATIONS`.
    posed: Annotated[PosedHierarchy | None, "posed"] = None

    def joint(self, name: str) -> NDArray:
        """Return the path (T, 3) of a joint, metres; raise `ValueError` if there is none."""
        return self.xyz[:, list(self.joints).index(name)]


# Rotations to upright axes (z up) from a device's own: y up, or camera axes (y down, z forward).
Y_UP = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
CAM = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
UPRIGHT = {"inertial": Y_UP, "rgb": CAM, "rgbd": CAM}


def upright(motion: DeviceMotion) -> NDArray:
    """Return the joints (T, J, 3) of a motion in axes with z up, metres."""
    return motion.xyz @ UPRIGHT.get(motion.kind, np.eye(3)).T


def of_truth(truth: Any, person: str) -> DeviceMotion:
    """Return a person of a virtual take as a source without gaps.

    `truth` is a `TakeTruth`; untyped, for methods import this module and must not reach the truth.
    """
    xyz = truth.xyz[list(map(str, truth.person_id)).index(person)]
    complete = np.ones(len(truth.time_s), dtype=bool)
    reason = np.zeros(xyz.shape[:2], dtype=np.uint8)
    return DeviceMotion("truth", "cameras", truth.joints, truth.time_s, xyz, reason, complete)


def of_person(points: Keypoints3D, person: str) -> DeviceMotion:
    """Return one person of the fixed cameras as a source: in world, on the reference clock.

    An `InputError` if there is no such person.
    """
    known = points.person_id.tolist()
    if person not in known:
        raise InputError(
            f"person {person}: expected one of {known} of the fixed cameras; name the subject of "
            "the devices"
        )
    xyz, reason = points.xyz[known.index(person)], points.reason[known.index(person)]
    complete = np.ones(len(points.time_s), dtype=bool)
    return DeviceMotion("cameras", "cameras", points.joints, points.time_s, xyz, reason, complete)


def write(path: StrPath, motion: DeviceMotion) -> None:
    """Write a `DeviceMotion` to an npz file."""
    arrays, n_frames = dict(vars(motion)), len(motion.time_s)
    none = PosedHierarchy(
        NO_JOINTS, motion.time_s, np.empty((n_frames, 0, 3)), np.empty((n_frames, 0, 3, 3))
    )
    posed = arrays.pop("posed") or none
    if not np.array_equal(posed.time_s, motion.time_s):
        raise ValueError(f"{motion.source}: expected rotations at the times of the joints")
    tree = posed.hierarchy
    arrays |= {
        "hierarchy": np.array(tree.joints, dtype=str),
        "parents": tree.parents,
        "offsets": tree.offsets,
        "end_joints": np.array(list(tree.ends), dtype=str),
        "ends": np.reshape(list(tree.ends.values()), (-1, 3)),
        "translation": posed.translation,
        "parent_from_joint": posed.parent_from_joint,
    }
    npz.write(path, FORM, _spec(), arrays)


def read(path: StrPath) -> DeviceMotion:
    """Read a `DeviceMotion` from an npz file; raise `InputError` if it is not one."""
    found = npz.read(path, FORM, _spec())
    names, parents, offsets = (found.pop(key) for key in ("hierarchy", "parents", "offsets"))
    ends = dict(zip(found.pop("end_joints").tolist(), found.pop("ends"), strict=True))
    moved = [found.pop(key) for key in ("translation", "parent_from_joint")]
    with reading(path, "joints whose parents come before them"):
        tree = Hierarchy(tuple(names.tolist()), parents, offsets, ends)
    posed = PosedHierarchy(tree, found["time_s"], *moved) if len(names) else None
    values: dict[str, Any] = {
        key: value if value.ndim else value.item() for key, value in found.items()
    }
    return DeviceMotion(**values, posed=posed)


def _spec() -> npz.Spec:
    own = npz.spec_of(DeviceMotion)
    return {key: own[key] for key in own if key != "posed"} | ROTATIONS
