"""Join the chapters into which a camera cuts up a long recording; nothing is encoded again.

ffmpeg's own joining begins a chapter where the longest stream of the one before ends. Sound lasts
a little longer than the pictures, so all later frames would be late.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
from av.error import FFmpegError

from courtside.study.errors import InputError, StrPath, reading
from courtside.study.execution.files import atomic
from courtside.video.decoder import decode_checked, display_matrix
from courtside.video.packets import list_packets, opened

SAME_RATE = 0.01  # relative: more than clocks of milliseconds round a frame interval at 240 Hz
# ASSUME: cameras lose less between two chapters, and more time passes between two recordings.
LONGEST_GAP_S = 1.0
SETTINGS = "settings of the codec"
OTHER = "give chapters of one recording, as the camera wrote them"


@dataclass(frozen=True, eq=False)
class _Chapter:
    path: Path
    first_s: Fraction  # when its first and last frame are shown, by the clock of its file
    last_s: Fraction
    step_s: Fraction  # usual frame interval
    made: dict[str, object]  # what all chapters of one recording share


def join(paths: Sequence[StrPath], joined: StrPath) -> list[float]:
    """Join chapters in their order into a new file, packet by packet; return when each begins, s.

    A chapter begins one frame interval after the last frame of the one before, or later by up to
    1 s where the clock of the files goes on and says so. All sound is kept: that of a chapter
    begins with its pictures, or where the sound before ends. An `InputError` if a chapter is
    damaged, has another size, rotation, codec or rate than the first or frames that are hidden, if
    more than 1 s is missing, or if the container of `joined` cannot hold the streams.
    """
    if Path(joined).exists():
        raise InputError(f"{joined}: expected no file yet, found one; delete it or name another")
    chapters = [_look(Path(path)) for path in paths]
    shifts_s = [-chapters[0].first_s]
    for before, chapter in itertools.pairwise(chapters):
        shifts_s.append(shifts_s[-1] + before.last_s + _gap_s(before, chapter) - chapter.first_s)
    advice = "name it .mp4 or .mov, and have the space for it"
    with (
        reading(joined, "to write a video", advice, kinds=(FFmpegError, ValueError)),
        atomic(joined) as temporary,
        av.open(str(temporary), "w") as out,
    ):
        _copy(out, chapters, shifts_s)
    return [float(c.first_s + shift) for c, shift in zip(chapters, shifts_s, strict=True)]


def _look(path: Path) -> _Chapter:
    """Describe a chapter, after checking that none of its packets is missing."""
    listing = list_packets(path)
    if listing.by_order or len(listing.pts) < 2:
        raise InputError(
            f"{path}: expected a chapter with two frames or more and their times, found "
            + ("an AVI without times" if listing.by_order else "one frame")
            + "; give the file of the camera"
        )
    _, frame = next(decode_checked(listing, 0, 1))
    with opened(path) as (container, stream):
        context, sound = stream.codec_context, _sound(container)
        made = {
            "size": f"{context.width}x{context.height}",
            "codec": context.name,
            "pixel format": context.pix_fmt,
            "rotation": display_matrix(path, frame).tolist(),
            "sound": f"{sound.codec_context.name} {sound.codec_context.sample_rate} Hz"
            if sound
            else "none",
            SETTINGS: context.extradata,
        }
    step = int(np.median(np.diff(listing.pts)))
    first_s, last_s, step_s = (
        t * listing.tick_s for t in (listing.zero, int(listing.pts[-1]), step)
    )
    return _Chapter(path, first_s, last_s, step_s, made)


def _gap_s(before: _Chapter, chapter: _Chapter) -> Fraction:
    """Return the time from the last frame of a chapter to the first of the next."""
    if abs(chapter.step_s / before.step_s - 1) > SAME_RATE:
        raise InputError(
            f"{chapter.path}: expected {float(1 / before.step_s):.4g} Hz, the rate of "
            f"{before.path}, found {float(1 / chapter.step_s):.4g} Hz; {OTHER}"
        )
    for what, expected in before.made.items():
        if chapter.made[what] != expected:
            found, expected = (
                ("others", "") if what == SETTINGS else (chapter.made[what], f", {expected}")
            )
            raise InputError(
                f"{chapter.path}: expected the {what} of {before.path}{expected}, found {found}; "
                f"{OTHER}"
            )
    stated_s = chapter.first_s - before.last_s
    if stated_s > before.step_s + Fraction(LONGEST_GAP_S):
        raise InputError(
            f"{chapter.path}: expected a chapter that begins when {before.path} ends, found it "
            f"{float(stated_s):.3f} s later by the clock of both; give it as another recording"
        )
    # Most files begin their clock anew.
    return stated_s if stated_s > before.step_s / 2 else before.step_s


def _copy(out, chapters: Sequence[_Chapter], shifts_s: Sequence[Fraction]) -> None:
    """Copy pictures and sound; the `shifts_s` make one clock of those of the chapters."""
    made: dict[str, Any] = {}
    sound_end_s = Fraction(-1)
    for chapter, shift_s in zip(chapters, shifts_s, strict=True):
        with opened(chapter.path) as (container, pictures):
            streams = [s for s in (pictures, _sound(container)) if s]
            for stream in () if made else streams:
                made[stream.type] = out.add_stream_from_template(stream)
                made[stream.type].time_base = stream.time_base
            shifts_of = {"video": shift_s}
            for packet in container.demux(streams):
                kind = packet.stream.type
                # The demuxer's end marker, and what an encoder puts before the sound.
                if not packet.size or (kind == "audio" and packet.is_discard):
                    continue
                _check(chapter.path, packet)
                if kind not in shifts_of:
                    shifts_of[kind] = max(shift_s, sound_end_s - _start_s(packet))
                _shift(packet, shifts_of[kind])
                if kind == "audio":
                    sound_end_s = _start_s(packet) + (packet.duration or 0) * packet.time_base
                packet.stream = made[kind]
                out.mux(packet)


def _sound(container: av.container.InputContainer) -> av.AudioStream | None:
    return next(iter(container.streams.audio), None)


def _check(path: Path, packet: av.Packet) -> None:
    if packet.is_discard:
        raise InputError(
            f"{path}: expected frames that are all shown, found some that are hidden, as a phone's "
            "trimming leaves them; give the file of the camera"
        )
    if packet.pts is None or packet.dts is None:
        raise InputError(
            f"{path}: expected times at which frames are decoded, found none; write each chapter "
            "as .mp4 first, by `ffmpeg -i IN -c copy OUT.mp4`"
        )


def _start_s(packet) -> Fraction:
    return packet.pts * packet.time_base


def _shift(packet, shift_s: Fraction) -> None:
    shift = round(shift_s / packet.time_base)
    packet.pts, packet.dts = packet.pts + shift, packet.dts + shift
