"""Guess the cameras, walks and takes of a session from the names of its files."""

import re
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import timedelta
from functools import cached_property
from itertools import combinations

from courtside.drafting import device_names, names
from courtside.drafting.device_names import DeviceName
from courtside.drafting.names import alike, distinct, words_of

# Words that mark a recording of the empty court, of the carried camera, of a chessboard, and words
# that say nothing, as people name files in English, German and French.
STATIC = {"empty", "static", "still", "background", "bg", "vacant", "nobody", "blank"}
STATIC |= {"leer", "vide"}
WALK = {"walk", "walking", "mobile", "moving", "handheld", "bridge", "bridging", "sweep", "gang"}
BOARD = {"board", "boards", "chess", "chessboard", "checker", "checkerboard"}
BOARD |= {"calib", "calibration", "intrinsic", "intrinsics", "int"}
# ASSUME: what is started for one take is started within so long.
SLACK = timedelta(seconds=30)
FOLDERS = {"video", "videos", "data", "film", "films", "footage", "takes", "raw"}
FOLDERS |= {"recording", "recordings", "cam", "camera", "kamera"}
FOLDERS |= {"json", "pose", "poses", "pose2d", "keypoints", "openpose", "alphapose", "rtmlib"}
# Words of folders in which Pose2Sim keeps keypoints that it has changed itself.
CHANGED = {"associated", "sync", "filtered"}
DEVICES = {"bvh": "mocopi", "bag": "realsense", "depth": "rgbd"}  # by kind
WEBCAM = "webcam"
# Words at the end or the start of a name that say what recorded it, not what was recorded.
RECORDERS = {*DEVICES.values(), WEBCAM, "depth"}
RECORDERS |= {"d405", "d415", "d435", "d455", "l515"}  # of RealSense
D435I = ["d435", "i"]  # as words
CAMERA = re.compile(
    r"(cam|camera|c|gopro|gp|view|kamera|phone|iphone|pixel|dslr|miqus|oqus|arqus)[0-9]+"
    r"|(left|right|centre|center|middle|back|front|side|rear|oblique|mirror|links|rechts|mitte)[0-9]*"
)


@dataclass(frozen=True)
class Recording:
    """A file, or a folder of photos, that a session may use."""

    path: str  # as a session's file names it
    # Folders below the one that was searched, and the name without its suffix
    parts: tuple[str, ...]
    # `video`, `photo`, `photos`, `keypoints` (a folder of JSON), `bvh`, `bag`, `depth` (a folder
    # of plain files), `court_points`, `people`, `racket`, `calibration`, or `unusable`
    kind: str
    size: tuple[int, int] | None = None  # of its pictures, px
    rate_hz: float | None = None  # of a video
    duration_s: float | None = None  # of a video
    n_frames: int | None = None  # of a video; files of keypoints
    n_photos: int = 0  # of a folder of photos
    note: str = ""  # why it is unusable, or what is unusual about it
    # Of a calibration: sizes of the pictures of its cameras
    cameras: dict[str, tuple[int, int]] = field(default_factory=dict)
    # Of keypoints: how many points, and the skeletons that they may be of, the likeliest first
    skeleton: tuple[int, tuple[str, ...]] = (0, ())

    @cached_property
    def device(self) -> DeviceName | None:
        """What a camera or a recorder says in its name."""
        return device_names.read(self.parts[-1]) if self.kind in ("video", "photo") else None

    @property
    def words(self) -> tuple[str, ...]:
        """Words of its name and folders, without counters and moments."""
        if self.device is None:
            return words_of(self.parts)
        said = self.device
        return words_of([*self.parts[:-1], said.before, said.camera, said.after])

    @property
    def written(self) -> str:
        """Its name and folders as a user wrote them: without what a device says."""
        said = self.device
        name = self.parts[-1:] if said is None else (said.before, said.after)
        return "/".join([*self.parts[:-1], *name])


Take = dict[str, Recording]  # by camera
# A recording, its camera, and its words that name neither camera nor counter
Placed = tuple[Recording, str | None, tuple[str, ...]]
Words = dict[str, tuple[str, ...]]  # by path, or by camera


@dataclass
class Guess:
    """What the recordings of a folder seem to be."""

    cameras: list[str] = field(default_factory=list)
    # By camera; from a take where `stand_ins` names the camera
    static: dict[str, Recording] = field(default_factory=dict)
    stand_ins: list[str] = field(default_factory=list)
    # Pictures of a chessboard, by camera
    boards: dict[str, Recording] = field(default_factory=dict)
    walks: dict[str, Recording] = field(default_factory=dict)
    # By take and camera: videos, or folders of keypoints where there are no videos
    takes: dict[str, Take] = field(default_factory=dict)
    # By take and camera: folders of keypoints, beside videos and alone
    keypoints: dict[str, Take] = field(default_factory=dict)
    # Take or "", kind of device, file
    devices: list[tuple[str, str, Recording]] = field(default_factory=list)
    # Cameras that no name tells apart: numbered in the order of their files
    numbered: list[str] = field(default_factory=list)
    serials: dict[str, str] = field(default_factory=dict)  # by camera
    court_points: Recording | None = None
    people: Recording | None = None  # in which persons are named
    calibration: Recording | None = None
    unused: list[tuple[Recording, str]] = field(default_factory=list)  # with the reason

    def films(self, camera: str) -> list[Recording]:
        """Return a camera's recordings of takes."""
        return [take[camera] for take in self.takes.values() if camera in take]


def guess(recordings: Sequence[Recording]) -> Guess:
    """Guess what each recording, in name order, is; every one is in the guess once."""
    found = Guess()
    recordings = _without_later_chapters(found, recordings)
    recordings = _without_changed_keypoints(found, recordings)
    if alone := _single_views(recordings):
        _place_single_views(found, alone)
        recordings = [recording for recording in recordings if recording not in alone]
    filmed = any(r.kind == "video" for r in recordings)
    videos = [r for r in recordings if r.kind == ("video" if filmed else "keypoints")]
    own = _own_words(recordings, videos)
    cameras = _camera_words(recordings, videos, own)
    rest = _sort_pictures(found, recordings, own, cameras)
    rest = _numbered(found, rest) if not cameras else rest
    _group(found, rest)
    _place_keypoints(found, recordings, own, cameras)
    found.cameras = [
        name for name in [*cameras, *found.numbered] if name in found.static or found.films(name)
    ]
    _keep_serials(found)
    for camera in [name for name in found.boards if name not in found.cameras]:
        found.unused.append((found.boards.pop(camera), "a chessboard of no camera found"))
    if found.walks:
        _stand_in(found)
    _sort_others(found, recordings, own)
    _rename(found)
    return found


def _without_later_chapters(found: Guess, recordings: Sequence[Recording]) -> list[Recording]:
    """Leave out the files in which a camera went on with a recording."""
    kept = []
    for recording in recordings:
        if recording.device and recording.device.chapter > 1:
            why = (
                f"chapter {recording.device.chapter} of a recording that its camera cut up; join "
                "the chapters by `python workflow/join_chapters.py`, and keep them elsewhere"
            )
            found.unused.append((recording, why))
        else:
            kept.append(recording)
    return kept


def _without_changed_keypoints(found: Guess, recordings: Sequence[Recording]) -> list[Recording]:
    """Leave out the keypoints that Pose2Sim has synchronised, associated or filtered itself."""
    changed = [
        r for r in recordings if r.kind == "keypoints" and CHANGED & set(words_of(r.parts[:-1]))
    ]
    why = "keypoints that another program changed; the study needs them as they were detected"
    found.unused += [(recording, why) for recording in changed]
    return [recording for recording in recordings if recording not in changed]


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
    if any(_has(video, WALK | STATIC) for video in videos):
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
        camera, words = _camera_of(own[recording.path], cameras)
        only = len(found.takes) == 1
        near = [n for n in found.takes if only or (words and set(words) <= set(words_of([n])))]
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


def _camera_words(
    recordings: Iterable[Recording], videos: Sequence[Recording], own: Words
) -> Words:
    """Return the words that name each camera, by the camera's name."""
    empty = [r for r in recordings if r.kind in ("video", "photo") and _has(r, STATIC)]
    names = [tuple(w for w in own[r.path] if _uncounted(w) not in STATIC) for r in empty]
    if not any(names):
        known = [tuple(w for w in own[r.path] if CAMERA.fullmatch(w))[-1:] for r in videos]
        names = known if len(set(filter(None, known))) > 1 else _differing(videos, own)
    return {"_".join(words): words for words in dict.fromkeys(filter(None, names))}


def _differing(videos: Iterable[Recording], own: Words) -> list[tuple[str, ...]]:
    """Return the last words by which otherwise equal names differ."""
    named = [own[r.path] for r in videos if own[r.path] and not _has(r, WALK | STATIC)]
    places = set()
    for one, other in combinations(named, 2):
        differ = [at for at, pair in enumerate(zip(one, other, strict=False)) if len(set(pair)) > 1]
        if len(one) == len(other) and len(differ) == 1:
            places.add(differ[0] - len(one))
    if not places:
        return []
    return [words[max(places) :][:1] for words in named if len(words) >= -max(places)]


def _camera_of(words: tuple[str, ...], cameras: Words) -> tuple[str | None, tuple[str, ...]]:
    """Return the camera that words name, and the other words."""
    for name, own in sorted(cameras.items(), key=lambda item: -len(item[1])):
        said = [next((w for w in words if alike(w, mine)), None) for mine in own]
        if all(said):
            return name, tuple(word for word in words if word not in said)
    return None, words


def _has(recording: Recording, vocabulary: Container[str]) -> bool:
    return any(_uncounted(word) in vocabulary for word in recording.words)


def _uncounted(word: str) -> str:
    return re.sub("[0-9]+$", "", word)


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
        camera, words = _camera_of(own[recording.path], cameras)
        if recording.kind == "photos" and _has(recording, BOARD):
            _keep(found, found.boards, recording, camera, "a chessboard of no camera found")
        elif recording.kind == "photo" or _has(recording, STATIC):
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


def is_called_walk(recording: Recording) -> bool:
    """Say whether the name of a recording says that it is a walk."""
    return _has(recording, WALK)


def _keep(found: Guess, place: Take, recording: Recording, camera: str | None, reason: str) -> None:
    if camera is None:
        found.unused.append((recording, reason))
    elif camera in place:
        found.unused.append((recording, f"camera {camera} has {place[camera].path} already"))
    else:
        place[camera] = recording


def _numbered(found: Guess, rest: Sequence[Placed]) -> list[Placed]:
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


def _group(found: Guess, rest: Iterable[Placed]) -> None:
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


def _keep_serials(found: Guess) -> None:
    for camera in found.cameras:
        films = found.films(camera)
        if films and films[0].device and films[0].device.serial:
            found.serials[camera] = films[0].device.serial


def _stand_in(found: Guess) -> None:
    """Use the first take for missing static recordings: a walk is tied to them."""
    for camera in found.cameras:
        films = found.films(camera)
        if camera not in found.static and films and films[0].kind == "video":
            found.static[camera] = films[0]
            found.stand_ins.append(camera)


def _sort_others(found: Guess, recordings: Iterable[Recording], own: Words) -> None:
    alone = not found.takes and not found.walks and not found.static
    if alone:  # a session of devices
        _place_single_views(found, [r for r in recordings if r.kind in DEVICES])
    for recording in recordings:
        if recording.kind in ("court_points", "people", "calibration"):
            if getattr(found, recording.kind) is None:
                setattr(found, recording.kind, recording)
            else:
                kind = recording.kind.replace("_", " ")
                found.unused.append((recording, f"there is another {kind} file"))
        elif recording.kind in DEVICES and not alone:
            words = set(own[recording.path])
            near = [t for t in found.takes if set(words_of([t])) & words]
            only = list(found.takes) if len(found.takes) == 1 else [""]
            found.devices.append(((near or only)[0], DEVICES[recording.kind], recording))
        elif recording.kind in ("racket", "unusable"):
            found.unused.append((recording, recording.note or "clicked racket ends"))


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
    found.stand_ins = [cameras[camera] for camera in found.stand_ins]
    found.numbered = [cameras[camera] for camera in found.numbered if camera in cameras]
    found.static = {cameras[c]: r for c, r in found.static.items() if c in cameras}
    found.boards = {cameras[c]: r for c, r in found.boards.items()}
    found.serials = {cameras[c]: serial for c, serial in found.serials.items()}
    takes: dict[str, str] = {}
    for at, (take, films) in enumerate(found.takes.items(), start=1):
        own = [r for name, _, r in found.devices if name == take == _take_of(r)]
        shown = [*films.values()] or own
        takes[take] = distinct(_named(take, shown, f"take{at}"), takes.values())
    found.takes, found.keypoints = (
        {takes[key]: {cameras[c]: r for c, r in take.items()} for key, take in kind.items()}
        for kind in (found.takes, found.keypoints)
    )
    found.devices = [(takes.get(take, ""), device, r) for take, device, r in found.devices]
