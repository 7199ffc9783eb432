"""A quick look at a recording: size, frames, rate, and its first picture, made small.

Of an MP4 or MOV file the index is read, of other files the packets for a few seconds, and one
picture is decoded. Whoever decodes the whole file later checks every frame (`decoder`).
"""

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
from av.error import FFmpegError
from numpy.typing import NDArray

from courtside.study.errors import InputError, StrPath
from courtside.study.execution.files import PHOTOS
from courtside.video import images
from courtside.video.decoder import display_matrix, upright
from courtside.video.packets import MEND, list_packets, opened

SMALL_PX = (96, 54)  # width and height of the small picture, whatever the shape of the large
# Frames further apart have a gap between them, in which keypoints are not interpolated: more than a
# dropped frame's 1.5 usual steps, and than 45 ms, half the rate of 50 Hz. Wrists of virtual players
# at strokes, sampled every 33, 40, 50 and 67 ms, are interpolated with errors of 2, 4, 7 and 14 mm
# (root mean square; 95th percentiles 5, 9, 18 and 36 mm): up to here below those of keypoints.
LONGEST_STEP, LONGEST_STEP_S = 1.5, 0.045
LONGEST_S = 3.0  # ASSUME: of reading packets: with opening and one picture below 5 s


@dataclass(frozen=True)
class Glance:
    """What a quick look at a video or a photo tells."""

    size: tuple[int, int]  # width and height of the upright picture, px
    small: NDArray  # (54, 96) uint8: the first picture, grey
    # Of a video; None where the file was too long to be read in time, and of a photo
    n_frames: int | None = None
    rate_hz: float | None = None
    even: bool = True  # whether frames come at regular times, as far as known
    late_s: float = 0.0  # how long the steps between frames lasted that are gaps (`longest_step_s`)
    filmed_hz: float | None = None  # frames per second while filming, where an Android phone says
    interlaced: bool = False
    pixel: float = 1.0  # width over height of a pixel as the file states it

    @property
    def duration_s(self) -> float | None:
        """Seconds from the start of the first frame to the end of the last, of an even rate."""
        return self.n_frames / self.rate_hz if self.n_frames and self.rate_hz else None


def glance(path: StrPath, *, stop_s: float | None = None) -> Glance:
    """Look at a video or a photo.

    A video cut short after `stop_s`, where a take is trimmed to end, is accepted. Raise InputError
    if the file is missing, neither, without a picture that decodes, or cut short.
    """
    path = Path(path)
    if path.suffix.lower() in PHOTOS:
        picture = images.read(path, cv2.IMREAD_GRAYSCALE)
        return Glance((picture.shape[1], picture.shape[0]), _small(picture))
    with opened(path) as (container, stream):
        times = _indexed(container, stream, path.stat().st_size)
        frame = _first_frame(path, container, stream)
        matrix, picture = display_matrix(path, frame), frame.to_ndarray(format="gray")
        said: dict[str, Any] = {"interlaced": bool(frame.interlaced_frame)}
        said |= {
            "filmed_hz": _filmed_hz(container),
            "pixel": float(stream.sample_aspect_ratio or 1),
        }
    if times is None:
        times = _read(path, stop_s)
    picture = upright(picture, matrix)
    return Glance((picture.shape[1], picture.shape[0]), _small(picture), *_rate(times), **said)


def longest_step_s(usual_s: float) -> float:
    """Return the longest time between two frames without a gap, from the usual time."""
    return max(LONGEST_STEP * usual_s, LONGEST_STEP_S)


def _filmed_hz(container) -> float | None:
    """Return the rate that Android's camera states, whatever rate it has written the frames at."""
    try:
        return float(container.metadata["com.android.capture.fps"])
    except (KeyError, ValueError):
        return None


def _first_frame(path: Path, container, stream) -> av.VideoFrame:
    try:
        frame = next(container.decode(stream), None)
    except FFmpegError as error:
        raise InputError(
            f"{path}: expected a picture that decodes, found none ({error.strerror}): {MEND}"
        ) from error
    if frame is None:
        raise InputError(f"{path}: expected a picture that decodes, found none: {MEND}")
    return frame


def _indexed(container, stream, n_bytes: int) -> NDArray | None:
    """Return the times (T,) s of frames by an MP4's index; None where it is not whole."""
    if "mov" not in container.format.name:
        return None
    entries = list(stream.index_entries)
    ends = [entry.pos + entry.size for entry in entries]
    if not ends or len(ends) != stream.frames or max(ends) > n_bytes:
        return None
    ticks = np.sort([entry.timestamp for entry in entries])
    # An edit list hides frames that a phone's trimming has left at the start of the file.
    n_hidden = sum(entry.is_discard for entry in entries)
    return ticks[n_hidden:] * float(stream.time_base)


def _read(path: Path, stop_s: float | None) -> NDArray | None:
    """Return the times (T,) s of frames by the packets; None if reading them takes too long."""
    started_s, n_read = time.monotonic(), 0
    with opened(path) as (container, stream):
        try:
            for _ in container.demux(stream):
                n_read += 1
                if time.monotonic() - started_s > LONGEST_S:
                    return None
        except FFmpegError:
            pass  # told by what reads the file again
    return list_packets(path, stop_s=stop_s).times_s


def _rate(times_s: NDArray | None) -> tuple[int | None, float | None, bool, float]:
    """Return the number of frames, their rate, whether it is even, and how long it is not."""
    if times_s is None:
        return None, None, True, 0.0
    steps_s = np.diff(times_s)
    if not len(steps_s) or steps_s.mean() <= 0:
        return len(times_s), None, True, 0.0
    mean_s = float(steps_s.mean())
    # As of `reader.probe`; a millisecond is the coarsest clock that containers have.
    even = bool(np.abs(steps_s - mean_s).max() <= 0.01 * mean_s + 1.01e-3)
    late = steps_s > longest_step_s(float(np.median(steps_s)))
    return len(times_s), 1 / mean_s, even, 0.0 if even else float(steps_s[late].sum())


def _small(picture: NDArray) -> NDArray:
    return cv2.resize(picture, SMALL_PX, interpolation=cv2.INTER_AREA)
