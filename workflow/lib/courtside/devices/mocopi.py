"""mocopi: the BVH files of its app -> the motion of its 27 joints, by the study's names.

The axes stay the app's: Y up, right-handed, X to the left of a person who faces Z. Its lengths are
centimetres; programs that write its joints may have another unit. Every file of the app opens with
a row that nobody performed: the rest pose of its own model, all rotations zero.
"""

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from courtside.devices import bvh, plausible
from courtside.geometry import rotations
from courtside.geometry.camera_fields import METRES
from courtside.records.devices import hierarchy
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.hierarchy import PosedHierarchy
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import InputError, StrPath
from courtside.study.execution import log

KIND = "inertial"
RATES_HZ = (30.0, 50.0, 60.0)  # of the app
WRITTEN_TO_S = 0.6e-6  # the app writes its frame time with six decimals: 0.016667
# ASSUME: limits of a body from ankles to head, along its bones, about 0.95 of the height: the app
# takes no smaller or larger one.
BODY_M = (0.85, 2.3)
# Three angles of at most 2 pi, read as degrees, turn a joint by less; nobody moves so little.
LEAST_TURN_DEG = 11.0
LEAST_PLACE_S, NO_WAY_M = 2.0, 1e-5  # ASSUME: within this time everybody sways by more
NO_TURN = 1e-6  # rounding: largest entry by which a rotation may differ from the identity


def read(
    path: StrPath,
    skeleton: Skeleton,
    *,
    source: str = "mocopi",
    unit: str | None = None,
    angles: str | None = None,
) -> DeviceMotion:
    """Read a BVH file of the app.

    The `names` of the skeleton, `config/skeletons/mocopi27.yaml`, are the file's. The motion, named
    `source`, has the joints in the skeleton's order; metres in the app's axes; its clock starts at
    zero with the first row. The rest pose in the first row is kept, as not performed. `posed` has
    the joints in the file's order, by the study's names. `unit` is that of its lengths, cm where
    absent; `angles` are `degrees`, `radians`, or, where absent, degrees that are checked. An
    `InputError` if the file is not BVH, its joints are not the skeleton's, it has fewer than two
    frames of motion, or the size of the body, the angles or the rate are not a person's.

    A frame time of 0.016667 s means 1/60 s: as written the clock would run 20 ppm fast. Frame times
    of 30, 50 and 60 frames a second are taken as these; others as written. Times in which every
    row repeats one pose are told, and a root that never leaves its place.
    """
    unit = unit or "cm"
    posed = bvh.read(path, unit_m=METRES[unit], radians=angles == "radians")
    studied = dict(zip(skeleton.device_names(), skeleton.joints, strict=True))
    _check_joints(path, skeleton.name, posed.hierarchy.joints, studied)
    renamed = replace(
        posed.hierarchy,
        joints=tuple(studied[joint] for joint in posed.hierarchy.joints),
        ends={studied[joint]: tip for joint, tip in posed.hierarchy.ends.items()},
    )
    posed = replace(posed, hierarchy=renamed, time_s=_nominal(posed.time_s))
    plausible.check_length(path, "a body from ankles to head", _height_m(posed), unit, BODY_M)
    mend = "correct its line `Frame Time`, which is in seconds"
    plausible.check_rate(path, posed.time_s, mend)
    if angles is None:
        _check_angles(path, posed)
    performed = _performed(path, posed)
    _tell_of_held(path, posed)
    _tell_of_place(path, posed, performed)
    xyz, _ = hierarchy.forward(posed)
    order = [posed.hierarchy.joints.index(joint) for joint in skeleton.joints]
    return DeviceMotion(
        source=source,
        kind=KIND,
        joints=np.array(skeleton.joints),
        time_s=posed.time_s,
        xyz=xyz[:, order],
        reason=np.full(xyz.shape[:2], missing_reason.OK, dtype=np.uint8),
        performed=performed,
        posed=posed,
    )


def _check_joints(path: StrPath, name: str, found: Sequence[str], wanted: Collection[str]) -> None:
    missing = [joint for joint in wanted if joint not in found]
    unknown = [joint for joint in found if joint not in wanted]
    twice = [joint for joint, count in Counter(found).items() if count > 1]
    if missing or unknown or twice:
        faults = {"missing": missing, "unknown": unknown, "twice": twice}
        unmatched = "; ".join(f"{fault}: {', '.join(js)}" for fault, js in faults.items() if js)
        raise InputError(
            f"{path}: expected the {len(wanted)} joints of {name}, found {len(found)}: {unmatched}"
            "; give the file that the app exported, or add the names to the skeleton's file"
        )


def _height_m(posed: PosedHierarchy) -> float:
    """Return the length of the bones from the head to the ankles, metres: in any pose."""
    shape = posed.hierarchy
    moved = posed.translation[0] if len(posed.translation) else shape.offsets
    length = np.linalg.norm(moved, axis=1)

    def to_root(name: str) -> float:
        at, sum_m = shape.joints.index(name), 0.0
        while shape.parents[at] != hierarchy.NO_PARENT:
            sum_m, at = sum_m + length[at], shape.parents[at]
        return sum_m

    return to_root("head") + (to_root("left_ankle") + to_root("right_ankle")) / 2


def _check_angles(path: StrPath, posed: PosedHierarchy) -> None:
    """Raise `InputError` if no joint ever turns as far as a person's do."""
    turns = rotations.angles(posed.parent_from_joint.reshape(-1, 3, 3))
    most_deg = float(np.degrees(turns.max(initial=0.0)))
    if NO_TURN < most_deg < LEAST_TURN_DEG:
        raise InputError(
            f"{path}: expected joints that turn by {LEAST_TURN_DEG:g} degrees or more in some "
            f"frame, found {most_deg:.2g} degrees at most; its angles are likely radians: write "
            "`angles: radians` for this device in the session file, or `angles: degrees` if nobody "
            "moves in it"
        )


def _nominal(time_s: NDArray) -> NDArray:
    """Return the times at the app's exact rate, if the steps round to one of its rates."""
    if len(time_s) < 2:
        return time_s
    for rate_hz in RATES_HZ:
        if abs(time_s[1] - time_s[0] - 1 / rate_hz) < WRITTEN_TO_S:
            return np.arange(len(time_s)) / rate_hz
    return time_s


def _performed(path: StrPath, posed: PosedHierarchy) -> NDArray:
    """Return which rows are motion, (T,) bool: all but a first one without rotations."""
    found = np.ones(len(posed.time_s), dtype=bool)
    found[:1] = (np.abs(posed.parent_from_joint[:1] - np.eye(3)) >= NO_TURN).any()
    if found.sum() < 2:
        raise InputError(
            f"{path}: expected 2 frames of motion or more, without the rest pose of the app's own "
            f"model, found {found.sum()}; record again, or remove the device from the take"
        )
    return found


def _tell_of_held(path: StrPath, posed: PosedHierarchy) -> None:
    spans = [f"{first:.1f} to {last:.1f} s" for first, last in hierarchy.held_s(posed)]
    if spans:
        log.tell(
            f"{Path(path).name}: the same pose in every row from {', '.join(spans)}: the suit lost "
            "its sensors or its link; record again, or do not use these times",
            path,
        )


def _tell_of_place(path: StrPath, posed: PosedHierarchy, performed: NDArray) -> None:
    """Tell of a root that stands still to the last digit: no person's does."""
    root = posed.hierarchy.parents.tolist().index(hierarchy.NO_PARENT)
    place = posed.translation[performed, root][:, [0, 2]]
    time_s = posed.time_s[performed]
    if time_s[-1] - time_s[0] >= LEAST_PLACE_S and (np.ptp(place, axis=0) < NO_WAY_M).all():
        log.tell(
            f"{Path(path).name}: the root is at one place of the floor in every row: the file was "
            "written without the way that the body went; its angles count, but no place, path or "
            "speed: export it with root motion",
            path,
        )
