"""One source's skeleton in the body's own frame and unit, on the reference clock."""

from dataclasses import dataclass
from os import PathLike

from numpy.typing import NDArray

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
        Of the `DeviceMotion` that it comes from.
    joints : (J,) str
    time_s : (T,) float
        On the reference clock; the source's own frames, only those that somebody performed.
    fixed : (T, J, 3) float
        Units (half the wrist span), in the fixed frame of the T-pose; NaN where missing.
    following : (T, J, 3) float
        The same in a frame that moves with the trunk.
    reason : (T, J) uint8
        `courtside.records.keypoints.missing_reason`.
    unit_m : float
        Metres in a unit, by this source.
    tpose_s : (2,) float
        Begin and end of the frame's T-pose, on the reference clock.
    clap_s : (C,) float
        The claps that this source shows, on the reference clock.
    """

    source: str
    kind: str
    joints: NDArray
    time_s: NDArray
    fixed: NDArray
    following: NDArray
    reason: NDArray
    unit_m: float
    tpose_s: NDArray
    clap_s: NDArray

    def joint(self, name: str) -> NDArray:
        """Return the path (T, 3) of a joint in the fixed frame; raise `ValueError` if none."""
        return self.fixed[:, list(self.joints).index(name)]


def write(path: str | PathLike, motion: BodyMotion) -> None:
    """Write a `BodyMotion` to an npz file."""
    npz.write(path, FORM, SPEC, vars(motion))


def read(path: str | PathLike) -> BodyMotion:
    """Read a `BodyMotion` from an npz file; raise `InputError` if it is not one."""
    return BodyMotion(**npz.plain(npz.read(path, FORM, SPEC)))
