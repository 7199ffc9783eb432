"""Which recordings of several cameras belong to one take."""

from collections.abc import Iterable, Mapping, Sequence
from datetime import timedelta

from courtside.drafting.names import distinct, words_of
from courtside.drafting.recordings import FOLDERS, Guess, Placed, Recording, Take

# ASSUME: what is started for one take is started within so long.
SLACK = timedelta(seconds=30)


def numbered(found: Guess, rest: Sequence[Placed]) -> list[Placed]:
    """Give numbers to cameras that only counters or moments name, if all is one take."""
    videos = [recording for recording, _, words in rest if not words and recording.device]
    begun = [recording.device.begun for recording in videos if recording.device]
    together = len(videos) < 2 or not all(begun) or len(_moments(videos)) == 1
    if len(videos) != len(rest) or len(videos) < 2 or not together:
        return list(rest)
    found.numbered = [f"cam{number}" for number in range(1, len(videos) + 1)]
    named = zip(videos, found.numbered, strict=True)
    return [(recording, camera, ()) for recording, camera in named]


def _moments(recordings: Iterable[Recording]) -> list[list[Recording]]:
    """Group recordings that were made at one time, as their names tell when they began."""
    groups: list[list[Recording]] = []
    stop = None
    stamped = [(r.device.begun, r) for r in recordings if r.device and r.device.begun]
    for begun, recording in sorted(stamped, key=lambda pair: pair[0]):
        if stop is None or begun > stop:
            groups.append([])
            stop = begun + max(SLACK, timedelta(seconds=recording.duration_s or 0))
        groups[-1].append(recording)
    return groups


def group(found: Guess, rest: Iterable[Placed]) -> None:
    """Group recordings into takes: by the words other than the camera's, else by their order."""
    takes: dict[str, Take] = {}
    left: dict[str, list[Recording]] = {}
    for recording, camera, words in _with_counters(list(rest)):
        if camera is None:
            found.unused.append((recording, _nameless(recording)))
            continue
        take = takes.setdefault("_".join(words), {})
        if camera in take:
            found.unused.append((recording, f"its take has {take[camera].path} of that camera"))
        else:
            take[camera] = recording
    for shared, take in takes.items():
        if len(take) > 1:
            name = shared or _shared_name(take) or "take1"
            found.takes[distinct(name, found.takes)] = take
            continue
        for camera, recording in take.items():
            left.setdefault(camera, []).append(recording)
    _pair(found, left)


def _with_counters(rest: Sequence[Placed]) -> list[Placed]:
    """Add counters and moments to the words of recordings of one camera that are else alike."""
    seen: dict[tuple[str | None, tuple[str, ...]], int] = {}
    for _, camera, words in rest:
        seen[camera, words] = seen.get((camera, words), 0) + 1
    repeated = {words for (_, words), count in seen.items() if count > 1}
    return [
        (r, c, (*words, r.device.mark) if words in repeated and r.device else words)
        for r, c, words in rest
    ]


def _nameless(recording: Recording) -> str:
    if recording.device is None:
        return "no other video has a name like it"
    return "its name tells no camera; put the videos of each camera into a folder named after it"


def _shared_name(take: Take) -> str:
    """Return what the names of a take's files share, without folders."""
    said = [
        words_of([r.device.before, r.device.after] if r.device else r.parts[-1:])
        for r in take.values()
    ]
    shared = set.intersection(*map(set, said)) - FOLDERS
    return "_".join(word for word in said[0] if word in shared)


def _pair(found: Guess, left: Mapping[str, Sequence[Recording]]) -> None:
    """Make recordings of one time one take, if all names tell it; else those of one order."""
    every = [recording for own in left.values() for recording in own]
    camera_of = {recording.path: camera for camera, own in left.items() for recording in own}
    if all(recording.device and recording.device.begun for recording in every):
        for group in _moments(every):
            take = {camera_of[recording.path]: recording for recording in group}
            if len(take) == len(group) > 1:
                found.takes[distinct(f"take{len(found.takes) + 1}", found.takes)] = take
            else:
                _leave(found, group, camera_of)
    elif len(left) > 1 and len({len(own) for own in left.values()}) == 1:
        for at, together in enumerate(zip(*left.values(), strict=True), start=1):
            name = distinct(f"take{at}", found.takes)
            found.takes[name] = dict(zip(left, together, strict=True))
    else:
        _leave(found, every, camera_of)


def _leave(found: Guess, recordings: Iterable[Recording], camera_of: Mapping[str, str]) -> None:
    for recording in recordings:
        why = f"the only recording of its take, by camera {camera_of[recording.path]}"
        found.unused.append((recording, why))
