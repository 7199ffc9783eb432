"""Names of takes, persons, sessions and measures in the steps of a study that nothing has."""

from collections.abc import Iterator
from itertools import product
from typing import Any

from courtside.study import measure_names, paths
from courtside.study.configuration import session_files, yaml_files
from courtside.study.configuration.sessions import DEFAULT, Session, Study
from courtside.study.errors import nearest

WITH_TAKES = (
    *("export_overlay_video", "evaluate_networks", "evaluate_round_trip", "draw_stroke"),
    "draw_three_cameras",
)


def find(config_file: str, study: Study) -> Iterator[str]:
    """Yield a fault for each name that nothing in the study's sessions has.

    Sessions that the study does not run are passed over: one file serves several studies. So are
    values of the default file in a study with a file of its own, whose author did not write them.
    """

    def is_own(key: str) -> bool:
        default = study.folder / DEFAULT
        return yaml_files.file_of(key, study.parameters, config_file, default) == config_file

    for key, name in _named(study.parameters):
        session_name, _, take = name.partition("/")
        session = study.sessions.get(session_name)
        if session and take not in _takes(session) and is_own(key):
            yield (
                f"{config_file}: {key}: expected one of the takes of session {session_name}, "
                f"{_takes(session)}, found {name}; correct the name, or remove it"
            )
    checks = (
        *(_without_truth, _without_sources, _without_views, _without_networks, _without_takes),
        _of_one_figure,
    )
    for key, told in (fault for check in checks for fault in check(study)):
        if is_own(key):
            yield f"{config_file}: {told}"
    faults = list(_faults_of_comparison(f"{config_file}: compare_sessions", study))
    if faults and is_own("compare_sessions"):
        yield from faults


def _named(parameters: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the key and the name, `session/take`, of each take that a step names."""
    for step in WITH_TAKES:
        yield from ((f"{step}.takes", name) for name in parameters[step]["takes"])
    yield "draw_thesis_fig3.take", parameters["draw_thesis_fig3"]["take"]
    for layout, place in parameters["draw_badminton_fig05"]["layouts"].items():
        yield f"draw_badminton_fig05.layouts.{layout}.take", place["take"]


def _without_truth(study: Study) -> Iterator[tuple[str, str]]:
    """Yield the key and a fault of each recorded session that is to be compared with the truth."""
    compared = {
        "draw_three_cameras.takes": study.parameters["draw_three_cameras"]["takes"],
        "evaluate_racket.sessions": study.parameters["evaluate_racket"]["sessions"],
    }
    for key, names in compared.items():
        for name in names:
            session = study.sessions.get(name.partition("/")[0])
            if session and not session.virtual:
                yield (
                    key,
                    f"{key}: expected names of virtual sessions, whose truth is known, found "
                    f"{name}; remove it",
                )


def _without_views(study: Study) -> Iterator[tuple[str, str]]:
    """Yield the key and a fault of each take of table 1 that lacks all its sets of cameras."""
    step, key = study.parameters["evaluate_round_trip"], "evaluate_round_trip.takes"
    for session, take in study.named_takes(step["takes"]):
        if not any(session.fused_cameras_of(take, name) for name in step["fusions"]):
            yield (
                key,
                f"{key}: expected takes that one of evaluate_round_trip.fusions, "
                f"{step['fusions']}, can be made of, found {session.name}/{take.name}; name one of "
                "its sets of cameras there (`views` of the session), or remove the take",
            )


def _without_networks(study: Study) -> Iterator[tuple[str, str]]:
    """Yield the key and a fault of each take whose networks cannot be compared.

    A network looks in videos; keypoints of another program are those of the take.
    """
    step, key = study.parameters["compare_networks"], "compare_networks.sessions"
    begins = tuple(step["takes"] or [""])
    named = [
        (session, take)
        for session, take in study.takes()
        if session.name in step["sessions"] and take.name.startswith(begins)
    ]
    for (session, take), model in product(named, step["networks"]):
        known = model in take.pose2d or (model in study.models and take.videos)
        if session.measures(take) and not known:
            wanted = "videos" if model in study.models else f"`pose2d: {model}`"
            yield (
                key,
                f"{key}: expected takes with {wanted}, found none in {session.name}/{take.name}; "
                f"remove the session, or {model} from compare_networks.networks",
            )


def _without_takes(study: Study) -> Iterator[tuple[str, str]]:
    """Yield the key and a fault of each beginning of compared takes that no take has."""
    key = "compare_networks.takes"
    for told in _beginnings(key, study, study.parameters["compare_networks"]):
        yield key, told


def _without_sources(study: Study) -> Iterator[tuple[str, str]]:
    """Yield the key and a fault if the take of figures 3.1 and 3.2 lacks their sources."""
    step, key = study.parameters["draw_thesis_fig3"], "draw_thesis_fig3.take"
    for session, take in study.named_takes([step["take"]]):
        there = ["cameras"] * session.measures(take)
        for name, device in take.devices.items():
            there += [*device.sources(name, metric_body=True)]
            there += [f"{name}-corrected"] * device.is_suit
        if not take.devices:
            yield (
                key,
                f"{key}: expected a take with devices, found {step['take']}; name another, or "
                "remove the key",
            )
        elif unknown := [name for name in step["sources"] if name not in there]:
            yield (
                key,
                f"draw_thesis_fig3.sources: expected sources of {step['take']}, {there}, found "
                f"{unknown}; name two of them",
            )


def _of_one_figure(study: Study) -> Iterator[tuple[str, str]]:
    """Yield the key and a fault of each condition whose figure has a name that is taken."""
    key, drawn = "variations", dict[str, str]()
    for name in study.parameters[key]:
        figure = session_files.figure_of(name, study.parameters["conditions"][name])
        file = f"{paths.STUDY_FIGURE.format(figure=figure)}.csv"
        if figure in paths.TAKEN_FIGURES:
            yield (
                key,
                f"{key}: expected a condition whose figure has a file of its own, found {name}: "
                f"{file} is another result of the study; rename the condition",
            )
        elif figure in drawn:
            yield (
                key,
                f"{key}: expected conditions whose figures have different files, found "
                f"{drawn[figure]} and {name}, both {file}; rename one of these conditions",
            )
        elif figure:
            drawn[figure] = name


def _takes(session: Session) -> list[str]:
    """Return the takes of a session's file, those without consent among them."""
    return sorted([*session.takes, *session.withheld])


def _faults_of_comparison(where: str, study: Study) -> Iterator[str]:
    step = study.parameters["compare_sessions"]
    yield from _unknown_sessions(f"{where}.sessions", study)
    yield from measure_names.unknown(f"{where}.measures", step["measures"] or [])
    yield from _compared(where, study)


def _unknown_sessions(where: str, study: Study) -> Iterator[str]:
    """Yield a fault for each session that is compared and is nowhere: neither run nor a file."""
    folder = study.folder / "sessions"
    there = sorted({*study.sessions, *(path.stem for path in folder.glob("*.yaml"))})
    for name in study.parameters["compare_sessions"]["sessions"]:
        of_condition = name.rpartition("-")[0] in study.parameters["conditions"]
        if name not in there and not of_condition:
            advice = nearest(name, there, "correct the name, or remove it")
            yield f"{where}: expected sessions with a file in {folder}, found {name!r}; {advice}"


def _compared(where: str, study: Study) -> Iterator[str]:
    """Yield what of `compare_sessions` no session has, if the study runs all that it names."""
    step = study.parameters["compare_sessions"]
    if not step["sessions"] or not set(step["sessions"]) <= set(study.sessions):
        return
    compared = [study.sessions[name] for name in step["sessions"]]
    of = f"of {', '.join(step['sessions'])}"
    persons = sorted({name for session in compared for name in session.subjects})
    if step["subject"] not in persons:
        yield (
            f"{where}.subject: expected one of the persons {of}, {persons}, found "
            f"{step['subject']}; correct the name, or the list of sessions"
        )
    yield from _beginnings(f"{where}.takes", study, step)


def _beginnings(where: str, study: Study, step: dict[str, Any]) -> Iterator[str]:
    """Yield a fault for each beginning in a step's `takes` that no take of its `sessions` has.

    None if the study does not run all these sessions.
    """
    if not set(step["sessions"]) <= set(study.sessions):
        return
    sessions = [study.sessions[name] for name in step["sessions"]]
    takes = sorted({name for session in sessions for name in _takes(session)})
    for beginning in (step["takes"] or []) if sessions else []:
        if not any(name.startswith(beginning) for name in takes):
            yield (
                f"{where}: expected how names of takes of {', '.join(step['sessions'])} begin, "
                f"{takes}, found {beginning}; correct it, or remove it"
            )
