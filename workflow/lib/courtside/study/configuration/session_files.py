"""Building sessions from their files, and variations of virtual ones from a condition."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import product
from os.path import normpath
from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.configuration import consent, schemas
from courtside.study.configuration.sessions import Device, FixedCamera, Session, Subject, Take
from courtside.study.configuration.yaml_files import Content
from courtside.study.errors import LONGEST, InputError, StrPath
from courtside.study.methods import Calibration

KINDS = {  # of devices, by the ending of their recording; a folder is one of a depth camera
    ".bvh": "inertial",
    ".bag": "rgbd",
    ".db3": "rgbd",
    "": "rgbd",
    ".json": "nuitrack",
    ".csv": "nuitrack",
}
# Of a take, as its record has them.
AS_STATED = ("synchronised", "steady", "virtual", "clocks", "pose2d", "pose3d", "rate_hz")

MAY_BE_EMPTY = ("subjects", "cameras", "walks", "takes")  # of which a session names some
FOR_ALL_TAKES = ("synchronised",)  # of a session, where its takes do not say it themselves
MADE = re.compile(  # the cameras of a session of the study
    paths.CAMERAS.replace(".", r"\.").format(
        session="(?P<session>[^/]+)", calibration="(?P<calibration>[^/]+)"
    )
)
SEEDS = {"seed", "walk_seed"}  # of virtual sessions; variations of these alone have no figure
OVERRIDDEN = ("principal_point_px", "reason")  # of a calibration file, as its session states them


def kind_of(recording: str) -> str:
    """Return the kind of a device by the ending of its recording; a video by default."""
    path = Path(recording)
    if is_there(path) and path.is_dir():  # a dot in its name begins no ending
        return "rgbd"
    return KINDS.get(path.suffix.lower(), "rgb")


def is_there(path: Path) -> bool:
    """Tell whether a file or folder exists; one whose name no disk takes does not."""
    try:
        return path.exists()
    except OSError:
        return False


def has_places(path: Path) -> bool:
    """Tell whether a table of clicked points states their places, m; False if it is no table.

    Also one with other characters than commas between the cells, which is refused later.
    """
    try:
        with path.open(encoding="utf-8-sig") as stream:
            return "x_m" in re.split(r"[\s,;\"']+", stream.readline(LONGEST))
    except (OSError, ValueError):
        return False


def of_configuration(path: str | None, folder: Path) -> str | None:
    """Return a path of a session; one that begins with `config/` is below the `folder` config/."""
    inside = (path or "").removeprefix("config/")
    return path if inside == (path or "") else str(folder / inside)


def filled(content: Content) -> Content:
    """Return what a session's file says, with `{}` for a name of which it says nothing.

    Without the `static` recordings that are videos of takes of which nothing is made: no picture
    of their persons is, either, and the recordings may be gone.
    """
    parts = {key: content[key] for key in MAY_BE_EMPTY if key in content}
    content = content | {
        key: {name: {} if said is None else said for name, said in part.items()}
        for key, part in parts.items()
    }
    takes = [
        take for take in content.get("takes", {}).values() if consent.is_withheld(content, take)
    ]
    gone = {normpath(path) for take in takes for path in take.get("videos", {}).values()}
    cameras = {
        name: {
            key: value
            for key, value in said.items()
            if key != "static" or normpath(value) not in gone
        }
        for name, said in content["cameras"].items()
    }
    return content | {"cameras": cameras}


def session(
    name: str, file: StrPath, content: Content, parameters: Content, root: StrPath = "."
) -> Session:
    """Build a `Session` from its checked YAML file, `filled`.

    Its `override` changes steps of `parameters`, the study's; relative paths start from `root`.
    """
    clicked, unclicked = _clicks(content, root)
    subjects, walks = _subjects(content), content.get("walks", {}).items()
    recordings = {} if content.get("virtual") is None else _virtual(name, content)
    shared = {key: content[key] for key in FOR_ALL_TAKES if key in content}
    takes = {
        key: _take(key, shared | value, recordings.get("takes", {}).get(key), subjects)
        for key, value in content.get("takes", {}).items()
    }
    config = Path(file).parent.parent
    cameras = {key: _camera(value) for key, value in content["cameras"].items()}
    for key, path in recordings.get("static", {}).items():
        cameras[key] = replace(cameras[key], static=path)
    agreed, withheld = consent.by_consent(takes, subjects)
    return Session(
        name=name,
        file=str(file),
        description=content["description"],
        court=None if content["court"] == "none" else content["court"],
        subjects=subjects,
        cameras=cameras,
        takes=agreed,
        withheld=withheld,
        **_calibration(content, config, cameras, Path(root)),
        people=of_configuration(content.get("people"), config),
        walks=recordings.get("walks") or {k: w.get("video") or w["images"] for k, w in walks},
        court_points=recordings.get("court_points") or clicked,
        point_sets=_point_sets(config / paths.COURT_YAML.format(court=content["court"])),
        placed=bool(clicked) and has_places(Path(root) / str(clicked)),
        unclicked=unclicked,
        virtual=content.get("virtual"),
        condition={},
        blur_faces=content.get("blur_faces", "virtual" not in content),
        views={key: tuple(cameras) for key, cameras in content.get("views", {}).items()},
        halfbody=content.get("halfbody"),
        parameters=_merged(parameters, content.get("override", {})),
        override=content.get("override", {}),
    )


def _point_sets(court_yaml: Path) -> frozenset[int] | None:
    """Return how many points a court and its sets have; None of a court that cannot be read."""
    try:
        court = schemas.read(court_yaml, "court")
    except InputError:  # what is wrong is told where the court is needed
        return None
    return frozenset(map(len, [court["points"], *court["sets"].values()]))


def _calibration(
    content: Content, config: Path, cameras: Mapping[str, FixedCamera], root: Path
) -> dict[str, Any]:
    """Return a session's fields of how its cameras are calibrated, but for court points."""
    given = content.get("calibration", {})
    return {
        "also_known": "known" in content.get("override", {}).get("calibrations", []),
        "board": content.get("board"),
        "wand": content.get("wand"),
        "static_points": of_configuration(content.get("static_points"), config),
        "known_lengths": tuple(content.get("known_lengths", ())),
        "calibration_file": given.get("file"),
        "calibration_override": {key: given[key] for key in OVERRIDDEN if key in given},
        "calibration_unit": given.get("unit"),
        "file_covariance": _file_covariance(given, cameras, root) if given else None,
    }


def _file_covariance(given: Content, cameras: Mapping[str, FixedCamera], root: Path) -> str | None:
    """Return the covariance that lies beside a calibration file, as this study writes them.

    None without one, and if the session does not use the cameras as they are in the file: if it
    renames or scales them, or replaces their numbers.
    """
    file = Path(given["file"])
    beside = file.with_name(Path(paths.CAMERA_COVARIANCE).name)
    changed = any(key in given for key in OVERRIDDEN)
    changed |= any(one.name_in_calibration or one.scale != 1 for one in cameras.values())
    made = MADE.fullmatch(file.as_posix())
    known = (
        Calibration.parse(made["calibration"]).has_covariance if made else is_there(root / beside)
    )
    return beside.as_posix() if known and not changed else None


def _clicks(content: Content, root: StrPath) -> tuple[str | None, str | None]:
    """Return the clicked court points, and where those are to be saved that nobody has clicked."""
    clicks = content.get("court_points")
    if not clicks or clicks.startswith(f"{paths.RESULTS}/") or is_there(Path(root) / clicks):
        return clicks, None
    return None, clicks


def variations(base: Session, name: str, content: Content) -> dict[str, Session]:
    """Build the sessions `{name}-{k}` that differ from a virtual one in some of its settings.

    `content` is that of the condition called `name`: `vary` has values of keys of `virtual`, of
    which every combination is one session; `set` has keys of `virtual` that are the same for all;
    `override` has parameters of steps that differ.
    """
    found, vary, override = {}, content["vary"], content.get("override", {})
    for k, values in enumerate(product(*vary.values())):
        varied = dict(zip(vary, values, strict=True))
        own = f"{name}-{k}"
        virtual = {**(base.virtual or {}), "boards": False, **content.get("set", {}), **varied}
        films = {"cameras": base.cameras, "walks": base.walks, "virtual": virtual}
        files = _virtual(own, films)
        found[own] = replace(
            base,
            name=own,
            cameras={
                c: replace(v, static=files["static"].get(c), chessboard=None)
                for c, v in base.cameras.items()
            },
            takes={},
            withheld={},
            walks=files["walks"],
            court_points=files["court_points"],
            virtual=virtual,
            condition={"condition": name, **varied},
            # Only their errors are wanted, and camera files where the condition names some.
            parameters=_merged(base.parameters, override)
            | {"calibrations": override.get("calibrations", [])},
        )
    return found


def figure_of(condition: str, content: Content) -> str | None:
    """Return the name of a condition's figure; None if it varies seeds alone and has none."""
    return None if set(content["vary"]) <= SEEDS else condition.replace("-", "_")


def _merged(parameters: Content, override: Content) -> Content:
    """Return `parameters` with what `override` states; tables keep what it does not name."""
    tables = {
        key: _merged(parameters[key], value)
        for key, value in override.items()
        if isinstance(value, dict) and isinstance(parameters.get(key), dict)
    }
    return {**parameters, **override, **tables}


def _subjects(content: Content) -> dict[str, Subject]:
    stated, virtual = content.get("subjects", {}), "virtual" in content
    return {
        key: Subject(
            **{**value, "consent": consent.stated(value, virtual), "seen": sightings(value)}
        )
        for key, value in stated.items()
    }


def sightings(subject: Content) -> tuple[Content, ...]:
    """Return the entries of a subject's `seen`, which may be one or a list."""
    seen = subject.get("seen", [])
    return tuple(seen if isinstance(seen, list) else [seen])


def _take(name: str, content: Content, made: Content | None, subjects: dict[str, Subject]) -> Take:
    """Build a take; `made` has the files that the simulation of a virtual one makes."""
    there = tuple(content.get("subjects", subjects))
    return Take(
        name=name,
        videos=dict(content.get("videos", {})) if made is None else made["videos"],
        devices=_devices(content if made is None else made, there),
        subjects=there,
        trim_s=tuple(content["trim_s"]) if "trim_s" in content else None,
        **{key: content[key] for key in AS_STATED if key in content},
    )


def _devices(content: Content, subjects: tuple[str, ...]) -> dict[str, Device]:
    return {
        name: Device(
            kind=kind_of(device["file"]),
            file=device["file"],
            subject=device.get("subject", subjects[0]),
            unit=device.get("unit"),
            angles=device.get("angles"),
        )
        for name, device in content.get("devices", {}).items()
    }


def _virtual(name: str, content: Content) -> Content:
    """Return the files that a simulation makes, by the keys of a session."""
    takes = {key: take["virtual"] for key, take in content.get("takes", {}).items()}
    emptied = content["cameras"] if content.get("virtual", {}).get("static_frames", 1) else ()
    return {
        "static": _films(paths.RECORDING, emptied, session=name),
        "walks": _films(paths.RECORDING, content.get("walks", {}), session=name),
        "court_points": paths.VIRTUAL_CLICKS.format(session=name),
        "takes": {
            take: _virtual_take(name, take, made, content["cameras"])
            for take, made in takes.items()
        },
    }


def _virtual_take(session: str, take: str, made: Content, cameras: Iterable[str]) -> Content:
    known, endings = {"session": session, "take": take}, {"inertial": "bvh", "rgbd": "bag"}
    devices = {}
    for name, device in made.get("devices", {}).items():
        suffix = endings[device["kind"]]
        file = paths.VIRTUAL_DEVICE.format(name=name, suffix=suffix, **known)
        # As in the simulation, a device measures the first of the players unless it says whom.
        subject = device.get("subject", next(iter(made["players"])))
        devices[name] = {"file": file, "subject": subject}
    return {
        "videos": _films(paths.VIRTUAL_FILM, made.get("cameras", cameras), **known),
        "devices": devices,
    }


def _films(pattern: str, names: Iterable[str], **known: str) -> dict[str, str]:
    return {name: pattern.format(name=name, **known) for name in names}


def _camera(content: Content) -> FixedCamera:
    crop_px = tuple(content["crop_px"]) if "crop_px" in content else None
    return FixedCamera(**{**content, "crop_px": crop_px})
