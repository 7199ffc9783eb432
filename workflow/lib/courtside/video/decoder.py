"""Decode video, report every lost or damaged frame, and turn pictures upright.

Every decoded frame is compared with the list of packets. No decoder can detect altered bytes that
still decode: they are rare in H.264 and MPEG-4 and common in MJPEG, VP8 and VP9, which carry no
redundancy.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from pathlib import Path

import av
import numpy as np
from av.error import FFmpegError
from av.video.reformatter import Interpolation, VideoReformatter
from numpy.typing import NDArray

from courtside.study.errors import InputError, reading
from courtside.video.packets import Listing, damage, opened, raise_logged

STRICT = {"err_detect": "crccheck+bitstream+buffer+explode"}
ONE = 65536  # display matrices are in 16.16 fixed point
# Opening a file and seeking in it take as long as decoding some ten frames.
MIN_SKIPPED = 12  # frames


class _DamageError(Exception):
    """The frame with this index cannot be trusted."""

    def __init__(self, index: int, why: str) -> None:
        super().__init__(why)
        self.index = index


def decode_checked(listing: Listing, first: int, stop: int) -> Iterator[tuple[int, av.VideoFrame]]:
    """Decode the frames `first` to `stop - 1` on one thread, each checked against the packets.

    `first` and `stop`, `first < stop`, are indices into `listing.pts`. Each frame comes with its
    index, as stored: not turned upright, in its own pixel format. Raises `InputError` at the first
    missing or damaged frame, after those before it.
    """
    keys = listing.key_pts[listing.key_pts <= listing.pts[first]].tolist()
    key = int(np.searchsorted(listing.pts, keys[-1])) if keys else 0
    # A seek may land too late, and a decoder may need to start before the nearest key frame. Then
    # try two key frames earlier, and at last the start of the file.
    seeks = [None] if listing.by_order else [*keys[:0:-2][:2], None]
    for seek in seeks:
        done = first
        try:
            for index, frame in _in_order(listing, key, stop, seek):
                if first <= index < stop:
                    yield index, frame
                    done = index + 1
            return
        except _DamageError as error:
            if seek is None or done > first:
                raise InputError(damage(listing, error.index, str(error))) from error


def _in_order(listing, key, stop, seek) -> Iterator[tuple[int, av.VideoFrame]]:
    """Yield index and frame from the key frame on; raise at the first unexpected one.

    A frame waits until all that were decoded before it have come out undamaged, because it may
    depend on one that is shown later.
    """
    expected = 0 if listing.by_order else key
    last = listing.leans_on[expected:stop].max()
    held: deque[tuple[int, av.VideoFrame]] = deque()
    why = "frame {} is missing"
    try:
        for frame in _decode(listing, int(listing.pts[expected]), seek):
            if not listing.by_order and frame.pts != listing.pts[expected]:
                break
            if frame.is_corrupt:
                why = "frame {} is damaged"
                break
            held.append((expected, frame))
            while held and listing.leans_on[held[0][0]] <= expected:
                yield held.popleft()
            if expected == last:
                return
            expected += 1
    except FFmpegError as error:
        why = f"frame {{}} or one soon after it does not decode ({error.strerror})"
    raise _DamageError(held[0][0] if held else expected, why.format(expected))


def _decode(listing: Listing, key_pts: int, seek: int | None) -> Iterator[av.VideoFrame]:
    """Yield the decoded frames from the key frame on; faults before it are ignored."""
    with opened(listing.path) as (container, stream):
        context = stream.codec_context
        context.options = STRICT
        context.thread_count = 1
        if seek is not None:
            container.seek(seek, stream=stream)
        n_logged = av.logging.get_last_error()[0]
        for packet in container.demux(stream):
            cut = listing.problem and packet.dts is not None and packet.dts > listing.last_dts
            if cut or packet.is_corrupt:
                yield from context.decode(None)
                return
            try:
                decoded = packet.decode()
                raise_logged(n_logged)
            except FFmpegError:
                if packet.pts is not None and packet.pts < key_pts:
                    n_logged = av.logging.get_last_error()[0]
                    continue
                raise
            yield from (f for f in decoded if f.pts is None or f.pts >= key_pts)


def pictures(listing: Listing, wanted: Sequence[int]) -> Iterator[tuple[int, NDArray]]:
    """Decode wanted frames into upright pictures; long stretches between them are skipped.

    `wanted` are one or more increasing indices into `listing.pts`. Pictures (H, W, 3) uint8, BGR,
    come with their indices. Raises `InputError` as `decode_checked`, for frames that are decoded;
    also if the size changes.
    """
    reformatter, matrix = VideoReformatter(), None
    shape, rest = None, iter(wanted)
    target: int | None = next(rest)
    for index, frame in _decode_around(listing, wanted):
        if index != target:
            continue
        target = next(rest, None)
        # It holds for the whole stream; reading it keeps a frame until garbage is collected.
        if matrix is None:
            matrix = display_matrix(listing.path, frame)
        with reading(listing.path, "pictures that fit the memory", kinds=(MemoryError,)):
            image = _picture(frame, reformatter, matrix)
        if shape is not None and image.shape != shape:
            raise InputError(
                f"{listing.path}: expected pictures of one size, {shape[1]}x{shape[0]}, found "
                f"{image.shape[1]}x{image.shape[0]} at frame {index}: "
                "export the video again at one size"
            )
        shape = image.shape
        yield index, image


def _decode_around(listing: Listing, wanted: Sequence[int]) -> Iterator[tuple[int, av.VideoFrame]]:
    """Decode the wanted frames, and those between unless a later key frame saves many of them."""
    indices = np.asarray(wanted)
    keys = np.append(0, np.searchsorted(listing.pts, listing.key_pts))
    key_before = keys[np.searchsorted(keys, indices, side="right") - 1]
    far = key_before[1:] - indices[:-1] > MIN_SKIPPED
    parts = [indices] if listing.by_order else np.split(indices, np.flatnonzero(far) + 1)
    for part in parts:
        yield from decode_checked(listing, int(part[0]), int(part[-1]) + 1)


def _picture(frame: av.VideoFrame, reformatter: VideoReformatter, matrix: NDArray) -> NDArray:
    """Convert a stored frame into an upright BGR picture."""
    # Bicubic, as OpenCV converts: the pictures are the same to the last bit.
    stored = reformatter.reformat(
        frame, format="bgr24", interpolation=Interpolation.BICUBIC, threads=1
    ).to_ndarray()
    return upright(stored, matrix)


def upright(stored: NDArray, matrix: NDArray) -> NDArray:
    """Turn a stored picture (H, W, ...) as its display matrix says (`display_matrix`)."""
    x_sign, y_sign = matrix.sum(axis=0)
    turned = stored if matrix[0, 0] else stored.swapaxes(0, 1)
    return np.ascontiguousarray(turned[::y_sign, ::x_sign])


def display_matrix(path: Path, frame: av.VideoFrame) -> NDArray:
    """Read how a stored frame is turned and mirrored for display (ISO/IEC 14496-12, section 6.2.2).

    The matrix (2, 2) of -1, 0 and 1 gives `xy_shown = xy_stored @ matrix`, up to a shift. Raise
    InputError, which names `path`, if it is not a rotation by quarters.
    """
    data = frame.side_data.get("DISPLAYMATRIX")
    if data is None:
        return np.eye(2, dtype=int)
    buffer = memoryview(data)  # type: ignore[arg-type]  # PyAV's stubs declare an object
    matrix = np.frombuffer(buffer, np.int32).reshape(3, 3)[:2, :2] / ONE
    rounded = np.rint(matrix).astype(int)
    quarter = np.array_equal(np.abs(rounded).sum(0), [1, 1]) and abs(np.linalg.det(rounded)) == 1
    if not quarter or np.abs(matrix - rounded).max() > 0.01:
        raise InputError(
            f"{path}: expected a picture turned by quarters, found the display matrix "
            f"{matrix.round(3).tolist()}: export the video again, upright"
        )
    return rounded
