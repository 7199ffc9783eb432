"""Guess the cameras, walks and takes of a session from the names of its files."""

import re
import unicodedata
from collections.abc import Collection, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

# Words that mark a recording of the empty court, of the carried camera, of a chessboard, and words
# that say nothing, as people name files in English, German and French.
STATIC = {"empty", "static", "still", "background", "bg", "vacant", "nobody", "blank"}
STATIC |= {"leer", "vide"}
WALK = {"walk", "walking", "mobile", "moving", "handheld", "bridge", "bridging", "sweep", "gang"}
BOARD = {"board", "boards", "chess", "chessboard", "checker", "checkerboard"}
BOARD |= {"calib", "calibration", "intrinsic", "intrinsics", "int"}
FOLDERS = {"video", "videos", "data", "film", "films", "footage", "takes", "raw"}
FOLDERS |= {"recording", "recordings"}
CAMERA = re.compile(
    r"(cam|camera|c|gopro|gp|view|kamera|phone|iphone|pixel|dslr)[0-9]+"
    r"|(left|right|centre|center|middle|back|front|side|rear|oblique|mirror|links|rechts|mitte)[0-9]*"
)


@dataclass(frozen=True)
class Recording:
    """A file, or a folder of photos, that a session may use."""

    path: str  # as a session's file names it
    # Folders below the one that was searched, and the name without its suffix
    parts: tuple[str, ...]
    # `video`, `photo`, `photos`, `bvh`, `bag`, `court_points`, `racket`, `calibration`, or
    # `unusable`
    kind: str
    size: tuple[int, int] | None = None  # of its pictures, px
    rate_hz: float | None = None  # of a video
    duration_s: float | None = None  # of a video
    n_photos: int = 0  # of a folder of photos
    note: str = ""  # why it is unusable, or what is unusual about it
    # Of a calibration: sizes of the pictures of its cameras
    cameras: dict[str, tuple[int, int]] = field(default_factory=dict)

    @property
    def words(self) -> tuple[str, ...]:
        """Words of its name and folders."""
        return words_of(self.parts)


Take = dict[str, Recording]  # by camera
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
    takes: dict[str, Take] = field(default_factory=dict)  # by take and camera
    # Take or "", kind of device, file
    devices: list[tuple[str, str, Recording]] = field(default_factory=list)
    court_points: Recording | None = None
    calibration: Recording | None = None
    unused: list[tuple[Recording, str]] = field(default_factory=list)  # with the reason


def guess(recordings: Sequence[Recording]) -> Guess:
    """Guess what each recording, in name order, is; every one is in the guess once."""
    found = Guess()
    videos = [r for r in recordings if r.kind == "video"]
    own = _own_words(recordings, videos)
    cameras = _camera_words(recordings, videos, own)
    rest = _sort_pictures(found, recordings, own, cameras)
    _group(found, rest)
    found.cameras = [
        name
        for name in cameras
        if name in found.static or any(name in take for take in found.takes.values())
    ]
    for camera in [name for name in found.boards if name not in found.cameras]:
        found.unused.append((found.boards.pop(camera), "a chessboard of no camera found"))
    if found.walks:
        _stand_in(found)
    _sort_others(found, recordings, own)
    return found


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
    names = [tuple(w for w in own[r.path] if w not in STATIC) for r in empty]
    if not any(names):
        known = [tuple(w for w in own[r.path] if CAMERA.fullmatch(w))[-1:] for r in videos]
        names = known if len(set(filter(None, known))) > 1 else _differing(videos, own)
    return {"_".join(words): words for words in dict.fromkeys(filter(None, names))}


def _differing(videos: Iterable[Recording], own: Words) -> list[tuple[str, ...]]:
    """Return the last words by which otherwise equal names differ."""
    named = [own[r.path] for r in videos if not _has(r, WALK | STATIC)]
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
    return any(re.sub("[0-9]+$", "", word) in vocabulary for word in recording.words)


def _sort_pictures(
    found: Guess, recordings: Sequence[Recording], own: Words, cameras: Words
) -> list[tuple[Recording, str | None, tuple[str, ...]]]:
    """Put static recordings, boards and walks into the guess; return the others.

    Of each other recording, which belongs to a take: itself, its camera, and the words left.
    """
    rest, alone = [], sum(r.kind == "video" for r in recordings) == 1
    for recording in (r for r in recordings if r.kind in ("video", "photo", "photos")):
        camera, words = _camera_of(own[recording.path], cameras)
        if recording.kind == "photos" and _has(recording, BOARD):
            _keep(found, found.boards, recording, camera, "a chessboard of no camera found")
        elif recording.kind == "photo" or _has(recording, STATIC):
            _keep(found, found.static, recording, camera, "a picture of no camera found")
        elif recording.kind == "photos" or _is_walk(recording, camera, cameras) or alone:
            wanted = name("_".join(words), "walk")
            wanted = wanted if wanted not in cameras else f"walk_{wanted}"
            found.walks[distinct(wanted, found.walks)] = recording
        else:
            rest.append((recording, camera, words))
    return rest


def _is_walk(recording: Recording, camera: str | None, cameras: Words) -> bool:
    return camera is None and bool(cameras or _has(recording, WALK))


def _keep(found: Guess, place: Take, recording: Recording, camera: str | None, reason: str) -> None:
    if camera is None:
        found.unused.append((recording, reason))
    elif camera in place:
        found.unused.append((recording, f"camera {camera} has {place[camera].path} already"))
    else:
        place[camera] = recording


def _group(found: Guess, rest: Iterable[tuple[Recording, str | None, tuple[str, ...]]]) -> None:
    """Group recordings into takes: by the words other than the camera's, else by their order."""
    takes: dict[str, Take] = {}
    left: dict[str, list[Recording]] = {}
    for recording, camera, words in rest:
        if camera is None:
            found.unused.append((recording, "no other video has a name like it"))
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
    _pair_by_order(found, left)


def _shared_name(take: Take) -> str:
    """Return what the names of a take's files share, without folders."""
    names = [words_of(recording.parts[-1:]) for recording in take.values()]
    shared = set.intersection(*map(set, names)) - FOLDERS
    return "_".join(word for word in names[0] if word in shared)


def _pair_by_order(found: Guess, left: Mapping[str, Sequence[Recording]]) -> None:
    """Make the k-th recordings of all cameras one take, if all have equally many."""
    if len(left) > 1 and len({len(own) for own in left.values()}) == 1:
        for at, together in enumerate(zip(*left.values(), strict=True), start=1):
            name = distinct(f"take{at}", found.takes)
            found.takes[name] = dict(zip(left, together, strict=True))
        return
    for camera, own in left.items():
        for recording in own:
            found.unused.append((recording, f"the only recording of its take, by camera {camera}"))


def _stand_in(found: Guess) -> None:
    """Use the first take for missing static recordings: a walk is tied to them."""
    for camera in found.cameras:
        films = [take[camera] for take in found.takes.values() if camera in take]
        if camera not in found.static and films:
            found.static[camera] = films[0]
            found.stand_ins.append(camera)


def _sort_others(found: Guess, recordings: Iterable[Recording], own: Words) -> None:
    for recording in recordings:
        if recording.kind in ("court_points", "calibration"):
            if getattr(found, recording.kind) is None:
                setattr(found, recording.kind, recording)
            else:
                found.unused.append((recording, f"there is another {recording.kind} file"))
        elif recording.kind in ("bvh", "bag"):
            words = set(own[recording.path])
            near = [t for t in found.takes if set(words_of([t])) & words]
            only = list(found.takes) if len(found.takes) == 1 else [""]
            device = {"bvh": "mocopi", "bag": "realsense"}[recording.kind]
            found.devices.append(((near or only)[0], device, recording))
        elif recording.kind in ("racket", "unusable"):
            found.unused.append((recording, recording.note or "clicked racket ends"))


WORD = re.compile(r"[A-Za-z]+[0-9]*|[0-9]+")
LETTERS = {"ß": "ss", "æ": "ae", "œ": "oe", "ø": "o", "đ": "d", "ł": "l", "þ": "th"}


def words_of(parts: Iterable[str]) -> tuple[str, ...]:
    """Split the names of folders and of a file without its suffix into words.

    Lower case, without accents; a number belongs to the word before it: `Cam 01-takeTwo` gives
    `cam01`, `take`, `two`.
    """
    found: list[str] = []
    for part in parts:
        own: list[str] = []
        for word in WORD.findall(_plain(part)):
            if word.isdigit() and own and not own[-1][-1].isdigit():
                own[-1] += word
            else:
                own.append(word)
        found += own
    return tuple(word.lower() for word in found)


def name(text: str, otherwise: str) -> str:
    """Make a name that a configuration accepts: `a-z0-9_`, begun with a letter or digit.

    `otherwise` is the name of a text without a letter or digit of the Latin alphabet.
    """
    return "_".join(re.findall("[a-z0-9]+", _plain(text).lower())) or otherwise


def distinct(wanted: str, taken: Collection[str]) -> str:
    """Return a name, with the first number after it that makes it differ from those taken."""
    found, number = wanted, 1
    while found in taken:
        number += 1
        found = f"{wanted}_{number}"
    return found


def alike(one: str, other: str) -> bool:
    """Return whether words differ only by zeros before their numbers, as `cam1` and `cam01`."""
    return _unpadded(one) == _unpadded(other)


def _unpadded(word: str) -> str:
    return re.sub(r"(?<![0-9])0+(?=[0-9])", "", word)


def _plain(text: str) -> str:
    """Return a text without accents, camel case split into words."""
    text = "".join(LETTERS.get(letter.lower(), letter) for letter in text)
    text = unicodedata.normalize("NFKD", text)
    text = "".join(letter for letter in text if not unicodedata.combining(letter))
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)
