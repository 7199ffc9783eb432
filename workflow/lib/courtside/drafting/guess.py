"""Guess cameras, walks and takes of a session from the names of its files."""

import re
import unicodedata
from dataclasses import dataclass, field
from itertools import combinations

STATIC = {
    "empty",
    "static",
    "still",
    "background",
    "bg",
    "vacant",
    "nobody",
    "leer",
    "vide",
    "blank",
}
WALK = {"walk", "walking", "mobile", "moving", "handheld", "bridge", "bridging", "sweep", "gang"}
BOARD = {
    "board",
    "boards",
    "chess",
    "chessboard",
    "checker",
    "checkerboard",
    "calib",
    "calibration",
}
BOARD |= {"intrinsic", "intrinsics", "int"}
FOLDERS = {
    "video",
    "videos",
    "data",
    "film",
    "films",
    "footage",
    "recording",
    "recordings",
    "takes",
    "raw",
}
CAMERA = re.compile(
    r"(cam|camera|c|gopro|gp|view|kamera|phone|iphone|pixel|dslr)[0-9]+"
    r"|(left|right|centre|center|middle|back|front|side|rear|oblique|mirror|links|rechts|mitte)[0-9]*"
)


@dataclass(frozen=True)
class Recording:
    """A file, or a folder of photos, that a session may use.

    Attributes
    ----------
    path : str
        As a session's file names it.
    parts : tuple of str
        Folders below the one that was searched, and the name without its suffix.
    kind : str
        `video`, `photo`, `photos`, `bvh`, `bag`, `court_points`, `racket`, `calibration`, or `unusable`.
    size : (int, int) or None
        Of its pictures, px.
    rate_hz, duration_s : float or None
        Of a video.
    n_photos : int
        Of a folder of photos.
    note : str
        Why it is unusable, or what is odd about it.
    cameras : dict of str to (int, int)
        Of a calibration: sizes of the pictures of its cameras.
    """

    path: str
    parts: tuple
    kind: str
    size: tuple | None = None
    rate_hz: float | None = None
    duration_s: float | None = None
    n_photos: int = 0
    note: str = ""
    cameras: dict = field(default_factory=dict)

    @property
    def words(self):
        """Words of its name and folders."""
        return words_of(self.parts)


@dataclass
class Guess:
    """What the recordings of a folder seem to be.

    Attributes
    ----------
    cameras : list of str
    static : dict of str to Recording
        By camera; from a take where `stand_ins` names the camera.
    stand_ins : list of str
    boards : dict of str to Recording
        Pictures of a chessboard, by camera.
    walks : dict of str to Recording
    takes : dict of str to dict of str to Recording
        By take and camera.
    devices : list of (str, str, Recording)
        Take or "", kind of device, file.
    court_points, calibration : Recording or None
    unused : list of (Recording, str)
        With the reason.
    """

    cameras: list = field(default_factory=list)
    static: dict = field(default_factory=dict)
    stand_ins: list = field(default_factory=list)
    boards: dict = field(default_factory=dict)
    walks: dict = field(default_factory=dict)
    takes: dict = field(default_factory=dict)
    devices: list = field(default_factory=list)
    court_points: Recording | None = None
    calibration: Recording | None = None
    unused: list = field(default_factory=list)


def guess(recordings):
    """Guess what each recording is.

    Parameters
    ----------
    recordings : list of Recording
        In name order.

    Returns
    -------
    guess : Guess
        Every recording is in it once.
    """
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


def _own_words(recordings, videos):
    """Return for each path the words that not all videos share: those say nothing."""
    shared = set.intersection(*(set(r.words) for r in videos)) if len(videos) > 1 else set()
    shared |= FOLDERS
    return {r.path: tuple(word for word in r.words if word not in shared) for r in recordings}


def _camera_words(recordings, videos, own):
    """Return the words that name each camera, by the name it gets."""
    empty = [r for r in recordings if r.kind in ("video", "photo") and _has(r, STATIC)]
    names = [tuple(w for w in own[r.path] if w not in STATIC) for r in empty]
    if not any(names):
        known = [tuple(w for w in own[r.path] if CAMERA.fullmatch(w))[-1:] for r in videos]
        names = known if len(set(filter(None, known))) > 1 else _differing(videos, own)
    return {"_".join(words): words for words in dict.fromkeys(filter(None, names))}


def _differing(videos, own):
    """Return the words by which names differ that are otherwise the same, the last that do."""
    named = [own[r.path] for r in videos if not _has(r, WALK | STATIC)]
    places = set()
    for one, other in combinations(named, 2):
        differ = [at for at, pair in enumerate(zip(one, other, strict=False)) if len(set(pair)) > 1]
        if len(one) == len(other) and len(differ) == 1:
            places.add(differ[0] - len(one))
    if not places:
        return []
    return [words[max(places) :][:1] for words in named if len(words) >= -max(places)]


def _camera_of(words, cameras):
    """Return the camera that words name, and the words left."""
    for name, own in sorted(cameras.items(), key=lambda item: -len(item[1])):
        said = [next((w for w in words if alike(w, mine)), None) for mine in own]
        if all(said):
            return name, tuple(word for word in words if word not in said)
    return None, words


def _has(recording, vocabulary):
    return any(re.sub("[0-9]+$", "", word) in vocabulary for word in recording.words)


def _sort_pictures(found, recordings, own, cameras):
    """Put static recordings, boards and walks into the guess; return (recording, camera, words) of takes."""
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


def _is_walk(recording, camera, cameras):
    return camera is None and bool(cameras or _has(recording, WALK))


def _keep(found, place, recording, camera, reason):
    if camera is None:
        found.unused.append((recording, reason))
    elif camera in place:
        found.unused.append((recording, f"camera {camera} has {place[camera].path} already"))
    else:
        place[camera] = recording


def _group(found, rest):
    """Group recordings into takes: by the words apart from the camera's, else by their order."""
    takes, left = {}, {}
    for recording, camera, words in rest:
        if camera is None:
            found.unused.append((recording, "no other video has a name like it"))
            continue
        take = takes.setdefault("_".join(words), {})
        if camera in take:
            found.unused.append((recording, f"its take has {take[camera].path} of that camera"))
        else:
            take[camera] = recording
    for words, take in takes.items():
        if len(take) > 1:
            name = words or _shared_name(take) or "take1"
            found.takes[distinct(name, found.takes)] = take
            continue
        for camera, recording in take.items():
            left.setdefault(camera, []).append(recording)
    _pair_by_order(found, left)


def _shared_name(take):
    """Return what the names of a take's files have in common, folders apart."""
    names = [words_of(recording.parts[-1:]) for recording in take.values()]
    shared = set.intersection(*map(set, names)) - FOLDERS
    return "_".join(word for word in names[0] if word in shared)


def _pair_by_order(found, left):
    """Take the k-th recording of every camera for one take, where all have equally many."""
    if len(left) > 1 and len({len(own) for own in left.values()}) == 1:
        for at, together in enumerate(zip(*left.values(), strict=True), start=1):
            name = distinct(f"take{at}", found.takes)
            found.takes[name] = dict(zip(left, together, strict=True))
        return
    for camera, own in left.items():
        for recording in own:
            found.unused.append((recording, f"the only recording of its take, by camera {camera}"))


def _stand_in(found):
    """Let the first take stand in for static recordings that are missing: a walk is tied to them."""
    for camera in found.cameras:
        films = [take[camera] for take in found.takes.values() if camera in take]
        if camera not in found.static and films:
            found.static[camera] = films[0]
            found.stand_ins.append(camera)


def _sort_others(found, recordings, own):
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


def words_of(parts):
    """Split the names of a file and its folders into words.

    Parameters
    ----------
    parts : sequence of str
        Folders and the file without its suffix.

    Returns
    -------
    found : tuple of str
        Lower case, without accents; a number belongs to the word before it: `Cam 01-takeTwo` gives
        `cam01`, `take`, `two`.
    """
    found = []
    for part in parts:
        own = []
        for word in WORD.findall(_plain(part)):
            if word.isdigit() and own and not own[-1][-1].isdigit():
                own[-1] += word
            else:
                own.append(word)
        found += own
    return tuple(word.lower() for word in found)


def name(text, otherwise):
    """Make a name that a configuration accepts.

    Parameters
    ----------
    text : str
        Anything.
    otherwise : str
        The name of a text that holds no letter or digit of the Latin alphabet.

    Returns
    -------
    name : str
        Lower-case letters, digits and `_`, begun with a letter or digit.
    """
    return "_".join(re.findall("[a-z0-9]+", _plain(text).lower())) or otherwise


def distinct(wanted, taken):
    """Return a name, with the first number behind it that makes it differ from those taken."""
    found, number = wanted, 1
    while found in taken:
        number += 1
        found = f"{wanted}_{number}"
    return found


def alike(one, other):
    """Tell whether two words are the same but for zeros before their numbers: `cam1` and `cam01`."""
    return _unpadded(one) == _unpadded(other)


def _unpadded(word):
    return re.sub(r"(?<![0-9])0+(?=[0-9])", "", word)


def _plain(text):
    """Return a text without accents, its words in camel case apart."""
    text = "".join(LETTERS.get(letter.lower(), letter) for letter in text)
    text = unicodedata.normalize("NFKD", text)
    text = "".join(letter for letter in text if not unicodedata.combining(letter))
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)
