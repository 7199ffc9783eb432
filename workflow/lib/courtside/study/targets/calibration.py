"""What the study makes of calibrations: cameras, errors, figures of the calibration study."""

from collections.abc import Callable, Collection, Iterable

from courtside.study import paths
from courtside.study.configuration import session_files
from courtside.study.configuration.sessions import Session, Study
from courtside.study.methods import Calibration, Variant


def every_calibration(study: Study) -> list[str]:
    """Return the cameras of every session, found in every way that the study names."""
    return [
        paths.CAMERAS.format(session=session.name, calibration=way)
        for session in study.sessions.values()
        for way in session.calibrations()
    ]


def every_file_check(study: Study) -> list[str]:
    """Return the checks of every calibration file that takes are measured with."""
    return [path for session in study.sessions.values() for path in file_checks(session)]


def file_checks(session: Session) -> list[str]:
    """Return the checks of a session's calibration file; none if takes are not measured with it.

    By pictures of the hall, by painted lines, and by people and static points.
    """
    if "file" not in session.take_calibrations():
        return []
    filmed = any(take.cameras for take in session.takes.values())
    checks = {
        paths.VIDEO_CHECK: bool(session.filmed_halls()),
        paths.COURT_CHECK: session.shows_court(),
        paths.CALIBRATION_CHECK: filmed or bool(session.static_points),
    }
    known = {"session": session.name, "suffix": "json"}
    return [path.format(**known) for path, is_made in checks.items() if is_made]


def warning_files(session: Session) -> list[str]:
    """Return the files with the warnings about cameras that takes are measured with."""
    known = {"session": session.name}
    ways = session.take_calibrations()
    own = [paths.CALIBRATION_QUALITY.format(**known, calibration=way) for way in ways]
    return own + file_checks(session)


def every_photo_model(study: Study) -> list[str]:
    """Return the models of sessions without fixed cameras, which have walks or photos only."""
    return [
        paths.SFM_SUMMARY.format(session=session.name, **vars(variant))
        for session in study.sessions.values()
        if session.walks and not session.cameras
        for variant in session.variants()
    ]


def every_evaluation(study: Study) -> list[str]:
    """Return the errors of every calibration of the calibration study."""
    return every_error(filmed_for_calibration(study))


def every_error(sessions: Iterable[Session]) -> list[str]:
    """Return all tables of calibration errors of virtual sessions."""
    sessions = list(sessions)
    known = [paths.KNOWN_ERRORS.format(session=session.name) for session in sessions]
    return [
        paths.SFM_ERRORS.format(session=session.name, **vars(variant))
        for session in sessions
        for variant in session.variants()
    ] + known


def every_study_figure(study: Study) -> list[str]:
    """Return the figures and tables of the calibration study."""
    courts = sorted({session.court for session in study.sessions.values() if session.court})
    names = [f"court_points.{court}" for court in courts]
    names += [*drawn_conditions(study), *world_conditions(study)]
    stems = paths.each(paths.STUDY_FIGURE, figure=names)
    for session in swept(study):
        names = ["badminton_fig08", "coverage", "growth"]
        names += [f"badminton_fig06.{mapper}" for mapper in session.parameters["sweep"]["mappers"]]
        stems += paths.each(paths.SESSION_FIGURE, session=session.name, figure=names)
    for session in study.sessions.values():
        if session.court:
            ways = map(Calibration.parse, session.calibrations())
            names = [f"error_map.{way.name}" for way in ways if session.has_covariance(way)]
            stems += paths.each(paths.SESSION_FIGURE, session=session.name, figure=names)
    if racket_sessions(study):
        stems.append(paths.STUDY_FIGURE.format(figure="badminton_fig12"))
    return paths.formats(stems) + [paths.CALIBRATION_TABLE] * bool(swept(study))


def filmed_for_calibration(study: Study) -> list[Session]:
    """Return the sessions of the calibration study: virtual, with a walk and without takes."""
    return [s for s in study.sessions.values() if s.virtual and s.walks and not s.takes]


def swept(study: Study) -> list[Session]:
    """Return the sessions of the calibration study that are no variation of another."""
    return [session for session in filmed_for_calibration(study) if not session.condition]


def tabulated(study: Study) -> list[Session]:
    """Return the sessions of the calibration table: without conditions that have a figure."""
    drawn = [*drawn_conditions(study).values(), *world_conditions(study).values()]
    return [s for s in filmed_for_calibration(study) if s.condition.get("condition") not in drawn]


def varied(study: Study, condition: str) -> list[Session]:
    """Return the sessions that are variations under a condition."""
    sessions = study.sessions.values()
    return [s for s in sessions if s.condition.get("condition") == condition]


def drawn_conditions(study: Study) -> dict[str, str]:
    """Return {figure: condition} of the conditions that vary how a session is filmed."""
    return _conditions(study, lambda keys: "world" not in keys)


def world_conditions(study: Study) -> dict[str, str]:
    """Return {figure: condition} of the conditions that vary how wrong the world is."""
    return _conditions(study, lambda keys: "world" in keys)


def _conditions(study: Study, wanted: Callable[[Collection[str]], bool]) -> dict[str, str]:
    known = study.parameters["conditions"]
    names = [name for name in study.parameters["variations"] if wanted(known[name]["vary"])]
    figures = [(session_files.figure_of(name, known[name]), name) for name in names]
    return {figure: name for figure, name in figures if figure}


def racket_models(study: Study, session: Session) -> list[Variant]:
    """Return the structures from motion that a racket is measured with: one number of images."""
    count = study.parameters["evaluate_racket"]["n_images"]
    return [v for v in session.variants() if (v.mapper, v.n_images) == ("global", count)]


def racket_sessions(study: Study) -> list[str]:
    """Return the names of the sessions in which a racket is measured: those with such models."""
    wanted = study.parameters["evaluate_racket"]["sessions"]
    there = [name for name in wanted if name in study.sessions]
    return [name for name in there if racket_models(study, study.sessions[name])]
