"""The skeleton of a take from one device or one single-view method: a file between rules."""

from dataclasses import dataclass
from os import PathLike
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from courtside.records import npz
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.study.errors import InputError

FORM = "courtside device motion 1"


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

    def joint(self, name: str) -> NDArray:
        """Return the path (T, 3) of a joint, metres; raise `ValueError` if there is none."""
        return self.xyz[:, list(self.joints).index(name)]


def of_truth(truth: Any, person: str) -> DeviceMotion:
    """Return a person of a virtual take as a source without gaps.

    `truth` is a `TakeTruth`; untyped, for methods import this module and must not reach the truth.
    """
    xyz = truth.xyz[list(map(str, truth.person_id)).index(person)]
    complete = np.ones(len(truth.time_s), dtype=bool)
    reason = np.zeros(xyz.shape[:2], dtype=np.uint8)
    return DeviceMotion("truth", "cameras", truth.joints, truth.time_s, xyz, reason, complete)


def of_person(points: Keypoints3D, person: str, source: str = "cameras") -> DeviceMotion:
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
    return DeviceMotion(source, "cameras", points.joints, points.time_s, xyz, reason, complete)


def write(path: str | PathLike, motion: DeviceMotion) -> None:
    """Write a `DeviceMotion` to an npz file."""
    npz.write_record(path, FORM, motion)


def read(path: str | PathLike) -> DeviceMotion:
    """Read a `DeviceMotion` from an npz file; raise `InputError` if it is not one."""
    return npz.read_record(path, FORM, DeviceMotion)
