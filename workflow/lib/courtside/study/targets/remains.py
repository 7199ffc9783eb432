"""Results on the disk that the session files no longer ask for: to be told, and deleted by hand."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Session, Study, Take
from courtside.study.targets import devices, pages, takes, together

WORDS = ("export", "pictures")
OF_A_PERSON = (".trc", ".c3d", ".bvh", ".glb", ".mot", ".osim")  # after the model and the person
OF_A_CAMERA = ("background", "movement", "pose2d", "pose2d_steadied", "shake", "videos")  # folders


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
    return _of_others(session, _person, lambda take: take.subjects)


def of_no_camera(session: Session) -> dict[str, list[str]]:
    """Return, by folder of a take, the cameras of files there that the take does not have."""
    return _of_others(session, _camera, lambda take: (*take.cameras, *take.devices))


def _of_others(
    session: Session,
    owner: Callable[[Path], str | None],
    own: Callable[[Take], Iterable[str]],
) -> dict[str, list[str]]:
    found = {}
    for name, take in session.takes.items():
        folder = _folder(session, name)
        every = (path.relative_to(folder) for path in folder.rglob("*.*") if path.is_file())
        owners = {one for path in every if (one := owner(path))}
        found[folder.as_posix()] = sorted(owners - set(own(take)))
    return {folder: names for folder, names in found.items() if names}


def _person(path: Path) -> str | None:
    """Return whose exported file a path is, seen from the folder of a take."""
    is_exported = path.parts[0] == "motion" or path.parts[0].startswith("pose3d")
    return path.name.split(".")[-2] if is_exported and path.suffix in OF_A_PERSON else None


def _camera(path: Path) -> str | None:
    """Return of which camera a file is, seen from the folder of a take."""
    is_of_one = path.parts[0] in OF_A_CAMERA and not path.name.startswith(".")
    return path.name.split(".")[-2] if is_of_one else None


def of_records(study: Study, names: Iterable[str]) -> list[str]:
    """Return which of the named files, here or deleted, the session files no longer ask for.

    Of pages that show many takes, those that were deleted and that nothing asks for.
    """
    sessions = study.sessions.values()
    refused = set().union(*(_not_agreed(study, session) for session in sessions))
    pages = {paths.REPORT}
    pages.update(paths.QUALITY_PAGE.format(session=s.name) for s in sessions if not s.takes)
    return [
        name
        for name in names
        if name in refused
        or any(_is_left(session, Path(name)) for session in sessions)
        or (name in pages and not Path(name).exists())
    ]


def _is_left(session: Session, path: Path) -> bool:
    folder = Path(paths.SESSION.format(session=session.name)) / "takes"
    if not path.is_relative_to(folder):
        return False
    name, *inner = path.relative_to(folder).parts
    take = session.takes.get(name)
    if take is None:
        return True
    is_video = inner[0] == "videos" and path.suffix == ".mp4"
    if is_video and consent.refusing(session, take, "pictures"):
        return True
    person, camera = _person(Path(*inner)), _camera(Path(*inner))
    is_of_another = person is not None and person not in take.subjects
    return is_of_another or camera not in (None, *take.cameras, *take.devices)


def without_consent(study: Study) -> dict[str, list[str]]:
    """Return, by session, the files that persons there have not agreed to, or no longer agree to.

    Of sessions in which all have agreed to everything there are none. Files of a take without
    consent to `analysis` are in its folder (`of_takes`), and are not listed.
    """
    found = {}
    for session in study.sessions.values():
        there = [*filter(_is_file, _not_agreed(study, session)), *_videos(session)]
        found[session.name] = sorted(set(there))
    return {name: files for name, files in found.items() if files}


def _not_agreed(study: Study, session: Session) -> set[str]:
    """Return the files that would be made if all had agreed to everything, but are not.

    Files of a take without consent to `analysis` are in its folder, and are left out.
    """
    who = [consent.refusing(session, one, w) for one in session.takes.values() for w in WORDS]
    if not (any(who) or session.withheld):
        return set()
    possible = set(_made(replace(study, sessions={session.name: _agreed(session)})))
    folders = tuple(f"{_folder(session, take).as_posix()}/" for take in session.withheld)
    return {path for path in possible - set(_made(study)) if not path.startswith(folders)}


def _agreed(session: Session) -> Session:
    every = tuple(consent.WORDS)
    subjects = {name: replace(one, consent=every) for name, one in session.subjects.items()}
    takes = {**session.takes, **session.withheld}
    return replace(session, subjects=subjects, takes=takes, withheld={})


def _folder(session: Session, take: str) -> Path:
    return Path(paths.TAKE.format(session=session.name, take=take))


def _made(study: Study) -> Iterator[str]:
    yield from takes.every_export(study)
    yield from devices.every_device_export(study)
    yield from takes.every_figure(study)
    yield from pages.every_people_page(study)
    yield from pages.every_quality_page(study)
    yield from together.every_players_figure(study)
    yield from together.every_study_table(study)


def _videos(session: Session) -> Iterator[str]:
    """Yield the videos with skeletons of takes without consent; they are made when asked for."""
    for take in session.takes.values():
        if consent.refusing(session, take, "pictures"):
            folder = _folder(session, take.name) / "videos"
            yield from (path.as_posix() for path in folder.rglob("*.mp4"))


def _is_file(path: str) -> bool:
    return Path(path).is_file()
