"""Recordings of devices that a take names: each is opened as the job that imports it does."""

import functools
from collections.abc import Callable, Iterator
from pathlib import Path

from courtside.records.keypoints import skeleton
from courtside.study.configuration.session_files import is_there
from courtside.study.configuration.sessions import Device, Take
from courtside.study.errors import InputError
from courtside.validation.remembered import Remembered


def faults(
    take: Take, remembered: Remembered, skeleton_file: Callable[[str], Path]
) -> Iterator[str]:
    """Yield why devices of a take cannot be read: suits, depth cameras and Nuitrack.

    Of depth cameras the lenses, the tables of times and the first pictures are read. Files that are
    not there, and single videos, are told elsewhere. `skeleton_file` returns the file of a
    skeleton.
    """
    for name, device in take.devices.items():
        if device.kind == "rgb" or not is_there(Path(device.file)):
            continue
        try:
            how = f"{device.kind} {device.unit} {device.angles}"
            remembered.check(
                device.file, how, functools.partial(_read, name, device, skeleton_file)
            )
        except InputError as error:
            yield from error.lines


def _read(name: str, device: Device, skeleton_file: Callable[[str], Path]) -> None:
    # 0.3 s, which sessions without devices, or with unchanged ones, save
    from courtside.devices import open_depth, open_motion

    if device.skeleton is None:
        open_depth.read(device.file, name)
        return
    joints = skeleton.read(skeleton_file(device.skeleton))
    stated = {"unit": device.unit, "angles": device.angles}
    open_motion.read(device.file, joints, device=name, kind=device.kind, **stated)
