"""Guess the cameras, walks and takes of a session from the names of its files."""

from collections import Counter
from collections.abc import Container, Iterable, Sequence

from courtside.drafting import camera_words, names, pairing
from courtside.drafting.names import distinct, words_of
from courtside.drafting.recordings import (
    BOARD,
    CALIBRATION,
    CHANGED,
    D435I,
    DEVICES,
    DRAWN,
    FOLDERS,
    RECORDERS,
    STATIC,
    WALK,
    WEBCAM,
    Guess,
    Placed,
    Recording,
    Take,
    Words,
    called,
    is_called_walk,
)


def guess(recordings: Sequence[Recording]) -> Guess:
    """Guess what each recording, in name order, is; every one is in the guess once."""
    found = Guess()
    recordings = _without_others(found, recordings)
    if alone := _single_views(recordings):
        _place_single_views(found, alone)
        recordings = [recording for recording in recordings if recording not in alone]
    filmed = any(r.kind == "video" for r in recordings)
    videos = [r for r in recordings if r.kind == ("video" if filmed else "keypoints")]
    own = _own_words(recordings, videos)
    cameras, found.doubtful = camera_words.of(recordings, videos, own)
    own = camera_words.without_trials(recordings, own, cameras)
    rest = _sort_pictures(found, recordings, own, cameras)
    rest = pairing.numbered(found, rest) if not cameras else rest
    pairing.group(found, rest)
    _place_keypoints(found, recordings, own, cameras)
    found.cameras = [
        name for name in [*cameras, *found.numbered] if name in found.static or found.films(name)
    ]
    _keep_serials(found)
    for camera in [name for name in found.boards if name not in found.cameras]:
        found.unused.append((found.boards.pop(camera), "a chessboard of no camera found"))
    _sort_others(found, recordings, own)
    _rename(found)
    return found


def _without_others(found: Guess, recordings: Iterable[Recording]) -> list[Recording]:
    """Leave out what is neither of the empty court, nor of a walk, nor of a take."""
    kept, names = [], Counter(recording.parts[-1] for recording in recordings)
    marks = {(r.kind, *r.parts[:-1], r.device.mark) for r in recordings if r.device}
    for recording in recordings:
        why = _edited(recording, marks)
        why = why or _what_else(recording, again=names[recording.parts[-1]] > 1)
        if why:
            found.unused.append((recording, why))
        else:
            kept.append(recording)
    return kept


def _edited(recording: Recording, marks: Container[tuple[str, ...]]) -> str:
    """Say why an edited copy is of no use beside the recording itself, in the same folder."""
    original = recording.device.copy_of if recording.device else ""
    if not original or (recording.kind, *recording.parts[:-1], original) not in marks:
        return ""
    return (
        f"an edited copy of {original.upper()}, by its name: its times and size may differ from "
        "those of the recording, which is used"
    )


def _what_else(recording: Recording, *, again: bool) -> str:
    """Say why a recording is of no use: a later chapter, of Pose2Sim's making, of a chessboard.

    `again`: whether another folder has a file of its name, as where one camera films both.
    """
    folders, own = set(words_of(recording.parts[:-1])), words_of(recording.parts[-1:])
    ends = set(own[-1:])
    if recording.device and recording.device.chapter > 1:
        return (
            f"chapter {recording.device.chapter} of a recording that its camera cut up; join the "
            "chapters by `python workflow/join_chapters.py`, and keep them elsewhere"
        )
    if recording.kind == "keypoints" and CHANGED & folders:
        return "keypoints that another program changed; the study needs them as they were detected"
    if recording.kind in ("video", "photos") and "pose" in folders and DRAWN & ends:
        return "another program drew keypoints into it; the study needs the recording itself"
    if "thmbnl" in recording.words:
        return "a small picture that a camera of Sony keeps of a video"
    # `int` may also be an internal rotation, and the walk may be in a folder `calibration`
    board = called(recording, BOARD - {"int"} - CALIBRATION)
    board = board or bool(CALIBRATION & (folders | set(own) if again else set(own)))
    board = board and not called(recording, WALK | STATIC)
    if recording.kind == "video" and board:
        return (
            "of a chessboard or a calibration, by its name; a board that several cameras film "
            "calibrates them (`board: videos`, config/README.md); rename it if it is the walk or "
            "shows a take"
        )
    if recording.kind == "photo" and board:
        return (
            "of a chessboard or a calibration, by its name; put pictures of a chessboard into a "
            "folder of their own, or rename it"
        )
    return ""


def _single_views(recordings: Sequence[Recording]) -> list[Recording]:
    """Return videos and files of devices that are single views, where there is nothing else.

    Beside files of devices one video is a device's, and so are several that all say so, each with a
    name of its own.
    """
    videos = [r for r in recordings if r.kind == "video"]
    others = [r for r in recordings if r.kind in DEVICES]
    used = {*DEVICES, "video", "racket", "unusable"}
    if not videos or not others or any(r.kind not in used for r in recordings):
        return []
    if any(called(video, WALK | STATIC) for video in videos):
        return []
    said = all(WEBCAM in video.words for video in videos)
    apart = len({_take_of(video) for video in videos}) == len(videos)
    return [*videos, *others] if len(videos) == 1 or (said and apart) else []


def _place_single_views(found: Guess, recordings: Iterable[Recording]) -> None:
    """Make files of one name one take; those without a name belong to the only take, if any."""
    named = [(recording, _take_of(recording)) for recording in recordings]
    takes = list(dict.fromkeys(take for _, take in named if take))
    only = takes[0] if len(takes) == 1 else "take1"
    for recording, take in named:
        found.takes.setdefault(take or only, {})
        device = DEVICES.get(recording.kind, WEBCAM)
        found.devices.append((take or only, device, recording))


def _take_of(recording: Recording) -> str:
    """Return what a device recorded, by the words of its name, else of its folder."""
    said = recording.device
    own = words_of(recording.parts[-1:] if said is None else (said.before, said.after))
    for words in (own, words_of(recording.parts[-2:-1])):
        left = list(words)
        while left and (left[-1] in RECORDERS or left[-2:] == D435I):
            left.pop()
        while left and left[0] in RECORDERS:
            left.pop(0)
        if left and not set(left) <= FOLDERS:
            return "_".join(left)
    return ""


def _place_keypoints(
    found: Guess, recordings: Iterable[Recording], own: Words, cameras: Words
) -> None:
    """Put folders of keypoints beside the videos that they were made from; without any, alone."""
    alone = {n: t for n, t in found.takes.items() if any(r.kind == "keypoints" for r in t.values())}
    found.keypoints = dict(alone)
    for recording in (r for r in recordings if r.kind == "keypoints" and not alone):
        camera, words = camera_words.told(own[recording.path], cameras)
        only = len(found.takes) == 1
        near = [n for n in found.takes if only or (words and set(words) <= set(words_of([n])))]
        near.sort(key=lambda name: len(words_of([name])))
        camera = camera if near and camera in found.takes[near[0]] else None
        place = found.keypoints.setdefault(near[0], {}) if near else {}
        _keep(found, place, recording, camera, "keypoints of no camera and take found")
    for name in [n for n, t in found.keypoints.items() if len(t) < len(found.takes[n])]:
        why = f"keypoints of some cameras of take {name} only"
        found.unused += [(recording, why) for recording in found.keypoints.pop(name).values()]


def _own_words(recordings: Iterable[Recording], videos: Sequence[Recording]) -> Words:
    """Return for each path the words that not all videos share: shared words say nothing."""
    shared = set.intersection(*(set(r.words) for r in videos)) if len(videos) > 1 else set()
    shared |= FOLDERS
    return {r.path: tuple(word for word in r.words if word not in shared) for r in recordings}


def _sort_pictures(
    found: Guess, recordings: Sequence[Recording], own: Words, cameras: Words
) -> list[Placed]:
    """Put static recordings, boards and walks into the guess; return the others.

    Of each other recording, which belongs to a take: itself, its camera, and the words left.
    """
    rest: list[Placed] = []
    alone = sum(r.kind == "video" for r in recordings) == 1
    filmed = any(r.kind == "video" for r in recordings)
    kinds = ("video", "photo", "photos") if filmed else ("keypoints", "photo", "photos")
    for recording in (r for r in recordings if r.kind in kinds):
        camera, words = camera_words.told(own[recording.path], cameras)
        if recording.kind == "photos" and called(recording, BOARD):
            _keep(found, found.boards, recording, camera, "a chessboard of no camera found")
        elif recording.kind == "photo" or called(recording, STATIC):
            _keep(found, found.static, recording, camera, "a picture of no camera found")
        elif recording.kind == "keypoints":
            rest.append((recording, camera, words))
        elif recording.kind == "photos" or _is_walk(recording, camera, cameras) or alone:
            counted = words or words_of(recording.parts[-1:])
            wanted = _named("_".join(counted), [recording], "walk")
            wanted = wanted if wanted not in cameras else f"walk_{wanted}"
            found.walks[distinct(wanted, found.walks)] = recording
        else:
            rest.append((recording, camera, words))
    return rest


def _is_walk(recording: Recording, camera: str | None, cameras: Words) -> bool:
    return camera is None and bool(cameras or is_called_walk(recording))


def _keep(found: Guess, place: Take, recording: Recording, camera: str | None, reason: str) -> None:
    if camera is None:
        found.unused.append((recording, reason))
    elif camera in place:
        found.unused.append((recording, f"camera {camera} has {place[camera].path} already"))
    else:
        place[camera] = recording


def _keep_serials(found: Guess) -> None:
    for camera in found.cameras:
        films = found.films(camera)
        if films and films[0].device and films[0].device.serial:
            found.serials[camera] = films[0].device.serial


def _sort_others(found: Guess, recordings: Iterable[Recording], own: Words) -> None:
    alone = not found.takes and not found.walks and not found.static
    if alone:  # a session of devices
        _place_single_views(found, [r for r in recordings if r.kind in DEVICES])
    for recording in recordings:
        if recording.kind in ("court_points", "own_points", "people", "calibration"):
            key = recording.kind.replace("own", "court")
            if getattr(found, key) is None:
                setattr(found, key, recording)
            else:
                kind = key.replace("_", " ")
                found.unused.append((recording, f"there is another {kind} file"))
        elif recording.kind in DEVICES and not alone:
            take = _nearest(found.takes, set(own[recording.path]))
            found.devices.append((take, DEVICES[recording.kind], recording))
        elif recording.kind in ("racket", "unusable"):
            found.unused.append((recording, recording.note or "clicked racket ends"))


def _nearest(takes: Iterable[str], words: set[str]) -> str:
    """Return the take that shares most words, of equals the one without others; empty if none."""
    shared = {take: set(words_of([take])) & words for take in takes}
    fits = {take: (len(said), said == set(words_of([take]))) for take, said in shared.items()}
    near = [take for take, fit in fits.items() if fit == max(fits.values())]
    return near[0] if len(near) == 1 else ""


def _named(words: str, recordings: Iterable[Recording], otherwise: str) -> str:
    """Return the name of a camera, take or walk of such words, spelled as in its recordings'."""
    return names.name(names.spelling(words, [r.written for r in recordings]), otherwise)


def _rename(found: Guess) -> None:
    """Give cameras and takes names that a configuration accepts."""
    cameras: dict[str, str] = {}
    for at, camera in enumerate(found.cameras, start=1):
        shown = [*found.films(camera), *filter(None, [found.static.get(camera)])]
        cameras[camera] = distinct(_named(camera, shown, f"cam{at}"), cameras.values())
    found.cameras = list(cameras.values())
    found.numbered = [cameras[camera] for camera in found.numbered if camera in cameras]
    found.static = {cameras[c]: r for c, r in found.static.items() if c in cameras}
    found.boards = {cameras[c]: r for c, r in found.boards.items()}
    found.serials = {cameras[c]: serial for c, serial in found.serials.items()}
    takes: dict[str, str] = {}
    for at, (take, films) in enumerate(found.takes.items(), start=1):
        own = [r for name, _, r in found.devices if name == take == _take_of(r)]
        shown = [*films.values()] or own
        takes[take] = distinct(_named(take, shown, f"take{at}"), takes.values())
    found.by_order = [takes[take] for take in found.by_order]
    found.takes, found.keypoints = (
        {takes[key]: {cameras[c]: r for c, r in take.items()} for key, take in kind.items()}
        for kind in (found.takes, found.keypoints)
    )
    found.devices = [(takes.get(take, ""), device, r) for take, device, r in found.devices]
