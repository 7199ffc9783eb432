"""What the report is made of, as plain values: sessions, takes, figures and captions, tables."""

from collections.abc import Iterable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Session, Study, Take
from courtside.study.execution import verdicts
from courtside.study.jobs import evaluation
from courtside.study.methods import Calibration, Variant
from courtside.study.targets import calibration, devices, pages, takes, together

CAPTION_PARAMETERS = ("networks", "source", "step", "blur_faces")  # those that captions ask for
STEPS = (
    "extract_features",
    "match_images",
    "adjust_network",
    "detect_pose",
    "synchronise_cameras",
    "triangulate",
    "filter_motion",
)
TABLES = {
    paths.CALIBRATION_TABLE: (
        "Calibration",
        "Errors of the fixed cameras against the truth of simulated sessions, by method, number of "
        "clicks and number of pictures of the walk.",
    ),
    paths.WAYS_TABLE: (
        "Ways to calibrate",
        "All calibrations of each session: the predicted error over the court, before and after "
        "people refined cameras, the true one of simulated sessions and what the best similarity "
        "leaves of it, and the views of limb joints that are accepted in the takes measured so.",
    ),
    paths.PLAYERS_TABLE: (
        "Players",
        "Errors of joints, paths and clocks against the truth of simulated takes, by cameras and "
        "rule.",
    ),
    paths.ANGLES_TABLE: (
        "Joint angles",
        "Errors of joint angles against the truth of simulated takes, by angle, cameras and rule.",
    ),
}

VERDICTS = "verdicts on takes and cameras, with pictures"


class Wildcards(SimpleNamespace):
    """Wildcards of a figure, as captions and functions of parameters ask them."""

    def items(self) -> Iterable[tuple[str, str]]:
        """Return the names and values."""
        return vars(self).items()


def content(study: Study, rules: Iterable[Any], captions: str) -> dict[str, Any]:
    """Return what the report is made of, by Snakemake's `rules` and the folder of `captions`."""
    rules = list(rules)
    sessions = [session for session in study.sessions.values() if not session.condition]
    wanted = calibration.every_study_figure(study) + together.every_players_figure(study)
    wanted += [paths.WAYS_TABLE] * bool(evaluation.ways(study))
    return {
        "title": "Report of the study",
        "parameters": {name: study.parameters[name] for name in STEPS},
        "sessions": [_session(study, session) for session in sessions],
        "figures": [_figure(path, rules, captions) for path in pictures(study)],
        "tables": [
            {"file": path, "title": title, "words": words, "link": _link(path)}
            for path, (title, words) in TABLES.items()
            if path in wanted
        ],
    }


def files(part: Any) -> list[str]:
    """Return every file and every caption that the content of the report names."""
    if isinstance(part, dict):
        part = [value for key, value in part.items() if key not in ("links", "link", "params")]
    if isinstance(part, list | tuple):
        return sorted({path for item in part for path in files(item)})
    named = isinstance(part, str) and (
        part.startswith(f"{paths.RESULTS}/") or part.endswith(".rst")
    )
    return [part] if named else []


def pictures(study: Study) -> list[str]:
    """Return the PNG of every figure of the study, each once."""
    lists = (
        takes.every_figure,
        takes.every_shake,
        together.every_players_figure,
        devices.every_device_figure,
        calibration.every_study_figure,
        pages.every_plan,
    )
    found = [path for every in lists for path in every(study) if path.endswith(".png")]
    return list(dict.fromkeys(found))


def _link(path: str) -> str:
    """Return a path as seen from the folder of the report."""
    return Path(path).relative_to(Path(paths.REPORT).parent).as_posix()


def _figure(path: str, rules: Iterable[Any], captions: str) -> dict[str, Any]:
    """Return a figure: its picture, and the caption, wildcards and parameters of its rule."""
    drawn_by = next(rule for rule in rules if rule.is_producer(path))
    wildcards = Wildcards(**drawn_by.get_wildcards(path))
    caption = next(
        output.flags["report"].caption for output in drawn_by.output if output.match(path)
    )
    params = {
        name: value(wildcards) if callable(value) else value
        for name, value in drawn_by.params.items()
        if name in CAPTION_PARAMETERS
    }
    place, stem = Path(path).parts, path.removesuffix(".png")
    return {
        "png": path,
        "caption": f"{captions}/{Path(caption).name}",
        "wildcards": vars(wildcards),
        "params": params,
        "session": {"figures": "", "plans": "planned sessions"}.get(place[1], place[1]),
        "take": place[3] if place[2] == "takes" else "",
        "links": [(_link(f"{stem}.csv"), "numbers (CSV)"), (_link(f"{stem}.pdf"), "PDF")],
    }


def _session(study: Study, session: Session) -> dict[str, Any]:
    """Return what the report says of a session."""
    ways = [Calibration.parse(name) for name in session.calibrations()]
    way = next(iter(session.take_calibrations()), ways[0].name if ways else None)
    variant = _reported_variant(session, way)
    every = dict.fromkeys(name for one in ways for name in (one.base, one.name) if name)
    return {
        "name": session.name,
        "description": session.description,
        "virtual": bool(session.virtual),
        "calibration": way,
        "mapper": variant and variant.mapper,
        "n_images": variant and variant.n_images,
        "fusion": next(iter(session.fusions()), None),
        "model": session.parameters["models"][0],
        "imported": study.models[session.parameters["models"][0]].decoder == "imported",
        "overrides": _overrides(study, session),
        "withheld": consent.left_out(session),
        "limits": _limits(session),
        "files": _of_cameras(session, way, every),
        "links": [(_link(path), VERDICTS) for path in pages.quality_pages(session)],
        "takes": [_take(study, session, take) for take in session.takes.values()],
    }


def cameras(session: Session) -> dict[str, Any]:
    """Return what the page for quality says of the cameras that takes are measured with."""
    way, *others = session.take_calibrations()
    files = _of_cameras(session, way, [way, *others])
    return {"calibration": way, "others": others, "files": files, "limits": _limits(session)}


def _of_cameras(session: Session, way: str | None, names: Iterable[str]) -> dict[str, Any]:
    """Return the files about a session's cameras, with the quality of the calibrations named.

    The structure from motion is that of the calibration `way`.
    """
    known, variant = {"session": session.name}, _reported_variant(session, way)
    quality = {name: paths.CALIBRATION_QUALITY.format(**known, calibration=name) for name in names}
    model: dict[str, Any] = {}
    if variant:
        model = {"model": paths.SFM_SUMMARY.format(**known, **vars(variant))}
        model["static"] = [paths.STATIC_CHECK.format(**known, camera=c) for c in session.cameras]
    checks = {"checks": checked} if (checked := calibration.file_checks(session)) else {}
    return {"quality": quality, **checks, **model}


def _limits(session: Session) -> dict[str, float]:
    """Return how far a fixed camera of a session may move."""
    limits = session.parameters["extract_static"]
    return {key: limits[key] for key in ("max_shift_px", "max_zoom_percent")}


def _reported_variant(session: Session, way: str | None) -> Variant | None:
    """Return the structure from motion that the report describes: of photos alone the first.

    Otherwise the global one that the calibration `way` rests on, or else the first of the session.
    """
    if session.walks and not session.cameras:
        return next(iter(session.variants()), None)
    names = [way] if way else []
    every = [Calibration.parse(name).variant for name in [*names, *session.calibrations()]]
    return next((one for one in every if one and one.mapper == "global"), None)


def _overrides(study: Study, session: Session) -> dict[str, dict]:
    """Return the keys of the reported steps in which a session differs from the study."""
    found: dict[str, dict] = {}
    for name in STEPS:
        own, usual = session.parameters[name], study.parameters[name]
        differ = {key: value for key, value in own.items() if usual.get(key) != value}
        found |= {name: differ} if differ else {}
    return found


def _take(study: Study, session: Session, take: Take) -> dict[str, Any]:
    """Return what the report says of a take, measured with the first calibration and network."""
    fusion, ways = next(iter(session.fusions_of(take)), None), session.take_calibrations()
    known = {"session": session.name, "take": take.name, "model": session.parameters["models"][0]}
    named: dict[str, Any] = {}
    links: list[tuple[str, str]] = []
    if ways and fusion:
        known |= {"calibration": ways[0], "fusion": fusion}
        named = _measured(session, take, known)
        links = [(named["summary"], "summary (CSV)"), (named["frames"], "frames (CSV)")]
        links.append((paths.STEPS.format(**known), "steps (CSV)"))
        links += [(named["strokes"], "strokes (CSV)")] if takes.badminton(session) else []
    if take.devices:
        named["checks"] = paths.DEVICE_CHECKS.format(**known)
    links += [(path, "3D viewer") for path in pages.viewers(session, take)]
    for path in pages.overlay_videos(study, session, take):
        links.append((path, f"video {Path(path).stem.rpartition('.')[2]}"))
    return {
        "name": take.name,
        "fusion": fusion,
        "files": named,
        "links": [(_link(path), words) for path, words in links],
    }


def _measured(session: Session, take: Take, known: dict[str, str]) -> dict[str, Any]:
    """Return the files of a take that was measured by fixed cameras, by what they say."""
    patterns = {
        "summary": paths.MEASURES,
        "frames": paths.FRAME_MEASURES,
        "cutoffs": paths.CUTOFFS,
        "footwork": paths.FOOTWORK_MEASURES,
        "pose3d": paths.POSE3D,
        "sync": paths.CAMERA_CLOCKS,
    }
    patterns |= {"shake": paths.SHAKE_TEXT} if take.steady else {}
    patterns |= {"strokes": paths.STROKES} if takes.badminton(session) else {}
    named: dict[str, Any] = {name: pattern.format(**known) for name, pattern in patterns.items()}
    named["movement"] = takes.checks(session, take)
    way = {key: known[key] for key in verdicts.WAY}
    named["quality"] = {"file": paths.QUALITY.format(**known), "way": way}
    if session.virtual:
        named["errors"] = paths.ERRORS.format(**known)
        named["kinematics"] = paths.MEASURE_ERRORS.format(**known)
    return named
