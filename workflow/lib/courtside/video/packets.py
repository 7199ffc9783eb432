"""List the packets of a video file: when every frame is shown, and whether the file ends early.

No pixel is decoded: it costs about a hundredth of decoding. Some cuts leave no trace: an MPEG stream
(.ts, .mpg) or a live recording without a declared duration, cut between two frames.
"""

import contextlib
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from av.error import FFmpegError
from av.stream import Disposition

from courtside.study.errors import InputError

# ffmpeg's Matroska reader, FFV1 decoder and packet reader ("") report damage in the log only.
ONLY_LOG = {"matroska,webm", "ffv1", ""}
# Codecs whose frames AVI cannot put into the order of presentation: its packets carry no times.
UNORDERED = {"h264", "hevc"}
MEND = "copy the file again from its camera or export it again"


@dataclass(frozen=True)
class Listing:
    """The whole packets of a video file; times in ticks of its clock.

    Attributes
    ----------
    path : Path
        The file.
    pts : (T,) int
        When each frame is shown, increasing.
    leans_on : (T,) int
        For each frame, the last shown of those decoded up to it: its picture may depend on that one.
    key_pts : (K,) int
        Those where decoding can begin.
    tick_s : Fraction
        One tick, in seconds.
    end : int
        When the last frame's time is over.
    n_declared : int or None
        Frames as the container declares them.
    problem : str
        Why the file is shorter than it should be; empty where it is not.
    last_dts : int
        Decoding time of the last whole packet: no frame up to this time is missing.
    by_order : bool
        The container keeps no order of presentation: only counting tells which frame is decoded.
    """

    path: Path
    pts: np.ndarray
    leans_on: np.ndarray
    key_pts: np.ndarray
    tick_s: Fraction
    end: int
    n_declared: int | None
    problem: str
    last_dts: int
    by_order: bool

    @property
    def times_s(self):
        """Seconds since the first frame, (T,)."""
        return self.seconds(self.pts)

    @property
    def duration_s(self):
        """Seconds from the start of the first frame to the end of the last."""
        return float(self.seconds(self.end))

    def seconds(self, ticks):
        """Turn ticks into seconds since the first frame, rounding once."""
        return (ticks - self.pts[0]) * self.tick_s.numerator / self.tick_s.denominator


def list_packets(path, *, stop_s=None):
    """List the frames of a video file by its packets, without decoding.

    Parameters
    ----------
    path : str or Path
        The file.
    stop_s : float or None
        Where the wanted part ends, in seconds; a file cut short after that is accepted.

    Returns
    -------
    listing : Listing
        Only frames that are whole.

    Raises
    ------
    InputError
        If the file is missing, no video, without usable time stamps, or ends before `stop_s`.
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


def raise_logged(n_before):
    """Raise what ffmpeg has only logged since it had logged `n_before` errors.

    Parameters
    ----------
    n_before : int
        Earlier count of `av.logging.get_last_error`.

    Raises
    ------
    av.error.InvalidDataError
        If the last of the errors since then is one that ffmpeg tells in no other way.
    """
    n_logged, last = av.logging.get_last_error()
    if n_logged > n_before and last[1] in ONLY_LOG:
        raise av.error.InvalidDataError(0, last[2].strip())


def _read_listing(path):
    """Read all packets and judge them."""
    with opened(path) as (container, stream):
        packets, n_read, problem = _whole_packets(container, stream)
        if any(packet[0] is None for packet in packets):
            raise InputError(
                f"{path}: expected a time stamp on every frame, found none: "
                "put the video into a container that has them, such as MP4 or Matroska"
            )
        if not packets:
            raise InputError(f"{path}: expected frames, found {problem or 'none'}: {MEND}")
        stored = np.array([packet[0] for packet in packets])
        order = np.argsort(stored, kind="stable")
        pts = stored[order]
        last = max(packets, key=lambda packet: packet[0])
        end = last[0] + (last[2] or int(np.median(np.diff(pts, prepend=pts[0] - 1))))
        listing = Listing(
            path=path,
            pts=pts,
            leans_on=np.maximum.accumulate(np.argsort(order))[order],
            key_pts=np.array(sorted(packet[0] for packet in packets if packet[3]), dtype=int),
            tick_s=stream.time_base,
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


def _whole_packets(container, stream):
    """Return (pts, dts, duration, is key) of the whole packets, how many were read, what was lost."""
    packets, n_read, corrupt = [], 0, False
    n_logged = av.logging.get_last_error()[0]
    try:
        for packet in container.demux(stream):
            raise_logged(n_logged)
            if packet.size == 0 and packet.pts is None:
                break  # the demuxer's sign for the end
            n_read += 1
            corrupt = packet.is_corrupt
            if packet.size and not packet.is_discard:
                packets.append((packet.pts, packet.dts, packet.duration, packet.is_keyframe))
    except FFmpegError as error:
        return packets, n_read, f"the file breaks off ({error.strerror})"
    # A damaged packet amid others is left to the decoder; at the end it is where the file was cut.
    if corrupt:
        return packets[:-1], n_read, f"packet {n_read - 1} is cut off and ends the file"
    return packets, n_read, ""


def _shortfall(container, stream, n_read, pts, end):
    """Say how the packets fall short of what the container declares; empty where they do not."""
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
    # The last frame may last as long as any other, and sound a little longer than the pictures.
    spare_s = 1.5 * float(np.diff(pts).max(initial=1) * stream.time_base)
    if len(container.streams) > 1:
        spare_s += 0.5
    if end_s < declared_s - spare_s:
        return (
            f"the file ends early: it declares a duration of {declared_s:.3f} s, "
            f"its frames end at {end_s:.3f} s"
        )
    return ""


def _declared_end_s(container, stream):
    """Return when the pictures should end by the container's own word, 0 where it is silent."""
    if stream.duration is not None:
        return float(stream.duration * stream.time_base)
    with contextlib.suppress(KeyError, ValueError):
        hours, minutes, seconds = stream.metadata["DURATION"].split(":")
        return 3600 * int(hours) + 60 * int(minutes) + float(seconds)
    return (container.duration or 0) / av.time_base


@contextlib.contextmanager
def opened(path):
    """Open a video file and choose its stream of pictures.

    Parameters
    ----------
    path : Path
        The file.

    Yields
    ------
    container : av.container.InputContainer
        Open within the block.
    stream : av.VideoStream
        The main one, with a decoder.

    Raises
    ------
    InputError
        If the file is missing, empty or no video.
    """
    if not path.is_file():
        raise InputError(f"{path}: expected a video file, found none: correct the path")
    if not path.stat().st_size:
        raise InputError(f"{path}: expected a video, found an empty file: {MEND}")
    av.logging.set_level(av.logging.PANIC)  # ffmpeg's errors are counted, not printed
    try:
        # "file:" because ffmpeg takes what stands before a colon for a protocol.
        container = av.open(f"file:{path}", metadata_errors="replace")
    except FFmpegError as error:
        reason = error.log[2].strip() if error.log else error.strerror
        raise InputError(
            f"{path}: expected a video, found a file without a readable header ({reason}): "
            f"it is no video or was cut short; {MEND}"
        ) from error
    with container:
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
        yield container, stream


def damage(listing, index, why):
    """Word what is wrong with a file from one frame on, and what to do.

    Parameters
    ----------
    listing : Listing
        Of the file.
    index : int
        The first frame that is not good.
    why : str
        What was expected and found.

    Returns
    -------
    message : str
        One line.
    """
    if index == 0:
        return f"{listing.path}: {why}; no frame is known to be good: {MEND}"
    time_s = listing.times_s[index - 1]
    trim = f", or trim the take to end before {time_s:.3f} s" if index > 1 else ""
    return (
        f"{listing.path}: {why}; the last good frame is {index - 1} at {time_s:.3f} s: {MEND}{trim}"
    )
