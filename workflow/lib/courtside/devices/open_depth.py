"""Read a recording of colour and depth in any supported form."""

import itertools
from pathlib import Path

import numpy as np

from courtside.devices import depth_folder
from courtside.devices.depth_recording import DepthRecording
from courtside.devices.realsense import recording as realsense
from courtside.records.cameras.frame_times import FrameTimes
from courtside.study.errors import InputError, StrPath
from courtside.study.execution import log

# ASSUME: limits of the middle of what a depth camera sees, metres. Its first pictures may be empty.
DEPTHS_M = (0.1, 50.0)
N_FIRST = 10


def read(path: StrPath, name: str) -> DepthRecording:
    """Read a `.bag` or `.db3` file or a folder of plain files; `name` is the device's in the study.

    Raises `InputError` if it is none of these, damaged, or its depths are in another unit.
    """
    found = (depth_folder if Path(path).is_dir() else realsense).read(path, name)
    _check_unit(path, found)
    return found


def _check_unit(path: StrPath, recording: DepthRecording) -> None:
    least_m, most_m = DEPTHS_M
    for _, steps in itertools.islice(recording.depth_frames(), N_FIRST):
        if steps.any():
            depth_m = float(np.median(steps[steps > 0])) * recording.depth_unit_m
            if not least_m <= depth_m <= most_m:
                mend = "correct `depth_unit_m` in [metadata] of cameras.toml, or export depth again"
                raise InputError(
                    f"{path}: expected depths of {least_m:g} to {most_m:g} m, found a median of "
                    f"{depth_m:.3g} m, with {recording.depth_unit_m:g} m a step; "
                    f"{mend if Path(path).is_dir() else 'record again'}"
                )
            return


def colour_times(path: StrPath, recording: DepthRecording) -> FrameTimes:
    """Return when the colour pictures were taken; raise `InputError` if there are fewer than 2."""
    found = recording.colour_index()
    if len(found.time_s) < 2:
        raise InputError(
            f"{path}: expected 2 colour pictures or more, found {len(found.time_s)}; record longer"
        )
    return found


def baseline(recording: DepthRecording, assumed_m: float) -> float:
    """Return the baseline of the depth camera's imagers, metres: recorded, else assumed."""
    if np.isfinite(recording.baseline_m):
        return recording.baseline_m
    log.logger.info("%s: baseline %g m assumed: the recording has none", recording.name, assumed_m)
    return assumed_m
