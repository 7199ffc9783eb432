"""Consent of the persons of a session, and the results that are left out without it."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from courtside.study.configuration.sessions import Session, Subject, Take

WORDS = {
    "analysis": "measures, figures and the 3D view of how they moved",
    "export": "files of how they moved for other programs",
    "pictures": "pictures and videos in which they can be seen, faces made unrecognisable",
    "faces": "pictures and videos that show their faces",
}
# Where nothing is stated: what can be made unrecognisable. How somebody moves cannot, and a file
# of it goes wherever its reader sends it: that has to be agreed to.
UNSTATED = ("analysis", "pictures")
NEEDS = {"export": "analysis", "pictures": "analysis", "faces": "pictures"}


def stated(subject: Mapping[str, Any], virtual: bool) -> tuple[str, ...]:
    """Return what a person has agreed to according to the session's file: words of `WORDS`.

    Empty for somebody who has withdrawn; everything in a virtual session, where nobody can object.
    """
    return tuple(subject.get("consent", WORDS if virtual else UNSTATED))


def withdrawn(subjects: Mapping[str, Any], virtual: bool) -> set[str]:
    """Return the persons of a session's file who have not agreed to be measured."""
    return {
        name for name, subject in subjects.items() if "analysis" not in stated(subject, virtual)
    }


def refusing(session: "Session", take: "Take", word: str) -> tuple[str, ...]:
    """Return the persons of a take who have not agreed to `word`, in their order."""
    if word not in WORDS:
        raise ValueError(f"expected one of {tuple(WORDS)}, found {word!r}")
    return tuple(name for name in take.subjects if word not in session.subjects[name].consent)


def withheld(
    takes: Mapping[str, "Take"], subjects: Mapping[str, "Subject"]
) -> dict[str, tuple[str, ...]]:
    """Return the takes that may not be measured, each with the persons who refused.

    A recording of several persons cannot be measured without one of them.
    """
    found = {
        name: tuple(who for who in take.subjects if "analysis" not in subjects[who].consent)
        for name, take in takes.items()
    }
    return {name: who for name, who in found.items() if who}


def left_out(session: "Session", wanted: Iterable[str] = ("export", "pictures")) -> list[str]:
    """List what is not made of a session because consent or videos are missing.

    One line for each thing left out (analysis, and the words `wanted`) and each set of persons, and
    one for the takes of which there are keypoints alone.
    """
    lines = [
        f"nothing is made of {takes}: {persons} not agreed to analysis (consent)"
        for takes, persons in _together(session.withheld)
    ]
    for word in wanted:
        who = {take.name: refusing(session, take, word) for take in session.takes.values()}
        lines += [
            f"no {WORDS[word]} in {takes}: {persons} not agreed to {word} (consent)"
            for takes, persons in _together(who)
        ]
    unfilmed = [take.name for take in session.takes.values() if take.cameras and not take.videos]
    if unfilmed:
        named = f"take{'s' * (len(unfilmed) > 1)} {', '.join(unfilmed)}"
        lines.append(f"no pictures or videos in {named}: there are keypoints alone, no videos")
    return lines


def faults(file: Path, content: dict[str, Any]) -> Iterator[str]:
    """Yield what contradicts itself in the consent of persons, one line each."""
    virtual = "virtual" in content
    faces_shown = not content.get("blur_faces", not virtual) and bool(content.get("takes"))
    for name, subject in content.get("subjects", {}).items():
        agreed = stated(subject, virtual)
        for word in (w for w in agreed if NEEDS.get(w, w) not in agreed):
            yield (
                f"{file}: subjects.{name}.consent: expected {NEEDS[word]} with {word}, found "
                f"{list(agreed)}; add it, or write [] for somebody who has withdrawn"
            )
        if faces_shown and "pictures" in agreed and "faces" not in agreed:
            yield (
                f"{file}: blur_faces: expected `faces` in the consent of {name} to show faces, "
                f"found {list(agreed)}; ask them, or remove blur_faces: false"
            )


def _together(who: Mapping[str, tuple[str, ...]]) -> Iterator[tuple[str, str]]:
    """Yield takes with the same persons, and these persons, in words."""
    for persons in dict.fromkeys(filter(None, who.values())):
        takes = [name for name, others in who.items() if others == persons]
        noun = "take" if len(takes) == 1 else "takes"
        verb = "has" if len(persons) == 1 else "have"
        yield f"{noun} {', '.join(takes)}", f"{', '.join(persons)} {verb}"
