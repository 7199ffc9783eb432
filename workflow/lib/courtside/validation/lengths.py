"""Frames, rates and pixels of the cameras of a take, by themselves and against each other."""

from collections.abc import Iterator, Mapping

from courtside.records.devices.clocks import FEWEST_FRAMES
from courtside.video.glance import LONGEST_STEP, LONGEST_STEP_S, Glance

# Started and stopped together, cameras differ by one frame; half a frame more for rounding.
SPARE_FRAMES = 1.5
# ASSUME: filmed so many times faster or slower than written, a video is slow motion or a time
# lapse. In the dark, phones film at half the rate that they state.
SLOWED = 3.0
LATE_SHARE = 0.01  # ASSUME: of a video behind gaps between its frames: more is worth a remark
OBLONG = 0.01  # ASSUME: pixels are square up to this: files round the shape


class _Videos:
    """The videos of a take whose frames come at an even rate and were counted, by camera."""

    def __init__(self, looks: Mapping[str, Glance]) -> None:
        known = {name: look for name, look in looks.items() if look.duration_s and look.even}
        self.rates = {name: look.rate_hz or 0 for name, look in known.items()}
        self.counts = {name: look.n_frames or 0 for name, look in known.items()}
        self.several = len(known) > 1
        if self.several:
            lengths = [look.duration_s or 0 for look in known.values()]
            self.longest_s, self.apart_s = max(lengths), max(lengths) - min(lengths)
            self.slowest_hz = min(self.rates.values())
            self.as_many_frames = max(self.counts.values()) - min(self.counts.values()) <= 1


def faults(looks: Mapping[str, Glance], *, synchronised: bool) -> Iterator[str]:
    """Yield what cannot be right in a take, without its name.

    Frames of cameras that share a clock are paired by their times: as many frames in another time
    mean that a file states a wrong rate.
    """
    yield from _slowed(looks)
    videos = _Videos(looks)
    if not (synchronised and videos.several and videos.as_many_frames):
        return
    if videos.apart_s * videos.slowest_hz > SPARE_FRAMES:
        yield (
            "expected one rate of cameras that share a clock and have as many frames, found "
            f"{_listed(videos.rates, '{:.4g} Hz')}; export the videos again with their true rate, "
            "or say `synchronised: false`"
        )


def _slowed(looks: Mapping[str, Glance]) -> Iterator[str]:
    for name, look in looks.items():
        if not look.filmed_hz or not look.rate_hz:
            continue
        slower = look.filmed_hz / look.rate_hz
        if max(slower, 1 / slower) >= SLOWED:
            yield (
                f"camera {name}: expected frames at {look.filmed_hz:.4g} Hz, as the phone states "
                f"that it filmed, found {look.rate_hz:.4g} Hz in the file (slow motion or a time "
                f"lapse); write it with its true times by `ffmpeg -itsscale {1 / slower:.6g} -i IN "
                "-map 0:v:0 -c copy OUT`"
            )


def oblong(looks: Mapping[str, Glance]) -> Iterator[str]:
    """Yield whether pixels are not square, as all calibrations but files take them to be."""
    for name, look in looks.items():
        if abs(look.pixel - 1) > OBLONG:
            yield (
                f"camera {name}: expected square pixels where no file calibrates the cameras, "
                f"found pixels {look.pixel:.4g} times as wide as high; write every recording of it "
                "again by `ffmpeg -i IN -vf scale=iw*sar:ih,setsar=1 -crf 16 OUT`"
            )


def too_few(looks: Mapping[str, Glance]) -> Iterator[str]:
    """Yield whether videos are too short to find the clocks of their cameras by."""
    counts = {name: look.n_frames for name, look in looks.items() if look.n_frames}
    few = {name: count for name, count in counts.items() if count < FEWEST_FRAMES}
    if few and len(looks) > 1:
        yield (
            f"expected {FEWEST_FRAMES} frames or more of cameras whose clocks are to be found, "
            f"found {_listed(few, '{}')}; record a longer take, state the `clocks` of all cameras "
            "but the first, or say `synchronised: true` if they share a clock"
        )


def remarks(looks: Mapping[str, Glance], *, synchronised: bool) -> Iterator[str]:
    """Yield what may be right, but is worth a look, in a take, without its name."""
    for name, look in looks.items():
        yield from (f"camera {name}: {line}" for line in _odd(look))
    videos = _Videos(looks)
    if not videos.several:
        return
    # A video that starts later than the others is as much too early in all its frames.
    if synchronised and videos.apart_s * videos.slowest_hz > SPARE_FRAMES:
        yield (
            f"the cameras share a clock, but have {_listed(videos.counts, '{} frames')}: right if "
            "all start at the same moment; else state the `clocks` or say `synchronised: false`"
        )
    far = videos.apart_s > 0.01 * videos.longest_s + 2 / videos.slowest_hz
    if not synchronised and videos.as_many_frames and far:
        yield (
            f"the videos have as many frames, but {_listed(videos.rates, '{:.4g} Hz')}: does a "
            "file state a wrong rate (slow motion)?"
        )


def _odd(look: Glance) -> Iterator[str]:
    if look.interlaced:
        yield (
            "the video is interlaced: a frame mixes two moments, if it was not filmed "
            "progressively; write it again at twice the rate by `ffmpeg -i IN -vf "
            "yadif=mode=send_field -crf 16 OUT`"
        )
    if look.duration_s and look.late_s > LATE_SHARE * look.duration_s:
        yield (
            f"{look.late_s:.1f} s of {look.duration_s:.1f} s are gaps between frames, longer than "
            f"{1000 * LONGEST_STEP_S:g} ms and {LONGEST_STEP:g} usual intervals, in which joints "
            "are missing: fix rate and exposure, in more light"
        )


def _listed(values: Mapping[str, float], form: str) -> str:
    """Return the values with their cameras, cameras of one value together."""
    by_value: dict[str, list[str]] = {}
    for name, value in values.items():
        by_value.setdefault(form.format(value), []).append(name)
    return ", ".join(f"{value} ({', '.join(names)})" for value, names in by_value.items())
