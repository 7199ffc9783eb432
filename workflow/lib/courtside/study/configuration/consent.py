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


def is_withheld(content: Mapping[str, Any], take: Mapping[str, Any]) -> bool:
    """Tell whether nothing is made of a take of a session's file: somebody in it has withdrawn."""
    subjects = content.get("subjects", {})
    return bool(withdrawn(subjects, "virtual" in content) & {*take.get("subjects", subjects)})


def refusing(session: "Session", take: "Take", word: str) -> tuple[str, ...]:
    """Return the persons of a take who have not agreed to `word`, in their order."""
    if word not in WORDS:
        raise ValueError(f"expected one of {tuple(WORDS)}, found {word!r}")
    return tuple(name for name in take.subjects if word not in session.subjects[name].consent)


def by_consent(
    takes: Mapping[str, "Take"], subjects: Mapping[str, "Subject"]
) -> tuple[dict[str, "Take"], dict[str, "Take"]]:
    """Return the takes that may be measured, and those that are withheld.

    A recording of several persons cannot be measured without one of them.
    """
    agreed = {name for name, subject in subjects.items() if "analysis" in subject.consent}
    withheld = {name: take for name, take in takes.items() if not agreed.issuperset(take.subjects)}
    return {name: take for name, take in takes.items() if name not in withheld}, withheld


def left_out(session: "Session", wanted: Iterable[str] = ("export", "pictures")) -> list[str]:
    """List what is not made of a session because consent or videos are missing.

    One line for each thing left out (analysis, and the words `wanted`) and each set of persons, and
    one for the takes of which there are keypoints alone.
    """
    lines = [
        f"nothing is made of {takes}: {persons} not agreed to analysis (consent)"
        for takes, persons in _together(session, session.withheld, "analysis")
    ]
    for word in wanted:
        lines += [
            f"no {WORDS[word]} in {takes}: {persons} not agreed to {word} (consent)"
            for takes, persons in _together(session, session.takes, word)
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


def _together(
    session: "Session", takes: Mapping[str, "Take"], word: str
) -> Iterator[tuple[str, str]]:
    """Yield takes with the same persons who have not agreed, and these persons, in words."""
    who = {name: refusing(session, take, word) for name, take in takes.items()}
    for persons in dict.fromkeys(filter(None, who.values())):
        named = [name for name, others in who.items() if others == persons]
        noun = "take" if len(named) == 1 else "takes"
        verb = "has" if len(persons) == 1 else "have"
        yield f"{noun} {', '.join(named)}", f"{', '.join(persons)} {verb}"
