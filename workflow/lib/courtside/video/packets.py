"""List the packets of a video file: when each frame is shown, and whether the file ends early.

No pixel is decoded, which takes about a hundredth of the time. Some cuts leave no trace: an MPEG
stream (.ts, .mpg) or a live recording without a declared duration, cut between two frames.
"""

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import cast

import av
import numpy as np
from av.error import FFmpegError
from av.stream import Disposition
from numpy.typing import NDArray

from courtside.study.errors import InputError, StrPath

# ffmpeg's Matroska reader, FFV1 decoder and packet reader ("") report damage only in the log.
ONLY_LOG = {"matroska,webm", "ffv1", ""}
# Codecs whose presentation order AVI cannot store: its packets carry no times.
UNORDERED = {"h264", "hevc"}
MEND = "copy the file again from its camera or export it again"

Packet = tuple[int | None, int | None, int | None, bool]  # pts, dts, duration, is key frame


@dataclass(frozen=True)
class Listing:
    """The whole packets of a video file; times in ticks of its clock."""

    path: Path
    pts: NDArray  # (T,) int: when each frame is shown, increasing
    # When the file's first frame is shown; before `pts[0]` if it does not decode: frame n of
    # synchronised cameras is one moment.
    zero: int
    # (T,) int: for each frame, the last shown of those decoded up to it: it may depend on that one.
    leans_on: NDArray
    key_pts: NDArray  # (K,) int: those where decoding can begin
    tick_s: Fraction  # one tick, in seconds
    end: int  # when the last frame's time is over
    n_declared: int | None  # frames as the container declares them
    problem: str  # why the file is shorter than it should be; empty if it is not
    last_dts: int  # decoding time of the last whole packet: no frame up to this time is missing
    by_order: bool  # without a stored presentation order frames are identified by counting only

    @property
    def times_s(self) -> NDArray:
        """Seconds since the first frame of the file, (T,)."""
        return self.seconds(self.pts)

    @property
    def duration_s(self) -> float:
        """Seconds from the start of the first frame to the end of the last."""
        return float(self.seconds(self.end))

    def seconds(self, ticks: int | NDArray) -> NDArray:
        """Convert ticks into seconds since the file's first frame, with one rounding."""
        return (np.asarray(ticks) - self.zero) * self.tick_s.numerator / self.tick_s.denominator


def list_packets(path: StrPath, *, stop_s: float | None = None) -> Listing:
    """List the whole frames of a video file by its packets, without decoding.

    A file cut short after `stop_s`, the end of the wanted part, is accepted. Raise InputError if
    the file is missing, no video, without usable time stamps, or ends before `stop_s`.
    """
    listing = _read_listing(Path(path))
    if not listing.problem:
        return listing
    whole = listing.pts[listing.pts <= listing.last_dts]
    half = (listing.end - listing.pts[-1]) / 2
    if stop_s is None or not len(whole) or not stop_s <= listing.seconds(whole[-1] + half):
        raise InputError(damage(listing, len(whole), listing.problem))
    end = int(whole[-1] + 2 * half)
    leans_on = np.minimum(listing.leans_on[: len(whole)], len(whole) - 1)
    return replace(listing, pts=whole, leans_on=leans_on, end=end)


def raise_logged(n_before: int) -> None:
    """Raise an error that ffmpeg has only logged since its error count was `n_before`.

    The count is that of `av.logging.get_last_error`. Raise av.error.InvalidDataError if the last
    error since then is one that ffmpeg reports in no other way.
    """
    n_logged, last = av.logging.get_last_error()
    if last is not None and n_logged > n_before and last[1] in ONLY_LOG:
        raise av.error.InvalidDataError(0, last[2].strip())


def _read_listing(path: Path) -> Listing:
    """Read all packets and judge them."""
    with opened(path) as (container, stream):
        packets, n_read, problem, start = _whole_packets(container, stream)
        stamped = [(p, d, n, key) for p, d, n, key in packets if p is not None]
        if len(stamped) < len(packets):
            raise InputError(
                f"{path}: expected a time stamp on every frame, found "
                f"{len(packets) - len(stamped)} of {len(packets)} without one: "
                "put the video into a container that has them, such as MP4 or Matroska"
            )
        if not packets:
            raise InputError(f"{path}: expected frames, found {problem or 'none'}: {MEND}")
        # A piece of a recording that was cut up anywhere begins with frames that no decoder can
        # show: they depend on frames before the file. The others keep their times.
        stamped = [packet for packet in stamped if start is None or packet[0] >= start]
        stored = np.array([packet[0] for packet in stamped])
        order = np.argsort(stored, kind="stable")
        pts = stored[order]
        last = max(stamped, key=lambda packet: packet[0])
        end = last[0] + (last[2] or int(np.median(np.diff(pts, prepend=pts[0] - 1))))
        listing = Listing(
            path=path,
            pts=pts,
            zero=min(p for p, *_ in packets if p is not None),
            leans_on=np.maximum.accumulate(np.argsort(order))[order],
            key_pts=np.array(sorted(packet[0] for packet in stamped if packet[3]), dtype=int),
            tick_s=cast(Fraction, stream.time_base),  # None only where nothing was read
            end=end,
            n_declared=stream.frames or None,
            problem=problem or _shortfall(container, stream, n_read, pts, end),
            last_dts=max((p[1] for p in packets if p[1] is not None), default=int(pts[0]) - 1),
            by_order=container.format.name == "avi" and stream.codec_context.name in UNORDERED,
        )
    twice = np.flatnonzero(np.diff(pts) == 0)
    if len(twice):
        time_s = listing.times_s[twice[0]]
        raise InputError(
            f"{path}: expected one frame at a time, found two at {time_s:.3f} s: export it again"
        )
    return listing


def _whole_packets(container, stream) -> tuple[list[Packet], int, str, int | None]:
    """Return the whole packets, how many were read, what was lost, and when the first key frame is.

    That may be one which an edit list hides.
    """
    packets, n_read, corrupt, start = [], 0, False, None
    n_logged = av.logging.get_last_error()[0]
    try:
        for packet in container.demux(stream):
            raise_logged(n_logged)
            if packet.size == 0 and packet.pts is None:
                break  # the demuxer's end marker
            n_read += 1
            corrupt = packet.is_corrupt
            if start is None and packet.is_keyframe:
                start = packet.pts
            if packet.size and not packet.is_discard:
                packets.append((packet.pts, packet.dts, packet.duration, packet.is_keyframe))
    except FFmpegError as error:
        return packets, n_read, f"the file breaks off ({error.strerror})", start
    # The decoder judges damaged packets, but a damaged last one shows where the file was cut.
    if corrupt:
        return packets[:-1], n_read, f"packet {n_read - 1} is cut off and ends the file", start
    return packets, n_read, "", start


def _shortfall(container, stream, n_read, pts, end) -> str:
    """Return how the packets fall short of what the container declares, or an empty text."""
    kind = container.format.name
    n_listed = len(stream.index_entries) if "mov" in kind else 0
    if n_read < n_listed:
        return f"the file ends early: its index lists {n_listed} frames, it holds {n_read}"
    # An AVI counts the frames its recorder dropped, too: count as its time stamps do.
    n_counted = int(pts[-1] - pts[0]) + 1
    if kind == "avi" and n_counted < stream.frames:
        return (
            f"the file ends early: its header declares {stream.frames} frames, it holds {n_counted}"
        )
    if kind == "avi":
        return ""
    declared_s, end_s = _declared_end_s(container, stream), float(end * stream.time_base)
    # The last frame may last as long as any other, and sound may outlast the pictures a little.
    spare_s = 1.5 * float(np.diff(pts).max(initial=1) * stream.time_base)
    if len(container.streams) > 1:
        spare_s += 0.5
    if end_s < declared_s - spare_s:
        return (
            f"the file ends early: it declares a duration of {declared_s:.3f} s, "
            f"its frames end at {end_s:.3f} s"
        )
    return ""


def _declared_end_s(container, stream) -> float:
    """Return when the pictures should end as the container declares it, 0 if it does not."""
    if stream.duration is not None:
        return float(stream.duration * stream.time_base)
    with contextlib.suppress(KeyError, ValueError):
        hours, minutes, seconds = stream.metadata["DURATION"].split(":")
        return 3600 * int(hours) + 60 * int(minutes) + float(seconds)
    return (container.duration or 0) / av.time_base


@contextlib.contextmanager
def opened(path: Path) -> Iterator[tuple[av.container.InputContainer, av.VideoStream]]:
    """Open a video file, for the block, and choose its main stream of pictures.

    Raise InputError if the file is missing, empty, no video, or of a codec without a decoder.
    """
    if not path.is_file():
        raise InputError(f"{path}: expected a video file, found none: correct the path")
    if not path.stat().st_size:
        raise InputError(f"{path}: expected a video, found an empty file: {MEND}")
    av.logging.set_level(av.logging.PANIC)  # ffmpeg's errors are counted, not printed
    with _container(path) as container:
        stream = container.streams.best("video")
        kind = container.format.name
        lack = ""
        if stream is None or stream.disposition & Disposition.attached_pic:
            lack = "sound only: name the camera's file"
        elif kind in ("tty", "image2") or kind.endswith("_pipe"):
            lack = "a single picture or text: name a video"
        elif stream.codec_context is None:
            lack = "a codec that this ffmpeg does not decode: export it as H.264"
        if lack:
            raise InputError(f"{path}: expected a video, found {lack}")
        yield container, cast(av.VideoStream, stream)


def _container(path: Path) -> av.container.InputContainer:
    try:
        # "file:" because ffmpeg takes the part before a colon for a protocol.
        return av.open(f"file:{path}", metadata_errors="replace")
    except FFmpegError as error:
        reason = error.strerror
        if error.log:  # level, name, message
            reason = error.log[2].strip()  # type: ignore[misc]  # PyAV's stub omits the third
        raise InputError(
            f"{path}: expected a video, found a file without a readable header ({reason}): "
            f"it is no video or was cut short; {MEND}"
        ) from error


def damage(listing: Listing, index: int, why: str) -> str:
    """Return one line on what is wrong with a file from frame `index` on, and what to do."""
    if index == 0:
        return f"{listing.path}: {why}; no frame is known to be good: {MEND}"
    time_s = listing.times_s[index - 1]
    trim = f", or trim the take to end before {time_s:.3f} s" if index > 1 else ""
    return (
        f"{listing.path}: {why}; the last good frame is {index - 1} at {time_s:.3f} s: {MEND}{trim}"
    )
