"""Numbers of frames and rates of the cameras of a take, against each other."""

from collections.abc import Iterator, Mapping

from courtside.video.glance import Glance

# Started and stopped together, cameras differ by one frame; half a frame more for rounding.
SPARE_FRAMES = 1.5


def faults(looks: Mapping[str, Glance], *, synchronised: bool) -> Iterator[str]:
    """Yield what cannot be right in a take, without its name.

    Frames of cameras that share a clock are paired by their times: as many frames in another time
    mean that a file states a wrong rate.
    """
    known = _known(looks)
    if not (synchronised and len(known) > 1):
        return
    rates = {name: look.rate_hz or 0 for name, look in known.items()}
    lengths = {name: look.duration_s or 0 for name, look in known.items()}
    counts = {name: look.n_frames or 0 for name, look in known.items()}
    apart_s = max(lengths.values()) - min(lengths.values())
    alike = max(counts.values()) - min(counts.values()) <= 1
    if alike and apart_s * min(rates.values()) > SPARE_FRAMES:
        yield (
            "expected one rate of cameras that share a clock and have as many frames, found "
            f"{_listed(known, rates, '{:.4g} Hz')}; export the videos again with their true rate, "
            "or say `synchronised: false`"
        )


def remarks(looks: Mapping[str, Glance], *, synchronised: bool) -> Iterator[str]:
    """Yield what may be right, but is worth a look, in a take, without its name."""
    known = _known(looks)
    if len(known) < 2:
        return
    counts = {name: look.n_frames or 0 for name, look in known.items()}
    rates = {name: look.rate_hz or 0 for name, look in known.items()}
    lengths = {name: look.duration_s or 0 for name, look in known.items()}
    apart_s = max(lengths.values()) - min(lengths.values())
    # A video that starts later than the others is as much too early in all its frames.
    if synchronised and apart_s * min(rates.values()) > SPARE_FRAMES:
        yield (
            f"the cameras share a clock, but have {_listed(known, counts, '{} frames')}: right if "
            "all start at the same moment; else state the `clocks` or say `synchronised: false`"
        )
    alike = max(counts.values()) - min(counts.values()) <= 1
    if (
        not synchronised
        and alike
        and apart_s > 0.01 * max(lengths.values()) + 2 / min(rates.values())
    ):
        yield (
            f"the videos have as many frames, but {_listed(known, rates, '{:.4g} Hz')}: does a "
            "file state a wrong rate (slow motion)?"
        )


def _known(looks: Mapping[str, Glance]) -> dict[str, Glance]:
    """Return the videos of even rate whose frames were counted."""
    return {name: look for name, look in looks.items() if look.duration_s and look.even}


def _listed(known: Mapping[str, Glance], values: Mapping[str, float], form: str) -> str:
    """Return the values with their cameras, cameras of one value together."""
    by_value: dict[str, list[str]] = {}
    for name in known:
        by_value.setdefault(form.format(values[name]), []).append(name)
    return ", ".join(f"{value} ({', '.join(names)})" for value, names in by_value.items())
