"""When each frame of a device's extracted video was taken, by the device's own clock."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from courtside.records import tables
from courtside.study.errors import InputError

COLUMNS = ("frame_idx", "number", "time_s")
LARGEST = 2**53  # a whole number, and so is each below


@dataclass(frozen=True, eq=False)
class FrameTimes:
    """The frames of one stream of a device, and of the video made of them, whose rate is constant.

    Attributes
    ----------
    time_s : (T,) float
        By the device's clock, increasing.
    number : (T,) int
        As the device counted them; a gap is a frame that never came.
    """

    time_s: np.ndarray
    number: np.ndarray

    @property
    def n_missing(self):
        """How many frames between the first and the last are missing by their numbers."""
        if not len(self.number):
            return 0
        return int(self.number[-1] - self.number[0] + 1 - len(self.number))

    @property
    def rate_hz(self):
        """Rate of the video: of the device between two frames, by the median; 30 for a single frame."""
        if len(self.time_s) < 2:
            return 30.0
        return float(1 / np.median(np.diff(self.time_s)))


def write(path, frames):
    """Write a `FrameTimes` as CSV: frame_idx, number, time_s (to the microsecond)."""
    rows = pd.DataFrame(
        {
            "frame_idx": np.arange(len(frames.time_s)),
            "number": frames.number,
            "time_s": np.round(frames.time_s, 6),
        }
    )
    tables.write(path, rows, float_format="%.6f")


def read(path):
    """Read a `FrameTimes`; raise `InputError` if the file is none."""
    rows = tables.read(path, "a table of frame times", _fault)
    return FrameTimes(rows["time_s"].to_numpy(float), rows["number"].to_numpy(np.int64))


def on_device_clock(view, frames_csv):
    """Return the keypoints of an extracted video with times by the device's clock.

    Parameters
    ----------
    view : Keypoints2D
        Of all frames of the video.
    frames_csv : str or Path
        As `write` makes it.

    Raises
    ------
    InputError
        If the counts of frames differ.
    """
    frames = read(frames_csv)
    if len(frames.time_s) != len(view.time_s):
        raise InputError(
            f"{frames_csv}: expected {len(view.time_s)} frames, as keypoints of {view.camera} have, found "
            f"{len(frames.time_s)}; detect poses in the whole extracted video"
        )
    return replace(view, time_s=frames.time_s)


def _fault(rows):
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
