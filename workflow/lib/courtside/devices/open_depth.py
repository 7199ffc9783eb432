"""Read a recording of colour and depth in any form that the study knows."""

from pathlib import Path

import numpy as np

from courtside.devices import depth_folder
from courtside.devices.realsense import recording as realsense
from courtside.study.execution import log


def read(path, name):
    """Return the `DepthRecording` of a `.bag` or `.db3` file or a folder of plain files.

    Parameters
    ----------
    path : str or Path
    name : str
        Of the device in the study.

    Raises
    ------
    InputError
        If it is none of these, or damaged.
    """
    return (depth_folder if Path(path).is_dir() else realsense).read(path, name)


def baseline(recording, assumed_m):
    """Return the baseline of the depth camera's imagers, metres: the recording's, else the one assumed."""
    if np.isfinite(recording.baseline_m):
        return recording.baseline_m
    log.logger.info("%s: baseline %g m assumed: the recording has none", recording.name, assumed_m)
    return assumed_m
