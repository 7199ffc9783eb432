"""The skeleton that one device or one method of a single view gives for a take: a file between rules."""

from dataclasses import dataclass

import numpy as np

from courtside.records import npz
from courtside.study.errors import InputError

FORM = "courtside device motion 1"
SPEC = {
    "source": ("str", ()),
    "kind": ("str", ()),
    "joints": ("str", ("J",)),
    "time_s": ("float", ("T",)),
    "xyz": ("float", ("T", "J", "3")),
    "reason": ("int", ("T", "J")),
    "performed": ("bool", ("T",)),
}


@dataclass(frozen=True, eq=False)
class DeviceMotion:
    """One skeleton over time, in the device's own frame and by its own clock.

    Attributes
    ----------
    source : str
        Where it comes from: `mocopi`, `d415-rgb`, `d415-depth`, `cameras`.
    kind : str
        `inertial`, `rgb`, `rgbd` or `cameras`.
    joints : (J,) str
        Names as in `config/skeletons/`.
    time_s : (T,) float
        Time of each frame on the device's own clock.
    xyz : (T, J, 3) float
        Metres, in the device's own axes; NaN where missing.
    reason : (T, J) uint8
        `courtside.records.keypoints.missing_reason`.
    performed : (T,) bool
        False for frames that nobody performed, like the rest pose in the first row of a mocopi file.
    """

    source: str
    kind: str
    joints: np.ndarray
    time_s: np.ndarray
    xyz: np.ndarray
    reason: np.ndarray
    performed: np.ndarray

    def joint(self, name):
        """Return the path (T, 3) of a joint, metres; raise `ValueError` if there is none of that name."""
        return self.xyz[:, list(self.joints).index(name)]


def of_truth(truth, person):
    """Return a person of a virtual take as a source that misses nothing.

    Parameters
    ----------
    truth
        Has joints (J,), person_id (P,), time_s (T,), xyz (P, T, J, 3), metres.
    person : str
    """
    xyz = truth.xyz[list(map(str, truth.person_id)).index(person)]
    complete = np.ones(len(truth.time_s), dtype=bool)
    reason = np.zeros(xyz.shape[:2], dtype=np.uint8)
    return DeviceMotion("truth", "cameras", truth.joints, truth.time_s, xyz, reason, complete)


def of_person(points, person, source="cameras"):
    """Return one person of the fixed cameras as a source beside devices.

    Parameters
    ----------
    points : courtside.records.keypoints.keypoints.Keypoints3D
    person : str
    source : str

    Returns
    -------
    motion : DeviceMotion
        In world, on the cameras' reference clock.

    Raises
    ------
    InputError
        If there is no such person.
    """
    known = points.person_id.tolist()
    if person not in known:
        raise InputError(
            f"person {person}: expected one of {known} of the fixed cameras; name the subject of the devices"
        )
    at = known.index(person)
    return DeviceMotion(
        source=source,
        kind="cameras",
        joints=points.joints,
        time_s=points.time_s,
        xyz=points.xyz[at],
        reason=points.reason[at],
        performed=np.ones(len(points.time_s), dtype=bool),
    )


def write(path, motion):
    """Write a `DeviceMotion` to an npz file."""
    npz.write(path, FORM, SPEC, vars(motion))


def read(path):
    """Read a `DeviceMotion` from an npz file; raise `InputError` if it is not one."""
    arrays = npz.read(path, FORM, SPEC)
    return DeviceMotion(
        **{key: str(value) if value.ndim == 0 else value for key, value in arrays.items()}
    )
