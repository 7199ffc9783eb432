"""One source's skeleton in the body's own frame and unit, on the reference clock: a file between rules."""

from dataclasses import dataclass

import numpy as np

from courtside.records import npz

FORM = "courtside body motion 1"
SPEC = {
    "source": ("str", ()),
    "kind": ("str", ()),
    "joints": ("str", ("J",)),
    "time_s": ("float", ("T",)),
    "fixed": ("float", ("T", "J", "3")),
    "following": ("float", ("T", "J", "3")),
    "reason": ("int", ("T", "J")),
    "unit_m": ("float", ()),
    "tpose_s": ("float", ("2",)),
    "clap_s": ("float", ("C",)),
}


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """A skeleton over time in body axes (x to the left hand, y to the head, z forwards) and units.

    Attributes
    ----------
    source, kind : str
        As of the `DeviceMotion` that it comes from.
    joints : (J,) str
    time_s : (T,) float
        On the reference clock; the source's own frames, only those that somebody performed.
    fixed : (T, J, 3) float
        Units (half the wrist span); in the frame of the T-pose, which stays where it was; NaN where missing.
    following : (T, J, 3) float
        The same in a frame that goes with the trunk.
    reason : (T, J) uint8
        `courtside.records.keypoints.missing_reason`.
    unit_m : float
        Metres in a unit, by this source.
    tpose_s : (2,) float
        When the T-pose of the frame began and ended, on the reference clock.
    clap_s : (C,) float
        The claps that this source shows, on the reference clock.
    """

    source: str
    kind: str
    joints: np.ndarray
    time_s: np.ndarray
    fixed: np.ndarray
    following: np.ndarray
    reason: np.ndarray
    unit_m: float
    tpose_s: np.ndarray
    clap_s: np.ndarray

    def joint(self, name):
        """Return the path (T, 3) of a joint in the fixed frame; raise `ValueError` if there is none."""
        return self.fixed[:, list(self.joints).index(name)]


def write(path, motion):
    """Write a `BodyMotion` to an npz file."""
    npz.write(path, FORM, SPEC, vars(motion))


def read(path):
    """Read a `BodyMotion` from an npz file; raise `InputError` if it is not one."""
    arrays = npz.read(path, FORM, SPEC)
    plain = {"source": str, "kind": str, "unit_m": float}
    return BodyMotion(**{key: plain.get(key, np.asarray)(value) for key, value in arrays.items()})
