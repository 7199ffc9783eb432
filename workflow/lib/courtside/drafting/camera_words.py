"""Which words of the names of recordings name their cameras."""

import re
from collections.abc import Iterable, Sequence
from itertools import combinations

from courtside.drafting.names import alike
from courtside.drafting.recordings import STATIC, WALK, Recording, Words, called, uncounted

CAMERA = re.compile(
    r"(cam|camera|c|gopro|gp|view|kamera|phone|iphone|pixel|dslr|miqus|oqus|arqus)[0-9]+"
    r"|(left|right|centre|center|middle|back|front|side|rear|oblique|mirror|links|rechts|mitte)[0-9]*"
)


def of(recordings: Iterable[Recording], videos: Sequence[Recording], own: Words) -> Words:
    """Return the words that name each camera, by the camera's name."""
    empty = [r for r in recordings if r.kind in ("video", "photo") and called(r, STATIC)]
    names = [tuple(w for w in own[r.path] if uncounted(w) not in STATIC) for r in empty]
    if not any(names):
        known = [tuple(w for w in own[r.path] if CAMERA.fullmatch(w))[-1:] for r in videos]
        names = known if len(set(filter(None, known))) > 1 else _differing(videos, own)
    return {"_".join(words): words for words in dict.fromkeys(filter(None, names))}


def _differing(videos: Iterable[Recording], own: Words) -> list[tuple[str, ...]]:
    """Return the last words by which otherwise equal names differ."""
    named = [own[r.path] for r in videos if own[r.path] and not called(r, WALK | STATIC)]
    places = set()
    for one, other in combinations(named, 2):
        differ = [at for at, pair in enumerate(zip(one, other, strict=False)) if len(set(pair)) > 1]
        if len(one) == len(other) and len(differ) == 1:
            places.add(differ[0] - len(one))
    if not places:
        return []
    return [words[max(places) :][:1] for words in named if len(words) >= -max(places)]


def told(words: tuple[str, ...], cameras: Words) -> tuple[str | None, tuple[str, ...]]:
    """Return the camera that words name, and the other words."""
    for name, own in sorted(cameras.items(), key=lambda item: -len(item[1])):
        said = [next((w for w in words if alike(w, mine)), None) for mine in own]
        if all(said):
            return name, tuple(word for word in words if word not in said)
    return None, words
