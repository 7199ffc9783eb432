"""When each frame of a device's extracted video was taken, on the device's own clock."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.records import tables
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.study.errors import InputError, StrPath

COLUMNS = ("frame_idx", "number", "time_s")
LARGEST = 2**53  # up to here a float holds every whole number exactly


@dataclass(frozen=True, eq=False)
class FrameTimes:
    """The frames of one device stream, and of the constant-rate video made of them."""

    time_s: NDArray  # (T,) float: on the device's clock, increasing
    number: NDArray  # (T,) int: the device's own frame count; a gap is a lost frame

    @property
    def rate_hz(self) -> float:
        """Rate of the video: from the median time between frames; 30 for a single frame."""
        if len(self.time_s) < 2:
            return 30.0  # any rate will do: one frame has no interval
        return float(1 / np.median(np.diff(self.time_s)))


def write(path: StrPath, frames: FrameTimes) -> None:
    """Write frame times as CSV: frame_idx, number, time_s (to the microsecond)."""
    rows = pd.DataFrame(
        {
            "frame_idx": np.arange(len(frames.time_s)),
            "number": frames.number,
            "time_s": np.round(frames.time_s, 6),
        }
    )
    tables.write(path, rows, float_format="%.6f")


def read(path: StrPath) -> FrameTimes:
    """Read frame times; raise `InputError` if the file is no such table."""
    rows = tables.read(path, "a table of frame times", _fault)
    return FrameTimes(rows["time_s"].to_numpy(float), rows["number"].to_numpy(np.int64))


def on_device_clock(view: Keypoints2D, frames_csv: StrPath) -> Keypoints2D:
    """Return the keypoints of a whole extracted video with times on the device's clock.

    Raises `InputError` if the numbers of frames differ.
    """
    frames = read(frames_csv)
    if len(frames.time_s) != len(view.time_s):
        raise InputError(
            f"{frames_csv}: expected {len(view.time_s)} frames, as keypoints of {view.camera} "
            f"have, found {len(frames.time_s)}; detect poses in the whole extracted video"
        )
    return replace(view, time_s=frames.time_s)


def _fault(rows: pd.DataFrame) -> str:
    if tuple(rows.columns) != COLUMNS:
        return f"found columns {list(rows.columns)}"
    numbers = rows.apply(pd.to_numeric, errors="coerce")
    if not np.isfinite(numbers.to_numpy(dtype=float)).all():
        return "found values that are not numbers"
    if (numbers["number"].abs() >= LARGEST).any():
        return "found numbers of frames too large to count to"
    if (np.diff(numbers["time_s"]) <= 0).any():
        return "found times that do not increase"
    return ""
