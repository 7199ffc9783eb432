"""Results on the disk that the session files no longer ask for: to be told, and deleted by hand."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Session, Study, Take
from courtside.study.targets import devices, pages, takes, together

WORDS = ("export", "pictures")
PEOPLE_PAGE = paths.PEOPLE_PAGE.removeprefix(f"{paths.TAKE}/")
OF_A_PERSON = (".trc", ".c3d", ".bvh", ".glb", ".mot", ".osim")  # after the model and the person
EXPORTED = {f".{suffix}" for suffix in devices.EXPORTED}  # of a device
OF_A_CAMERA = ("background", "movement", "pose2d", "pose2d_steadied", "shake", "videos")  # folders
SOURCES = ("", "-rgb", "-depth", "-corrected")  # after the name of a device


def of_no_session(study: Study) -> list[str]:
    """Return the folders of results with takes of sessions that have no file."""
    pattern = paths.TAKE.format(session="*", take="").rstrip("/")
    names = [folder.parent.name for folder in sorted(Path().glob(pattern)) if folder.is_dir()]
    return [
        paths.SESSION.format(session=name)
        for name in names
        if name not in study.sessions
        and not (study.folder / paths.SESSION_YAML.format(session=name)).is_file()
    ]


def of_takes(session: Session) -> dict[str, bool]:
    """Return the folders of takes that are not measured, and whether consent is the reason.

    Otherwise the session's file has no such take: it was renamed or removed.
    """
    there = [
        each for folder in _parents(session) for each in sorted(folder.glob("*")) if each.is_dir()
    ]
    return {
        each.as_posix(): each.name in session.withheld
        for each in there
        if each.name not in session.takes
    }


def _parents(session: Session) -> list[Path]:
    """Return the folders in which a session has a folder of each take."""
    known = {"session": session.name, "take": ""}
    return [Path(pattern.format(**known)) for pattern in (paths.TAKE, paths.TAKE_EVALUATION)]


def of_nobody(session: Session) -> dict[str, list[str]]:
    """Return, by folder of a take, the persons of exported files there whom the take does not have.

    The files of a person who was renamed stay beside the new ones.
    """
    return _of_others(session, _person, lambda take: take.subjects)


def of_no_camera(session: Session) -> dict[str, list[str]]:
    """Return, by folder of a take, the cameras and sources of files that the take does not have."""
    return _of_others(session, _camera, _cameras)


def _cameras(take: Take) -> set[str]:
    """Return the cameras of a take, and the skeletons that its devices may give."""
    sources = (name + ending for name in take.devices for ending in SOURCES)
    return {*take.cameras, "cameras", *sources}  # of all cameras together, among those of devices


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
    """Return of which camera, or source of a device, a file is, seen from the folder of a take."""
    folders = path.parts[:-1]
    if path.name.startswith("."):
        return None
    if len(folders) > 2 and folders[0] in ("pose3d_ik", "motion") and folders[1] == "devices":
        return folders[2]
    if folders == ("devices",):
        return path.name.split(".")[0]
    return path.name.split(".")[-2] if folders[:1] and folders[0] in OF_A_CAMERA else None


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
    folder = next((one for one in _parents(session) if path.is_relative_to(one)), None)
    if folder is None:
        return False
    name, *parts = path.relative_to(folder).parts
    take, inner = session.takes.get(name), Path(*parts)
    if take is None or _is_refused(session, take, inner):
        return True
    person, camera = _person(inner), _camera(inner)
    is_of_another = person is not None and person not in take.subjects
    return is_of_another or not (camera is None or camera in _cameras(take))


def without_consent(study: Study) -> dict[str, list[str]]:
    """Return, by session, the files that persons there have not agreed to, or no longer agree to.

    Of sessions in which all have agreed to everything there are none. Files of a take without
    consent to `analysis` are in its folder (`of_takes`), and are not listed.
    """
    found = {}
    for session in study.sessions.values():
        there = [*filter(_is_file, _not_agreed(study, session)), *_refused_files(session)]
        there += filter(_is_file, _static(session))
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
    yield from together.every_network_table(study)
    yield from together.every_study_table(study)


def _refused_files(session: Session) -> Iterator[str]:
    """Yield what is on the disk of takes, and somebody in them has not agreed to.

    Also what was asked for by name, and what the study made before it was changed.
    """
    for take in session.takes.values():
        folder = _folder(session, take.name)
        if any(consent.refusing(session, take, word) for word in WORDS):
            every = (path for path in folder.rglob("[!.]*") if path.is_file())
            yield from (
                path.as_posix()
                for path in every
                if _is_refused(session, take, path.relative_to(folder))
            )


def _static(session: Session) -> Iterator[str]:
    """Yield the pictures of cameras whose static recording shows somebody who has withdrawn."""
    gone = [name for name, one in session.cameras.items() if session.withheld and not one.static]
    for pattern in (paths.STATIC, paths.STATIC_CHECK, paths.CLICKING_PAGE):
        yield from paths.each(pattern, session=session.name, camera=gone)


def _is_refused(session: Session, take: Take, path: Path) -> bool:
    """Tell whether persons have not agreed to a file, seen from the folder of their take."""
    if _is_pictured(path) and consent.refusing(session, take, "pictures"):
        return True
    return bool(set(_exported(take, path)) & set(consent.refusing(session, take, "export")))


def _is_pictured(path: Path) -> bool:
    folder, kind = path.parts[0], path.name.split(".")[0]
    return (
        (folder == "videos" and path.suffix == ".mp4")
        or (folder == "figures" and kind in takes.PICTURED)
        or path.as_posix() == PEOPLE_PAGE
    )


def _exported(take: Take, path: Path) -> Iterable[str | None]:
    """Return whose motion a file has for other programs."""
    folder, kind = path.parts[0], path.name.split(".")[0]
    if folder == "pose2sim":
        return take.subjects
    if folder == "devices":
        # A correction is a step of the study, whatever its format.
        is_own = kind.endswith("-corrected") or path.name.endswith(".frames.csv")
        if path.suffix not in EXPORTED or is_own:
            return []
        # The devices of earlier files may be no more.
        return [take.person_of_devices] if take.devices else take.subjects
    if path.suffix == ".csv" and folder.startswith("pose3d"):
        return [path.name.split(".")[-2]]
    return [_person(path)]


def _is_file(path: str) -> bool:
    return Path(path).is_file()
