"""The skeleton that one device or one method of a single view gives for a take: a file between rules."""

from dataclasses import dataclass

import numpy as np

from courtside.records import npz

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
        `courtside.records.reasons`.
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


def write(path, motion):
    """Write a `DeviceMotion` to an npz file."""
    npz.write(path, FORM, SPEC, vars(motion))


def read(path):
    """Read a `DeviceMotion` from an npz file; raise `InputError` if it is not one."""
    arrays = npz.read(path, FORM, SPEC)
    return DeviceMotion(
        **{key: str(value) if value.ndim == 0 else value for key, value in arrays.items()}
    )
