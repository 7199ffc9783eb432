"""Faults of `seen`: where a session's file says that a subject is."""

from collections.abc import Iterator
from pathlib import Path

from courtside.study.configuration import take_faults
from courtside.study.configuration.session_files import sightings
from courtside.study.configuration.yaml_files import Content


def find(file: Path, content: Content) -> Iterator[str]:
    """Yield entries of `seen` of unknown takes and cameras; `content` is as its schema allows it.

    Of a session with several filmed takes, each entry names its take.
    """
    filmed = {name: _cameras(take, content) for name, take in _takes(content).items()}
    for subject, stated in content.get("subjects", {}).items():
        there = [name for name, take in filmed.items() if take and _holds(content, name, subject)]
        for entry in sightings(stated):
            where = f"{file}: subjects.{subject}.seen"
            if not there:
                yield f"{where}: expected a filmed take of {subject}, found none; remove it"
                continue
            if "take" not in entry and len(there) != 1:
                yield (
                    f"{where}: expected `take`, one of {there}, found none; say which take the "
                    "pixel is in"
                )
                continue
            take = entry.get("take", there[0] if there else "")
            yield from take_faults.unknown(f"{where}.take", [take], there)
            if take in there:
                yield from take_faults.unknown(f"{where}.camera", [entry["camera"]], filmed[take])


def _takes(content: Content) -> Content:
    return content.get("takes", {})


def _holds(content: Content, take: str, subject: str) -> bool:
    stated: Content = _takes(content)[take]
    return subject in (stated if "subjects" in stated else content)["subjects"]


def _cameras(take: Content, content: Content) -> list[str]:
    """Return the fixed cameras that film a take."""
    made = take.get("virtual")
    return (
        take_faults.cameras_of(take) if made is None else [*made.get("cameras", content["cameras"])]
    )
