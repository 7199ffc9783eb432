"""Results on the disk that the session files no longer ask for: to be told, and deleted by hand."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Session, Study
from courtside.study.targets import devices, pages, takes

WORDS = ("export", "pictures")
OF_A_PERSON = (".trc", ".c3d", ".bvh", ".glb", ".mot", ".osim")  # after the model and the person


def of_takes(session: Session) -> dict[str, bool]:
    """Return the folders of takes that are not measured, and whether consent is the reason.

    Otherwise the session's file has no such take: it was renamed or removed.
    """
    folder = Path(paths.SESSION.format(session=session.name)) / "takes"
    there = sorted(each for each in folder.glob("*") if each.is_dir())
    return {
        each.as_posix(): each.name in session.withheld
        for each in there
        if each.name not in session.takes
    }


def of_nobody(session: Session) -> dict[str, list[str]]:
    """Return, by folder of a take, the persons of exported files there whom the take does not have.

    The files of a person who was renamed stay beside the new ones.
    """
    found = {}
    for name, take in session.takes.items():
        folder = Path(paths.TAKE.format(session=session.name, take=name))
        every = [*folder.glob("pose3d*/**/*"), *folder.glob("motion/**/*")]
        persons = {path.name.split(".")[-2] for path in every if path.suffix in OF_A_PERSON}
        found[folder.as_posix()] = sorted(persons - set(take.subjects))
    return {folder: persons for folder, persons in found.items() if persons}


def without_consent(study: Study) -> dict[str, list[str]]:
    """Return, by session, the files there that persons have not agreed to, or no longer agree to.

    Of sessions in which all have agreed to everything there are none.
    """
    found = {}
    for session in study.sessions.values():
        who = [consent.refusing(session, one, w) for one in session.takes.values() for w in WORDS]
        if any(who):
            allowed, possible = (
                set(_made(replace(study, sessions={session.name: one})))
                for one in (session, _agreed(session))
            )
            there = [*filter(_is_file, possible - allowed), *_videos(session)]
            found[session.name] = sorted(set(there))
    return {name: files for name, files in found.items() if files}


def _agreed(session: Session) -> Session:
    every = tuple(consent.WORDS)
    subjects = {name: replace(one, consent=every) for name, one in session.subjects.items()}
    return replace(session, subjects=subjects)


def _made(study: Study) -> Iterator[str]:
    yield from takes.every_export(study)
    yield from devices.every_device_export(study)
    yield from takes.every_figure(study)
    yield from pages.every_people_page(study)


def _videos(session: Session) -> Iterator[str]:
    """Yield the videos with skeletons of takes without consent; they are made when asked for."""
    for take in session.takes.values():
        if consent.refusing(session, take, "pictures"):
            folder = Path(paths.TAKE.format(session=session.name, take=take.name)) / "videos"
            yield from (path.as_posix() for path in folder.rglob("*.mp4"))


def _is_file(path: str) -> bool:
    return Path(path).is_file()
