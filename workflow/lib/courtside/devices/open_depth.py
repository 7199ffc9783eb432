"""Read a recording of colour and depth in any supported form."""

from pathlib import Path

import numpy as np

from courtside.devices import depth_folder
from courtside.devices.depth_recording import DepthRecording
from courtside.devices.realsense import recording as realsense
from courtside.study.errors import StrPath
from courtside.study.execution import log


def read(path: StrPath, name: str) -> DepthRecording:
    """Read a `.bag` or `.db3` file or a folder of plain files; `name` is the device's in the study.

    Raises `InputError` if it is none of these, or damaged.
    """
    return (depth_folder if Path(path).is_dir() else realsense).read(path, name)


def baseline(recording: DepthRecording, assumed_m: float) -> float:
    """Return the baseline of the depth camera's imagers, metres: recorded, else assumed."""
    if np.isfinite(recording.baseline_m):
        return recording.baseline_m
    log.logger.info("%s: baseline %g m assumed: the recording has none", recording.name, assumed_m)
    return assumed_m
