"""Write video files: H.264 whose frames have exact times, the same bytes for the same pictures.

PyAV encodes rather than OpenCV, whose wheels have no H.264 encoder.
"""

import itertools
from collections.abc import Iterable, Sequence
from fractions import Fraction

import av
import cv2
import numpy as np
from av.error import FFmpegError
from numpy.typing import NDArray

from courtside.study.errors import StrPath, reading
from courtside.study.execution.files import atomic

KEYFRAME_EVERY = 12  # frames: seeking decodes no more than these
LARGEST_DENOMINATOR = 10_000  # keeps the container's clock far below its 32 bits
TICKS_HZ = 90_000  # clock of uneven frames, as of MPEG: whole ticks at all usual rates


def write_video(
    path: StrPath,
    frames: Iterable[NDArray],
    rate_hz: float,
    *,
    crf: float,
    effort: str = "medium",
    times_s: Sequence[float] | NDArray | None = None,
) -> int:
    """Write pictures as H.264 in yuv420p; return how many.

    One thread: with more, x264 divides the bits among the frames differently from run to run. No
    macroblock tree: with AVX-512, x264's reads memory that is not its own, and no two runs are
    alike. Raises `ValueError` if there is no frame, a frame is not such a picture, the rate is not
    positive, or times do not increase or are not as many as frames, `InputError` if the disk
    refuses the file.

    Parameters
    ----------
    path : its suffix chooses the container; the file appears under its name only when whole
    frames : (H, W, 3) uint8; BGR, all of one even size; frame k is shown at k / `rate_hz`
    crf : constant rate factor of x264: 0 loses only what yuv420p loses, 18 looks lossless, 28 poor
    effort : preset of x264: "veryfast" takes a third of the time of "medium"
    times_s : when each frame is shown, as differences from the first, to 1/90000 s; `rate_hz` is
        then the mean rate
    """
    if not 0 < rate_hz < np.inf:
        raise ValueError(f"expected a positive rate_hz, found {rate_hz}")
    frames = iter(frames)
    first = next(frames, None)
    if first is None:
        raise ValueError(f"{path}: expected at least one frame, found none")
    _check(first, np.shape(first))
    rate = Fraction(rate_hz).limit_denominator(LARGEST_DENOMINATOR)
    ticks = None if times_s is None else _ticks(times_s)
    with (
        reading(path, "to write a video", "free or allow the space", kinds=(FFmpegError,)),
        atomic(path) as temporary,
        av.open(str(temporary), "w") as container,
    ):
        tick_s = 1 / rate if times_s is None else Fraction(1, TICKS_HZ)
        stream = _stream(container, first.shape, rate, tick_s, crf, effort)
        return _encode(container, stream, itertools.chain([first], frames), ticks)


def _ticks(times_s) -> list[int]:
    ticks = np.rint((np.asarray(times_s) - times_s[0]) * TICKS_HZ)
    if not (np.diff(ticks) > 0).all():
        raise ValueError("expected increasing times of frames")
    return ticks.astype(int).tolist()


def _stream(container, shape, rate, tick_s, crf, effort):
    options = {"preset": effort, "crf": str(crf), "g": str(KEYFRAME_EVERY)}
    options |= {"threads": "1", "mbtree": "0"}
    stream = container.add_stream("libx264", rate=rate, options=options)
    stream.height, stream.width, _ = shape
    stream.pix_fmt = "yuv420p"
    stream.codec_context.time_base = tick_s
    return stream


def _encode(container, stream, frames, ticks) -> int:
    count, shape = 0, (stream.height, stream.width, 3)
    for count, image in enumerate(frames, start=1):
        _check(image, shape)
        # FFmpeg's own conversion is up to 5 grey levels off.
        planes = cv2.cvtColor(np.ascontiguousarray(image), cv2.COLOR_BGR2YUV_I420)
        picture = av.VideoFrame.from_ndarray(planes, format="yuv420p")
        if ticks and count > len(ticks):
            break
        picture.pts = ticks[count - 1] if ticks else count - 1
        picture.time_base = stream.codec_context.time_base
        container.mux(stream.encode(picture))
    if ticks and count != len(ticks):
        raise ValueError(f"expected a time for each frame, found {len(ticks)} times")
    container.mux(stream.encode())
    return count


def _check(image: NDArray, shape: tuple[int, ...]) -> None:
    if image.dtype != np.uint8 or image.ndim != 3 or image.shape[2] != 3:
        raise ValueError(f"expected 8-bit BGR pictures, found {image.dtype} {image.shape}")
    if image.shape != tuple(shape):
        raise ValueError(f"expected pictures of one size {tuple(shape)}, found {image.shape}")
    if image.shape[0] % 2 or image.shape[1] % 2 or 0 in image.shape:
        raise ValueError(f"expected an even width and height for yuv420p, found {image.shape[:2]}")
