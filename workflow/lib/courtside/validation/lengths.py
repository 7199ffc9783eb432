"""Numbers of frames and rates of the cameras of a take, against each other."""

from collections.abc import Iterator, Mapping

from courtside.records.devices.clocks import FEWEST_FRAMES
from courtside.video.glance import Glance

# Started and stopped together, cameras differ by one frame; half a frame more for rounding.
SPARE_FRAMES = 1.5


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
    videos = _Videos(looks)
    if not (synchronised and videos.several and videos.as_many_frames):
        return
    if videos.apart_s * videos.slowest_hz > SPARE_FRAMES:
        yield (
            "expected one rate of cameras that share a clock and have as many frames, found "
            f"{_listed(videos.rates, '{:.4g} Hz')}; export the videos again with their true rate, "
            "or say `synchronised: false`"
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


def _listed(values: Mapping[str, float], form: str) -> str:
    """Return the values with their cameras, cameras of one value together."""
    by_value: dict[str, list[str]] = {}
    for name, value in values.items():
        by_value.setdefault(form.format(value), []).append(name)
    return ", ".join(f"{value} ({', '.join(names)})" for value, names in by_value.items())
