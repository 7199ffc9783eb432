"""Which words of the names of recordings name their cameras."""

import re
from collections.abc import Iterable, Sequence
from itertools import combinations

from courtside.drafting.names import alike, words_of
from courtside.drafting.recordings import (
    STATIC,
    WALK,
    Recording,
    Words,
    called,
    is_called_walk,
    lengths_fit,
    uncounted,
)

NUMBERED = re.compile(
    r"(cam|camera|c|gopro|gp|view|kamera|phone|iphone|ipad|pixel|dslr|miqus|oqus|arqus)[0-9]+"
)
CAMERA = re.compile(
    NUMBERED.pattern
    + r"|(left|right|centre|center|middle|back|front|side|rear|top|oblique|mirror"
    + r"|links|rechts|mitte|vorne|hinten|oben|gauche|droite|devant|derriere|arriere"
    + r"|izquierd[ao]|derech[ao]|esquerda|direita|sinistra|destra|centro"
    + r"|delante|detras|frente|atras|davanti|dietro)[0-9]*"
)
Named = list[tuple[str, ...]]  # words of cameras, one of each video; empty where it names none


def of(
    recordings: Iterable[Recording], videos: Sequence[Recording], own: Words
) -> tuple[Words, bool]:
    """Return the words that name each camera, by its name, and whether others may be meant."""
    names = _of_empty(recordings, videos, own)
    doubtful = False
    if any(names):
        names += _beside(names, videos, own)
    else:
        names, doubtful = _of_videos(videos, own)
        if counted := _counted(names):
            doubtful = True
            if _are_trials(videos, own, counted):
                names = [(uncounted(word),) for word in counted]
    cameras = {"_".join(words): words for words in dict.fromkeys(filter(None, names))}
    parted = without_trials(videos, own, cameras)
    return cameras, doubtful or any(_names_several(parted[r.path], cameras) for r in videos)


def _of_empty(recordings: Iterable[Recording], videos: Sequence[Recording], own: Words) -> Named:
    """Return the words of cameras in names of recordings of the empty court.

    What no video of a take says is of the hall, as `court` of `empty_court_left`.
    """
    empty = [r for r in recordings if r.kind in ("video", "photo") and called(r, STATIC)]
    names = [tuple(w for w in own[r.path] if uncounted(w) not in STATIC) for r in empty]
    films = [r for r in videos if not called(r, STATIC)]
    for walks in (False, True):  # players may walk
        said = {uncounted(w) for r in films if is_called_walk(r) == walks for w in own[r.path]}
        kept = [tuple(w for w in words if uncounted(w) in said) for words in names]
        if any(kept) and (len(set(kept)) > 1 or len(set(names)) == 1):
            return [own or words for own, words in zip(kept, names, strict=True)]
    return names


def _beside(names: Named, videos: Sequence[Recording], own: Words) -> Named:
    """Return more cameras: by words that a name has beside those of a take that others film.

    A name without other words may also be that of the walking camera, unless one is called so.
    """
    cameras = {"_".join(words): words for words in filter(None, names)}
    placed = [(r, *told(own[r.path], cameras)) for r in videos if not called(r, STATIC)]
    takes: dict[tuple[str, ...], list[Recording]] = {}
    for recording, camera, words in placed:
        if camera and (words or any(is_called_walk(r) for r in videos)):
            takes.setdefault(words, []).append(recording)
    more: dict[tuple[str, ...], None] = {}
    for recording, words in ((r, words) for r, camera, words in placed if camera is None):
        for size in {1, *map(len, cameras.values())}:
            for one in (words[at : at + size] for at in range(len(words) - size + 1)):
                take = takes.get(told(words, {"": one})[1], [])
                fits = take and lengths_fit([recording, *take])
                if fits and not WALK & set(map(uncounted, one)):
                    more[one] = None
    return list(more)


def _of_videos(videos: Sequence[Recording], own: Words) -> tuple[Named, bool]:
    """Return the words of cameras in names of videos, and whether others may be meant."""
    names, doubtful = _known(videos, own)
    if len(set(filter(None, names))) > 1:
        return names + _beside(names, videos, own), doubtful
    return _differing(videos, own)


def _known(videos: Sequence[Recording], own: Words) -> tuple[Named, bool]:
    """Return of each video the word that cameras are often called by, and whether others may be.

    The last such word; but first one with a number, as `cam1`, or that of a folder, where all have
    it, for `left` and `right` are also sides of a person.
    """
    every = {r.path: [w for w in own[r.path] if CAMERA.fullmatch(w)] for r in videos}
    films = [r for r in videos if every[r.path] and not called(r, WALK | STATIC)]
    numbered = {path: [w for w in words if NUMBERED.fullmatch(w)] for path, words in every.items()}
    folders = {r.path: [w for w in every[r.path] if w in words_of(r.parts[:-1])] for r in videos}
    ends = any(CAMERA.fullmatch(word) for r in films for word in r.words[-1:])
    chosen = every
    for said in (numbered, {} if ends else folders):
        if len({tuple(said.get(r.path, [])[-1:]) for r in films} - {()}) > 1 and all(
            said[r.path] for r in films
        ):
            chosen = said
            break
    others: dict[tuple[str, ...], set[tuple[str, ...]]] = {}
    for film in films:
        rest = tuple(word for word in own[film.path] if word not in every[film.path])
        more = tuple(word for word in every[film.path] if word not in chosen[film.path][-1:])
        others.setdefault(rest, set()).add(more)
    return [tuple(chosen[r.path][-1:]) for r in videos], any(len(o) > 1 for o in others.values())


def _differing(videos: Iterable[Recording], own: Words) -> tuple[Named, bool]:
    """Return the words by which otherwise equal names differ, and whether others do, too.

    The last ones by which recordings of one take are about as long as each other, if any.
    """
    films = [r for r in videos if own[r.path] and not called(r, WALK | STATIC)]
    named = [(r, _once(own[r.path])) for r in films]
    places = set()
    for (_, one), (_, other) in combinations(named, 2):
        differ = [at for at, pair in enumerate(zip(one, other, strict=False)) if len(set(pair)) > 1]
        if len(one) == len(other) and len(differ) == 1:
            places.add(differ[0] - len(one))
    if not places:
        return [], False
    last = max([place for place in places if _takes_fit(named, place)] or places)
    return [words[last:][:1] for _, words in named if len(words) >= -last], len(places) > 1


def _once(words: tuple[str, ...]) -> tuple[str, ...]:
    """Return words without those said before; a number that is said again is something else."""
    return tuple(w for at, w in enumerate(words) if w.isdigit() or w not in words[:at])


def _takes_fit(named: Iterable[tuple[Recording, tuple[str, ...]]], place: int) -> bool:
    """Say whether lengths of recordings fit whose words differ in one place alone."""
    takes: dict[tuple[str, ...], list[Recording]] = {}
    for recording, words in named:
        if len(words) >= -place:
            takes.setdefault(words[:place] + words[place:][1:], []).append(recording)
    return all(map(lengths_fit, takes.values()))


def _counted(names: Named) -> list[str]:
    """Return the words of cameras if they count what several words name: left1, left2, right1."""
    words = list(dict.fromkeys(word for name in names for word in name))
    stems = {uncounted(word) for word in words}
    numbers = any(word in stems or NUMBERED.fullmatch(word) for word in words)
    return [] if numbers or not 1 < len(stems) < len(words) else words


def _are_trials(videos: Iterable[Recording], own: Words, counted: Sequence[str]) -> bool:
    """Say whether numbers behind words of cameras count takes, not cameras.

    They do where a sign stands before each (`left 1`), or where recordings of one take would
    differ in length.
    """
    takes: dict[tuple[str, ...], list[Recording]] = {}
    apart = []
    for video in videos:
        for word in (word for word in own[video.path] if word in counted):
            rest = tuple(other for other in own[video.path] if other != word)
            takes.setdefault(rest, []).append(video)
            number = word.removeprefix(uncounted(word))
            apart.append(re.search(rf"(?<![^\W_]){number}(?![0-9])", video.written))
    return all(apart) or not all(map(lengths_fit, takes.values()))


def without_trials(recordings: Iterable[Recording], own: Words, cameras: Words) -> Words:
    """Return words in which numbers behind those of cameras stand alone: `left01` of `left`."""
    known = [word for words in cameras.values() for word in words]

    def parted(word: str) -> tuple[str, ...]:
        stem = uncounted(word)
        if stem not in known or any(alike(word, camera) for camera in known):
            return (word,)
        return stem, word.removeprefix(stem)

    return {
        r.path: own[r.path]
        if is_called_walk(r)
        else tuple(part for word in own[r.path] for part in parted(word))
        for r in recordings
    }


def told(words: tuple[str, ...], cameras: Words) -> tuple[str | None, tuple[str, ...]]:
    """Return the camera that words name, that of more words or the last one, and the others."""
    found = _cameras_in(words, cameras)
    if not found:
        return None, words
    *_, name, places = max(found, key=lambda one: one[:2])
    said = [words[at] for at in places]
    # A number that is said again is something else: `1_1`.
    left = [w for at, w in enumerate(words) if at not in places and (w not in said or w.isdigit())]
    return name, tuple(left)


def _cameras_in(
    words: Sequence[str], cameras: Words
) -> list[tuple[int, int, str, tuple[int, ...]]]:
    """Return each camera that words name: how many words, the last place, its name, all places."""
    found = []
    for name, own in cameras.items():
        said = [[at for at, word in enumerate(words) if alike(word, mine)] for mine in own]
        if all(said):
            places = tuple(at[-1] for at in said)
            found.append((len(own), max(places), name, places))
    return found


def _names_several(words: Sequence[str], cameras: Words) -> bool:
    """Say whether words name two cameras, none of which is called by more words."""
    n_words = sorted(found[0] for found in _cameras_in(words, cameras))
    return len(n_words) > 1 and n_words[-1] == n_words[-2]
