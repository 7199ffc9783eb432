"""Reading and checking all configuration at once: every fault, one line each."""

import itertools
import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from courtside.study.configuration import (
    model_faults,
    named_faults,
    schemas,
    session_faults,
    session_files,
    sessions,
    take_faults,
    yaml_files,
)
from courtside.study.configuration.sessions import Model, Session, Study
from courtside.study.configuration.yaml_files import Content
from courtside.study.errors import InputError, StrPath, nearest
from courtside.study.execution.artefacts import Artefact

# Folders of results/ that are no session.
RESERVED = ("external", "networks", "run", "figures", "virtual", "plans")
# Calibrations that need different things, one of each.
USUAL_WAYS = ("file", "sfm-n40", "known", "board", "wand", "people")
FUSED = ("fusions", "compared_fusions")  # lists of ways to fuse views
OF_SESSION = {"description", "court", "cameras"}  # keys of every session, and of no study

# Names of folders and files: none leaves its folder, is an option, or a device of Windows; and none
# is read as a missing value where a table holds it.
NAME = re.compile(
    r"(?!(?:con|prn|aux|nul|com[0-9]|lpt[0-9]|na|nan|none|null)\Z)[a-z0-9][a-z0-9_-]{0,63}"
)


def load(config: Content, config_file: str, folder: StrPath, root: StrPath = ".") -> Study:
    """Check the whole configuration and return what it says.

    `config` is merged, as Snakemake gives it, from config.yaml and a user's `config_file`, whose
    name is for messages. `folder` is config/ with sessions/, skeletons/ and the registers of
    models, detectors and artefacts; relative paths in them start from `root`. An `InputError` has
    every fault of every file.
    """
    _check_kind(config, config_file, Path(folder))
    try:
        return _study(config, config_file, Path(folder), root)
    except InputError as error:
        default = Path(folder) / sessions.DEFAULT
        raise InputError(*_placed(error.lines, config, config_file, default)) from None


def _check_kind(config: Content, own: str, folder: Path) -> None:
    """Raise an `InputError` if the file of a session was given in place of a study's."""
    studies = [str(folder / name) for name in re.findall(r"[a-z0-9_-]+\.yaml", own)]
    there = [study for study in studies if Path(study).is_file()]
    if OF_SESSION.issubset(config) and own not in there:
        right = "a study that names this session among its `sessions`"
        right = f"--configfile {there[0]}" if there else right
        raise InputError(
            f"{own}: expected the file of a study, found that of a session; give {right}"
        )


def _placed(faults: Iterable[str], config: Content, own: str, default: Path) -> Iterator[str]:
    """Yield faults, those of the study with the file in which the value of their key stands."""
    for line in faults:
        if line.startswith(f"{own}: "):
            told = line.removeprefix(f"{own}: ")
            key = told.partition(": ")[0]
            yield f"{yaml_files.file_of(key, config, own, default)}: {told}"
        else:
            yield line


def _study(config: Content, config_file: str, folder: Path, root: StrPath) -> Study:
    """Return the study that `load` returns, or raise its faults."""
    faults: list[str] = []
    external = _checked(folder / "external.yaml", "external", faults)
    models = _checked(folder / "models.yaml", "models", faults)
    detectors = _checked(folder / "detectors.yaml", "detectors", faults)
    faults += schemas.faults(config, "config", config_file)
    known = None if external is None else {k: Artefact(k, **v) for k, v in external.items()}
    faults += model_faults.find(folder, models, detectors, known)
    if models is not None:
        faults += take_faults.unknown(f"{config_file}: models", _names(config, "models"), models)
    found = {}
    for name in _names(config, "sessions"):
        file = folder / "sessions" / f"{name}.yaml"
        missing = list(_name_faults(f"{config_file}: sessions", name, file))
        faults += missing
        content = None if missing else _checked(file, "session", faults)
        if content is not None:
            content = session_files.filled(content)
            faults += session_faults.find(folder, file, content, known, Path(root))
            faults += _unknown_models(file, content, models)
            found[name] = (file, content)
    if not faults:
        config = _without_absent(config, config_file, folder / sessions.DEFAULT)
        faults += _step_faults(config, config_file, models or {}, found)
        faults += model_faults.absent(folder, Path(root), models, detectors, _used(config, found))
    if faults or known is None or models is None or detectors is None:
        raise InputError(*faults)
    study = Study(
        sessions=_sessions(config, found, root),
        artefacts=known,
        models=_models(models, detectors, found),
        parameters=config,
        folder=folder,
        file=config_file,
    )
    faults = [*_take_faults(study, Path(root)), *_layout_faults(study, config_file)]
    if faults := [*faults, *named_faults.find(config_file, study)]:
        raise InputError(*faults)
    return study


def _without_absent(config: Content, own: str, default: Path) -> Content:
    """Return a configuration without the default file's variations of sessions that are not run."""
    if yaml_files.file_of("variations", config, own, default) == own:
        return config
    known, there = config["conditions"], config["sessions"]
    run = [name for name in config["variations"] if known.get(name, {}).get("session") in there]
    return config | {"variations": run}


def _step_faults(
    config: Content, config_file: str, models: Content, found: dict[str, tuple]
) -> Iterator[str]:
    """Yield the faults of the steps that name sessions, takes or networks themselves."""
    yield from session_faults.conditions(config_file, config, found)
    yield from take_faults.evaluated(config_file, config["evaluate_networks"], models, found)
    imported = [name for _, content in found.values() for name in take_faults.imported(content)]
    where, wanted = f"{config_file}: compare_networks", config["compare_networks"]["networks"]
    yield from take_faults.unknown(f"{where}.networks", wanted, {*models, *imported})


def _unknown_models(file: Path, content: Content, models: Content | None) -> list[str]:
    """Return a fault for each unknown model of a session; all are known if `models` has faults."""
    wanted = content.get("override", {}).get("models", [])
    there = [*(models or wanted), *take_faults.imported(content)]
    return take_faults.unknown(f"{file}: override.models", wanted, there)


def _take_faults(study: Study, root: Path) -> Iterator[str]:
    """Yield why takes cannot be measured as their sessions and the study together ask."""
    for session in study.sessions.values():
        yield from [*unmeasured(study, session)] or _unknown_names(session)
    yield from _unmade_cameras(study, root)
    yield from _device_faults(study)


def unmeasured(study: Study, session: Session) -> Iterator[str]:
    """Yield why nothing of a session's takes is measured, unless its lists are empty for that."""
    if session.waits:
        return
    takes = [take for take in session.takes.values() if len(take.cameras) > 1]
    ways, named = session.calibrations(), session.parameters["calibrations"]
    wanted = session.parameters["take_calibrations"]
    if takes and ways and wanted and not set(ways) & set(wanted):
        yield (
            f"{study.where(session, 'take_calibrations')}: expected one of the calibrations {ways} "
            f"of session {session.name}, by which its takes are measured, found {wanted}; "
            f"{_measuring(study, session, ways)}"
        )
    alone = "people" in named and session.court is None
    if takes and not ways and alone and not session.has_scale():
        where = study.where(session, "calibrations")
        yield f"{where}: session {session.name}: {session_faults.UNSCALED}"
    elif takes and not ways and wanted and not session.unclicked:
        yield _impossible(study, session)
    if takes and ways and wanted and not any(map(session.fusions_of, takes)):
        yield (
            f"{study.where(session, 'fusions')}: expected one whose cameras film a take of session "
            f"{session.name}, found {session.parameters['fusions']}; add all-robust, or its set of "
            "cameras to the session's `views`"
        )


def _unknown_names(session: Session) -> Iterator[str]:
    """Yield what a session's own lists name and nothing has; a list of the study may name more."""
    own = {} if session.condition else session.override  # a variation is without takes
    known = session.parameters["calibrations"]
    for name in own.get("take_calibrations", []):
        if name not in known:
            yield (
                f"{session.file}: override.take_calibrations: expected names of `calibrations`, "
                f"{known}, found {name}; name it in both lists, or remove it"
            )
    named = [(key, name) for key in FUSED for name in own.get(key, [])]
    for key, name in named if session.cameras else ():
        if not session.fused_cameras(name):
            yield (
                f"{session.file}: override.{key}: expected sets of cameras of the session, "
                f"{['all', *session.views]}, found {name}; correct the name, or state its cameras "
                "(`views`, `halfbody`)"
            )


def _measuring(study: Study, session: Session, ways: list[str]) -> str:
    """Return what to do where no calibration of a session measures its takes."""
    default = f"{study.folder / sessions.DEFAULT}: "
    own = study.where(session, "calibrations")
    stated = study.where(session, "take_calibrations")
    if stated.startswith(default) and not own.startswith(default):
        file, _, key = own.partition(": ")
        line = f"take_calibrations: [{', '.join(ways)}]"
        line = f"override: {{{line}}}" if key.startswith("override") else line
        return f"add `{line}` to {file}, beside `calibrations`"
    return "name one in both lists, or none in the session's `override`"


def _impossible(study: Study, session: Session) -> str:
    """Return the fault of a session whose calibrations all need what it does not have."""
    of_session = session.parameters | {"calibrations": list(USUAL_WAYS)}
    possible = replace(session, parameters=of_session).calibrations()
    such = f", such as {', '.join(possible)}" if possible else ""
    return (
        f"{study.where(session, 'calibrations')}: expected a calibration that the recordings and "
        f"the court of session {session.name} allow{such}, found "
        f"{session.parameters['calibrations']}; name another, or add what these need "
        "(config/README.md, Keys of `config.yaml`)"
    )


def _unmade_cameras(study: Study, root: Path) -> Iterator[str]:
    """Yield a fault for each session that uses cameras of another one that nothing makes."""
    for session in study.sessions.values():
        made, missing = _borrowed(session, root)
        if made is None or not missing or session.waits:
            continue
        base = study.sessions.get(made["session"])
        ways = base.calibrations() if base else []
        if made["calibration"] in ways:
            continue
        if base:
            why = f"session {base.name} has the calibrations {ways}"
            advice = f"add {made['calibration']} to them"
        else:
            why = f"session {made['session']} is not one of `sessions`"
            advice = f"add {made['session']} there"
        yield (
            f"{session.file}: calibration.file: expected {' and '.join(missing)}, or a session of "
            f"the study that makes them, found neither: {why}; {advice}, or put the files there"
        )


def _borrowed(session: Session, root: Path) -> tuple[re.Match[str] | None, list[str]]:
    """Return whose cameras a session uses, None of no session, and which of their files lack."""
    file = session.calibration_file or ""
    needed = filter(None, [file, session.file_covariance])
    missing = [path for path in needed if not session_files.is_there(root / path)]
    return session_files.MADE.fullmatch(file), missing


def _waits(session: Session, there: dict[str, Session], root: Path) -> bool:
    """Say whether a session's cameras are made as soon as points of another one are clicked."""
    made, missing = _borrowed(session, root)
    base = there.get(made["session"]) if made and missing else None
    if made is None or base is None or not base.unclicked:
        return False
    clicked = replace(base, court_points=base.unclicked, unclicked=None)
    return made["calibration"] in set(clicked.calibrations()) - set(base.calibrations())


def _device_faults(study: Study) -> Iterator[str]:
    """Yield a fault for each device whose pictures the first of the networks cannot measure."""
    for session, take in study.takes():
        model = study.models[session.parameters["models"][0]]
        wanted = {}
        if not model.metric_body:
            wanted["rgb"] = "a network with a metric body (decoder blazepose)"
        if model.landmarks is None:
            wanted["rgbd"] = "a network, which alone looks at its pictures,"
        for name, device in take.devices.items():
            if device.kind in wanted:
                yield (
                    f"{session.file}: takes.{take.name}.devices.{name}: expected "
                    f"{wanted[device.kind]} as the first of `models`, found {model.name}; name one "
                    "first, or state the device in a session of its own"
                )


def _layout_faults(study: Study, config_file: str) -> Iterator[str]:
    """Yield what in the layouts of fig 5 no take has: cameras, and keypoints to compare with."""
    known = study.parameters["evaluate_networks"]["takes"]
    for layout, place in study.parameters["draw_badminton_fig05"]["layouts"].items():
        where = f"{config_file}: draw_badminton_fig05.layouts.{layout}"
        for session, take in study.named_takes([place["take"]]):
            yield from take_faults.unknown(f"{where}.cameras", place["cameras"], take.videos)
            if not session.virtual and place["take"] not in known:
                yield (
                    f"{where}.take: expected a virtual take, or one of evaluate_networks.takes, "
                    f"found {place['take']}; name it there with its imported keypoints"
                )
            elif not session.virtual and not (take.synchronised and len(take.subjects) == 1):
                yield (
                    f"{where}.take: expected a take of one person by cameras on one clock "
                    "(`synchronised: true`), whose pictures are of the same moments, found "
                    f"{place['take']}; name another one"
                )


def _used(config: Content, found: dict[str, tuple]) -> list[str]:
    """Return the models that the study and its sessions name."""
    own = [content.get("override", {}).get("models", []) for _, content in found.values()]
    compared = config["evaluate_networks"]
    there = {name.partition("/")[0] for name in compared["takes"]} & set(found)
    own.append(compared["networks"] if there else [])
    step = config["compare_networks"]
    own.append(step["networks"] if set(step["sessions"]) & set(found) else [])
    return [*config["models"], *itertools.chain.from_iterable(own)]


def _models(models: Content, detectors: Content, found: dict[str, tuple]) -> dict[str, Model]:
    """Return the networks, and the skeletons of imported keypoints."""
    imported = [name for _, content in found.values() for name in take_faults.imported(content)]
    others = {name: Model(name=name, decoder="imported", skeleton=name) for name in imported}
    return others | {name: sessions.model(name, entry, detectors) for name, entry in models.items()}


def _sessions(config: Content, found: dict[str, tuple], root: StrPath) -> dict[str, Session]:
    """Return the sessions of the files, and the variations that conditions make of them."""
    made = {
        name: session_files.session(name, file, content, config, root)
        for name, (file, content) in found.items()
    }
    waiting = [name for name in made if _waits(made[name], made, Path(root))]
    made |= {name: replace(made[name], waits=True) for name in waiting}
    for name in config["variations"]:
        condition = config["conditions"][name]
        made |= session_files.variations(made[condition["session"]], name, condition)
    return made


def _checked(path: Path, schema: str, faults: list[str]) -> Content | None:
    """Return the content of a file, None if it has faults; add those to `faults`."""
    try:
        return schemas.read(path, schema)
    except InputError as error:
        faults += error.lines
        return None


def _names(config: Content, key: str) -> list[str]:
    """Return the well-formed names of a list; the schema reports the others."""
    names = config.get(key)
    names = names if isinstance(names, list) else []
    return [name for name in names if isinstance(name, str) and NAME.fullmatch(name)]


def _name_faults(where: str, name: str, file: Path) -> Iterator[str]:
    if name in RESERVED:
        yield f"{where}: expected none of {RESERVED}, found {name!r}; rename it"
    elif not file.is_file():
        there = sorted(path.stem for path in file.parent.glob("*.yaml"))
        advice = nearest(name, there, "correct the name")
        yield f"{where}: expected a file {file}, found {there}; {advice}"
