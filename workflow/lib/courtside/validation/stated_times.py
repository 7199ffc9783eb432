"""Times and pixels that a session states of its videos, against the videos."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations
from math import inf
from os.path import normpath
from pathlib import Path

from courtside.records.devices import clocks
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import sightings
from courtside.study.configuration.sessions import Session, Take
from courtside.study.errors import InputError
from courtside.video.glance import Glance

Looks = Mapping[str, Glance]  # by camera


def faults(session: Session, take: Take, looks: Looks) -> Iterator[str]:
    """Yield what cannot be right: parts, sightings and clocks outside of the videos."""
    yield from _late_starts(take, looks)
    yield from _clocks(take, looks)
    for name in take.subjects:
        for entry in session.subjects[name].seen:
            look = looks.get(entry["camera"])
            if look and entry.get("take", take.name) == take.name:
                where = f"subjects.{name}.seen: expected"
                yield from (f"{where} {line}" for line in _sighting(take, entry, look))


def named(session: Session, looks: Mapping[str, Looks]) -> Iterator[str]:
    """Yield what is wrong with the file in which persons are named; `looks` are by take.

    A row of a take that the session does not have would name nobody.
    """
    path = session.people
    if path is None or not Path(path).is_file():
        return
    try:
        sightings.every_row(path, [*session.takes, *session.withheld])
        for name, take in session.takes.items():
            for one in sightings.read(path, name, take.subjects, take.cameras):
                entry = {"camera": one.camera, "time_s": one.time_s, "at_px": one.xy}
                look = looks[name].get(one.camera)
                lines = _sighting(take, entry, look) if look else ()
                yield from (f"{one.where}: expected {line}" for line in lines)
    except InputError as error:
        yield from error.lines


def repeated(sessions: Iterable[Session]) -> Iterator[str]:
    """Yield takes that use the same part of a recording, as copied lines of a file do.

    Of takes of two sessions only the first: a session may be measured twice on purpose.
    """
    takes = [(one, take, _recordings(take)) for one in sessions for take in one.takes.values()]
    told = set()
    for (here, one, own), (there, other, others) in combinations(takes, 2):
        same = [key for key, path in own.items() if path in others.values()]
        (start_s, stop_s), (begin_s, end_s) = (t.trim_s or (0.0, inf) for t in (one, other))
        if not same or max(start_s, begin_s) >= min(stop_s, end_s):
            continue
        if here is there or (here.name, there.name) not in told:
            where = "" if here is there else f" of {there.file}"
            yield (
                f"{here.file}: takes.{one.name} and takes.{other.name}{where}: the same "
                f"{', '.join(same)}{_advice(same)}"
            )
        told.add((here.name, there.name))


def _advice(same: Iterable[str]) -> str:
    """Return what to do about the same recordings, by their keys; `trim_s` does not cut devices."""
    paths = ": if they are two recordings, correct one path"
    if all(key.startswith("devices.") for key in same):
        return paths
    return f", and their times overlap{paths}; if one video has both, state a `trim_s` of each"


def _recordings(take: Take) -> dict[str, str]:
    """Return the paths of all recordings of a take by their keys."""
    recordings = {f"videos.{name}": path for name, path in take.videos.items()}
    recordings |= {f"devices.{name}": device.file for name, device in take.devices.items()}
    for key, imported in (("pose2d", take.pose2d), ("pose3d", take.pose3d)):
        for skeleton, files in imported.items():
            recordings |= {f"{key}.{skeleton}.{name}": path for name, path in files.items()}
    return {key: normpath(path) for key, path in recordings.items()}


def remarks(take: Take, looks: Looks) -> Iterator[str]:
    """Yield what may be right, but is worth a look: parts that end after all videos, or differ."""
    yield from _shared(take, looks)
    lengths = [look.duration_s for look in looks.values()]
    longest = max((length for length in lengths if length), default=0.0)
    frame_s = max((1 / look.rate_hz for look in looks.values() if look.rate_hz), default=0.0)
    start_s, stop_s = take.trim_s or (0.0, 0.0)
    if None not in lengths and start_s < longest < stop_s - frame_s:
        yield (
            f"trim_s ends at {stop_s:g} s, but no video is longer than {longest:.2f} s: all are "
            "used to their ends; trim_s is in seconds, not in frames"
        )


def _late_starts(take: Take, looks: Looks) -> Iterator[str]:
    for camera, look in looks.items():
        if take.trim_s and look.duration_s and take.trim_s[0] >= look.duration_s:
            yield (
                f"trim_s: expected a start within {take.videos[camera]}, which lasts "
                f"{look.duration_s:.3f} s, found {take.trim_s[0]:g} s; correct it"
            )


def _sighting(take: Take, entry: Mapping, look: Glance) -> Iterator[str]:
    """Yield the faults of an entry of `seen`, as `reconstruction.association.marks` states them."""
    start_s, stop_s = take.trim_s or (0.0, float("inf"))
    stop_s = min(stop_s, look.duration_s or float("inf"))
    slack_s = 1 / look.rate_hz if look.rate_hz else 0.0
    camera, time_s, (x, y) = entry["camera"], entry["time_s"], entry["at_px"]
    if not start_s - slack_s <= time_s <= stop_s + slack_s:
        yield (
            f"time_s from {start_s:.2f} to {stop_s:.2f} s, the part of {camera}'s video that is "
            f"used, found {time_s:g}; state the time in seconds, not the frame"
        )
    width, height = look.size
    if not (-0.5 <= x <= width - 0.5 and -0.5 <= y <= height - 0.5):
        yield (
            f"a pixel of {camera}'s pictures of {width} x {height} px, found ({x:g}, {y:g}); "
            "correct at_px"
        )


def _clocks(take: Take, looks: Looks) -> Iterator[str]:
    """Yield cameras whose stated clock puts what is used of their video outside of all others'."""
    own = _stated(take)
    # A part may overlap that of a camera whose clock is found later.
    trim_s = take.trim_s if set(take.videos) <= set(own) else None
    parts = _used(take, looks, trim_s)
    spans = {name: own[name].to_reference(part).tolist() for name, part in parts.items()}
    for name in (name for name in take.clocks if name in spans and len(spans) > 1):
        others = [span for other, span in spans.items() if other != name]
        start, stop = spans[name]
        if all(stop <= first or last <= start for first, last in others):
            used = "the part by `trim_s` of its video" if trim_s else "its video"
            remedy = f", or a longer trim_s: {clocks.ON_OWN_CLOCK}" if trim_s else ""
            yield (
                f"clocks.{name}: expected an offset with which {used} of {stop - start:.2f} s "
                f"overlaps that of another camera, found offset_s "
                f"{take.clocks[name]['offset_s']:g}; state the offset in seconds{remedy}"
            )


def _shared(take: Take, looks: Looks) -> Iterator[str]:
    """Yield whether `trim_s` cuts different times out of videos whose clocks are stated."""
    used = _used(take, looks, take.trim_s)
    if take.trim_s and len(used) > 1 and (line := clocks.little_shared(used, _stated(take))):
        yield line


def _used(
    take: Take, looks: Looks, trim_s: tuple[float, ...] | None
) -> dict[str, tuple[float, float]]:
    """Return what is used of the videos whose clock is stated (start, stop), on their own clock."""
    start_s, stop_s = trim_s or (0.0, inf)
    ends_s = {n: min(stop_s, looks[n].duration_s or 0.0) for n in _stated(take) if n in looks}
    return {name: (start_s, end_s) for name, end_s in ends_s.items() if start_s < end_s}


def _stated(take: Take) -> dict[str, Clock]:
    """Return the clocks that the take states, the reference's first."""
    return {name: Clock() for name in list(take.videos)[:1]} | clocks.stated(take.clocks)
