"""Read the motion that a device measures itself, by the kind of the device."""

from courtside.devices import mocopi, nuitrack
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import StrPath


def read(
    path: StrPath,
    skeleton: Skeleton,
    *,
    device: str,
    kind: str,
    unit: str | None = None,
    angles: str | None = None,
) -> DeviceMotion:
    """Read the recording of `device` with the reader of its kind, which says what is refused.

    A `ValueError` if the kind has no reader here.
    """
    if kind == "inertial":
        return mocopi.read(path, skeleton, source=device, unit=unit, angles=angles)
    if kind == "nuitrack":
        return nuitrack.read(path, skeleton.joints, device, unit=unit)
    raise ValueError(f"{kind}: expected a kind with a reader in devices/open_motion.py")
