"""Which recordings of several cameras belong to one take."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from datetime import timedelta

from courtside.drafting.names import distinct, words_of
from courtside.drafting.recordings import FOLDERS, Guess, Placed, Recording, Take

# ASSUME: what is started for one take is started within so long.
SLACK = timedelta(seconds=30)
# ASSUME: counters of one camera that differ by more went from 9999 to 1 between.
ANEW = 9000


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
    for recording, camera, words in _without_counted(found, _with_marks(list(rest))):
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


def _with_marks(rest: Sequence[Placed]) -> list[tuple[Placed, str]]:
    """Add the counter or moment to recordings of one camera whose words are else alike."""
    seen = Counter((camera, words) for _, camera, words in rest)
    repeated = {words for (_, words), count in seen.items() if count > 1}
    return [
        (one, one[0].device.mark if one[2] in repeated and one[0].device else "") for one in rest
    ]


def _without_counted(found: Guess, marked: Sequence[tuple[Placed, str]]) -> list[Placed]:
    """Pair those that counters alone tell apart; return the others, with marks as words.

    Cameras count for themselves: equal counters of two do not mean one take.
    """
    alike: dict[tuple[str, ...], dict[str, list[Recording]]] = {}
    for (recording, camera, words), mark in marked:
        if mark and camera is not None:
            alike.setdefault(words, {}).setdefault(camera, []).append(recording)
    done = set()
    for words, own in alike.items():
        every = [recording for films in own.values() for recording in films]
        if len(own) > 1 and not all(r.device and r.device.begun for r in every):
            done |= {recording.path for recording in every}
            _pair_in_order(found, own, words)
    rest = [(one, mark) for one, mark in marked if one[0].path not in done]
    return [(r, camera, (*words, mark) if mark else words) for (r, camera, words), mark in rest]


def _pair_in_order(
    found: Guess, own: Mapping[str, Sequence[Recording]], words: Sequence[str] = ()
) -> None:
    """Make the recordings of each camera takes in their order, if all have as many."""
    if len({len(films) for films in own.values()}) > 1:
        counts = ", ".join(f"{camera} {len(films)}" for camera, films in own.items())
        why = (
            f"no name tells which recordings are one take, and the cameras have not as many "
            f"({counts}): remove those of no take, or name the takes in the names of the files"
        )
        found.unused += [(recording, why) for films in own.values() for recording in films]
        return
    in_order = zip(*map(_in_order, own.values()), strict=True)
    for at, together in enumerate(in_order, start=1):
        marks = {recording.device.mark if recording.device else "" for recording in together}
        name = "_".join(words) + str(at) if words else f"take{at}"
        if len(marks) == 1 and any(marks):
            name = "_".join([*words, *marks])
        name = distinct(name, found.takes)
        found.takes[name] = dict(zip(own, together, strict=True))
        found.by_order.append(name)


def _in_order(recordings: Sequence[Recording]) -> list[Recording]:
    """Return recordings of a camera in the order of its counter, which may begin anew."""
    marks = [re.search("[0-9]{4}$", r.device.mark if r.device else "") for r in recordings]
    numbers = {r.path: int(mark[0]) for r, mark in zip(recordings, marks, strict=True) if mark}
    if not all(marks) or max(numbers.values()) - min(numbers.values()) < ANEW:
        return list(recordings)
    return sorted(recordings, key=lambda r: numbers[r.path] < ANEW / 2)


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
        _pair_in_order(found, left)
    else:
        _leave(found, every, camera_of)


def _leave(found: Guess, recordings: Iterable[Recording], camera_of: Mapping[str, str]) -> None:
    for recording in recordings:
        why = f"the only recording of its take, by camera {camera_of[recording.path]}"
        found.unused.append((recording, why))
