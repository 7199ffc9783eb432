"""What the study makes of each take: checks, exports, figures, measures, errors."""

from collections.abc import Iterable, Iterator
from itertools import product

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Session, Study, Take

# Figures that show persons in pictures.
PICTURED = ("overlay", "badminton_fig09", "badminton_fig10", "badminton_fig11")


def every_check(study: Study) -> list[str]:
    """Return the checks that cameras with a static recording stood still until each take."""
    return [path for session, take in study.takes() for path in checks(session, take)]


def checks(session: Session, take: Take) -> list[str]:
    """Return the checks of one take; none where shake is measured instead."""
    still = [] if take.steady else [c for c in take.videos if session.cameras[c].static]
    return [paths.MOVEMENT.format(session=session.name, take=take.name, camera=c) for c in still]


def every_export(study: Study) -> list[str]:
    """Return the files for other programs, of persons who agreed to them."""
    found = []
    for session, take in study.takes():
        refusing = consent.refusing(session, take, "export")
        persons = [name for name in take.subjects if name not in refusing]
        stages = session.parameters["export_stages"]
        for person, way, stage in product(persons, _ways(session), stages):
            if stage in study.stages(way["model"]):
                found += [
                    _fill(paths.EXPORT, session, take, way, stage=stage, person=person, suffix=s)
                    for s in ("trc", "c3d", "csv")
                ]
    return found


def every_figure(study: Study) -> list[str]:
    """Return the figures of all takes."""
    return paths.formats(
        [
            _fill(paths.TAKE_FIGURE, session, take, way, figure=figure)
            for session, take in study.takes()
            for way in _ways(session)
            for figure in shown(session, take, session.parameters["take_figures"])
        ]
    )


def shown(session: Session, take: Take, figures: Iterable[str]) -> list[str]:
    """Return the figures of a take that show nobody who has not agreed to pictures."""
    refused = consent.refusing(session, take, "pictures")
    return [name for name in figures if not refused or name not in PICTURED]


def every_shake(study: Study) -> list[str]:
    """Return the figures of how cameras shook, of the takes in which that is taken out."""
    steady = [(session, take) for session, take in study.takes() if take.steady]
    stems = []
    for session, take in steady:
        choices = (session.take_calibrations(), session.parameters["models"], session.fusions())
        for calibration, model, fusion in product(*choices):
            way = {"calibration": calibration, "model": model, "fusion": fusion}
            stems.append(_fill(paths.TAKE_FIGURE, session, take, way, figure="shake"))
    return paths.formats(stems)


def every_kinematics(study: Study) -> list[str]:
    """Return the measures of all takes, those of other programs' skeletons included."""
    imported = {"calibration": "imported", "fusion": "trc"}
    return [
        _fill(paths.MEASURES, session, take, {**imported, "model": skeleton})
        for session, take in study.takes()
        for skeleton in take.pose3d
    ] + [
        _fill(paths.MEASURES, session, take, way)
        for session, take in study.takes()
        for way in _ways(session)
    ]


def every_comparison_of_views(study: Study) -> list[str]:
    """Return how far sets of cameras are from all of them, in real takes."""
    return [
        _fill(paths.VIEW_DISTANCES, session, take, way)
        for session, take in study.takes()
        if not session.virtual and session.fusions("compared_fusions")
        for way in _networks(session)
    ]


def evaluations(study: Study, kind: str) -> list[str]:
    """Return the tables of one kind of error of all takes of virtual sessions.

    Kinds: errors, kinematics, clocks (of cameras without a common clock), gains (of one fusion over
    another).
    """
    found = []
    for session, take in study.takes():
        if session.virtual:
            for way in _networks(session):
                found += _evaluations(study, session, take, way, kind)
    return found


def _evaluations(
    study: Study, session: Session, take: Take, way: dict[str, str], kind: str
) -> list[str]:
    kinds: dict[str, list[tuple[str, dict[str, str]]]] = {
        "errors": [(paths.ERRORS, {})],
        "kinematics": [(paths.MEASURE_ERRORS, {"fusion": name}) for name in session.fusions()],
        "clocks": [(paths.CLOCK_ERRORS, {})] if not take.synchronised else [],
        "gains": [
            (paths.GAINS, {"stage": stage})
            for stage in ("pose3d", study.stages(way["model"])[-1])
            if session.fusions("compared_fusions")
        ],
    }
    return [_fill(pattern, session, take, way, **more) for pattern, more in kinds[kind]]


def _ways(session: Session) -> Iterator[dict[str, str]]:
    """Yield every calibration, fusion and network that takes of a session are measured with."""
    for calibration, fusion, model in product(
        session.take_calibrations(), session.fusions(), session.parameters["models"]
    ):
        yield {"calibration": calibration, "fusion": fusion, "model": model}


def _networks(session: Session) -> Iterator[dict[str, str]]:
    """Yield every calibration and network that takes of a session are measured with."""
    for calibration, model in product(session.take_calibrations(), session.parameters["models"]):
        yield {"calibration": calibration, "model": model}


def _fill(pattern: str, session: Session, take: Take, way: dict[str, str], **more: str) -> str:
    return pattern.format(session=session.name, take=take.name, **way, **more)
