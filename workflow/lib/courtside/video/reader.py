"""Read video files: exact frame times and upright pictures.

PyAV decodes rather than OpenCV: pictures and speed are the same (benchmarks/decode_video.py), and
only PyAV gives the time stamp of every packet and mirrored display matrices, and detects damaged or
cut files.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.study.errors import InputError, StrPath, reading
from courtside.study.execution.files import atomic
from courtside.video import images
from courtside.video.decoder import decode_checked, display_matrix, pictures
from courtside.video.packets import Listing, list_packets


@dataclass(frozen=True)
class VideoInfo:
    """Properties of a video file."""

    path: Path
    size: tuple[int, int]  # width and height of the upright picture, px
    n_frames: int | None  # as the container declares them, if it does
    # Frames per second, averaged over the file; NaN for a single frame. Its error is at most the
    # container's tick over its length: Matroska keeps milliseconds.
    rate_hz: float
    rotation_deg: int  # clockwise rotation that makes the stored picture upright: 0, 90, 180 or 270
    duration_s: float  # from the start of the first frame to the end of the last
    # Whether some frame interval differs from the average by more than 1 % and one tick of the
    # container's clock.
    variable_rate: bool


def probe(path: StrPath, *, stop_s: float | None = None) -> VideoInfo:
    """Describe a video file, after checking that no packet of it is missing.

    A file cut short after `stop_s`, where a take is trimmed to end, is accepted. Raise InputError
    if the file is missing, no video, or ends early.
    """
    listing = list_packets(path, stop_s=stop_s)
    _, frame = next(decode_checked(listing, 0, 1))
    (a, b), _ = display_matrix(listing.path, frame)
    intervals = np.diff(listing.pts)
    mean = float(intervals.mean()) if len(intervals) else np.nan
    return VideoInfo(
        path=listing.path,
        size=(frame.width, frame.height) if a else (frame.height, frame.width),
        n_frames=listing.n_declared,
        rate_hz=1 / (mean * float(listing.tick_s)),
        rotation_deg=round(np.degrees(np.arctan2(b, a))) % 360,
        duration_s=listing.duration_s,
        variable_rate=bool(np.any(np.abs(intervals - mean) > 1 + 0.01 * mean)),
    )


def frame_times(path: StrPath, *, stop_s: float | None = None) -> NDArray:
    """Return the time (T,) of every frame before `stop_s`, without decoding one.

    Times are seconds since the first frame, strictly increasing, from the container's time stamps.
    A file cut short after `stop_s` is accepted. Raise InputError if the file is missing, no video,
    ends early, or has no usable time stamps.
    """
    times_s = list_packets(path, stop_s=stop_s).times_s
    return times_s if stop_s is None else times_s[times_s < stop_s]


def frames(
    path: StrPath, *, start_s: float | None = None, stop_s: float | None = None
) -> Iterator[tuple[float, NDArray]]:
    """Decode a video one frame at a time: seconds since its first frame, and picture.

    Pictures are (H, W, 3) uint8, BGR, upright. Only frames with `start_s <= time_s < stop_s` are
    wanted (None: the file's start or end). Raises `InputError` if the file is missing, no video,
    damaged or cut short within the range, or holds no frame in it.
    """
    listing = list_packets(path, stop_s=stop_s)
    for index, image in pictures(listing, in_range(listing, start_s, stop_s)):
        yield float(listing.times_s[index]), image


def in_range(listing: Listing, start_s: float | None, stop_s: float | None) -> range:
    """Return the indices of frames with `start_s <= time_s < stop_s`; an `InputError` for none."""
    times_s = listing.times_s
    first = 0 if start_s is None else int(np.count_nonzero(times_s < start_s))
    stop = len(times_s) if stop_s is None else int(np.count_nonzero(times_s < stop_s))
    if first >= stop:
        raise InputError(
            f"{listing.path}: expected frames from {start_s} s to before {stop_s} s, found none: "
            f"choose a range within the video, which runs from 0 to {listing.duration_s:.3f} s"
        )
    return range(first, stop)


def extract_frames(path: StrPath, every_s: float) -> Iterator[tuple[int, float, NDArray]]:
    """Decode the frames nearest to a regular grid of times: index in the file, time and picture.

    The grid has the time 0 and lies between the first frame and the last. A frame nearest to
    several grid times comes once; of two equally near, the earlier is taken. ValueError if the
    spacing `every_s` is not positive; all else is as for `frames`.
    """
    if not every_s > 0:
        raise ValueError(f"every_s must be positive, not {every_s}")
    listing = list_packets(path)
    times_s = listing.times_s
    last = int(np.floor(times_s[-1] / every_s + 1e-9))
    first = min(int(np.ceil(times_s[0] / every_s)), last)
    wanted = np.unique(_nearest(times_s, every_s * np.arange(first, last + 1)))
    for index, image in pictures(listing, wanted.tolist()):
        yield index, float(times_s[index]), image


def read_frame(path: StrPath, time_s: float) -> tuple[float, NDArray]:
    """Decode the frame nearest to a time in seconds since the first frame.

    Return the frame's own time and its picture (H, W, 3) uint8, BGR, upright. Raise InputError if
    the time lies outside the video, or as for `frames`.
    """
    listing = list_packets(path, stop_s=time_s)
    if not 0 <= time_s <= listing.duration_s:
        raise InputError(
            f"{path}: expected a time from 0 to {listing.duration_s:.3f} s, "
            f"found {time_s}: correct it"
        )
    index = int(_nearest(listing.times_s, time_s))
    _, image = next(pictures(listing, [index]))
    return float(listing.times_s[index]), image


def read_frames(path: StrPath, time_s: ArrayLike) -> Iterator[tuple[float, NDArray]]:
    """Decode the frames nearest to increasing times: each frame's own time and its picture.

    All else is as for `read_frame`; no two times may have one nearest frame (`ValueError`).
    """
    wanted_s = np.atleast_1d(np.asarray(time_s, dtype=float))
    if not len(wanted_s):
        return
    listing = list_packets(path, stop_s=float(wanted_s[-1]))
    if not (wanted_s[0] >= 0 and wanted_s[-1] <= listing.duration_s):
        raise InputError(
            f"{path}: expected times from 0 to {listing.duration_s:.3f} s, found "
            f"{wanted_s[0]:g} to {wanted_s[-1]:g}: correct them"
        )
    indices = _nearest(listing.times_s, wanted_s)
    if (np.diff(indices) <= 0).any():
        raise ValueError(f"{path}: expected times of different frames, found {wanted_s.tolist()}")
    for index, image in pictures(listing, indices.tolist()):
        yield float(listing.times_s[index]), image


def write_png(path: StrPath, image: NDArray) -> None:
    """Write a picture (H, W, 3) BGR or (H, W) grey, uint8; the file appears only when whole.

    Raise InputError if the disk refuses it, ValueError if `image` is not such a picture.
    """
    if image.dtype != np.uint8 or image.ndim not in (2, 3) or image.size == 0:
        raise ValueError(f"not an 8-bit picture: {image.dtype} {image.shape}")
    # Not imwrite: a full disk does not always reach its return value.
    done, data = cv2.imencode(".png", image)
    if not done:
        raise ValueError(f"OpenCV cannot write a picture of shape {image.shape} as PNG")
    what = f"to write {len(data)} bytes"
    with (
        reading(path, what, "free or allow the space", kinds=(OSError,)),
        atomic(path) as temporary,
    ):
        temporary.write_bytes(data)


def sharpness(image: NDArray) -> float:
    """Return the sharpness of a picture (H, W, 3) uint8 BGR: the variance of the grey Laplacian.

    The unit is squared grey levels; larger is sharper. Only pictures of one scene and size compare
    (Pech-Pacheco et al. 2000, Diatom autofocusing in brightfield microscopy).
    """
    return float(cv2.Laplacian(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), cv2.CV_64F).var())


def _nearest(times_s: NDArray, wanted_s: NDArray | float) -> NDArray:
    """Return the index of the time nearest to each wanted one; the earlier of two equally near."""
    return np.searchsorted((times_s[:-1] + times_s[1:]) / 2, wanted_s)


def picture_size(path: StrPath) -> tuple[int, int]:
    """Return width and height of a picture (.png) or of a video's pictures, px."""
    if str(path).endswith(".png"):
        height, width = images.read(path).shape[:2]
        return width, height
    return probe(path).size
