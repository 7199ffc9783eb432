"""One source's skeleton in the body's own frame and unit, on the reference clock."""

from dataclasses import dataclass
from typing import Annotated

from numpy.typing import NDArray

from courtside.records import npz
from courtside.study.errors import StrPath

FORM = "courtside body motion 1"


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """A skeleton in units and axes of the body: x to the left hand, y to the head, z forwards."""

    source: str  # of the `DeviceMotion` that it comes from
    kind: str  # of the `DeviceMotion`, too
    joints: Annotated[NDArray, "str J"]
    # On the reference clock; the source's own frames, only those that somebody performed
    time_s: Annotated[NDArray, "float T"]
    # Units (half the wrist span), in the fixed frame of the T-pose; NaN where missing
    fixed: Annotated[NDArray, "float T J 3"]
    following: Annotated[NDArray, "float T J 3"]  # the same in a frame that moves with the trunk
    reason: Annotated[NDArray, "int T J"]  # uint8: codes of `missing_reason`
    unit_m: float  # metres in a unit, by this source
    # Begin and end of the frame's T-pose, on the reference clock; NaN if the frame is that of the
    # rest pose of a device's own model, which nobody performed: then only `following` has a meaning
    tpose_s: Annotated[NDArray, "float 2"]
    clap_s: Annotated[NDArray, "float C"]  # claps that this source shows, on the reference clock

    def joint(self, name: str) -> NDArray:
        """Return the path (T, 3) of a joint in the fixed frame; raise `ValueError` if none."""
        return self.fixed[:, list(self.joints).index(name)]


def write(path: StrPath, motion: BodyMotion) -> None:
    """Write a `BodyMotion` to an npz file."""
    npz.write_record(path, FORM, motion)


def read(path: StrPath) -> BodyMotion:
    """Read a `BodyMotion` from an npz file; raise `InputError` if it is not one."""
    return npz.read_record(path, FORM, BodyMotion)
