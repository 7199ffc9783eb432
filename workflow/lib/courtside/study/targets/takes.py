"""What the study makes of each take: checks, exports, figures, measures, errors."""

from collections.abc import Iterable
from itertools import product

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Session, Study, Take
from courtside.study.methods import IMPORTED

# Figures of takes of badminton: elsewhere, throws and headers look like strokes.
OF_STROKES = ("rally", "strokes")
ERRORS_OF_STROKES = (paths.STROKE_ERRORS, paths.REACTION_ERRORS)
# Figures that show persons in pictures.
PICTURED = ("overlay", "badminton_fig09", "badminton_fig10", "badminton_fig11")


def files(pattern: str, session: Session, take: Take, **chosen: str | Iterable[str]) -> list[str]:
    """Fill a pattern for a take with every method that it names, and with what is chosen."""
    methods = {
        "calibration": session.take_calibrations(),
        "fusion": session.fusions_of(take),
        "model": session.parameters["models"],
    }
    named = {name: found for name, found in methods.items() if f"{{{name}}}" in pattern}
    return paths.each(
        pattern,
        session=session.name,
        take=take.name,
        **{name: found for name, found in named.items() if name not in chosen},
        **chosen,
    )


def every_check(study: Study) -> list[str]:
    """Return the checks that cameras with a static recording stood still until each take."""
    return [path for session, take in study.takes() for path in checks(session, take)]


def checks(session: Session, take: Take) -> list[str]:
    """Return the checks of one take; none where shake is measured instead."""
    still = [] if take.steady else [c for c in take.videos if session.cameras[c].static]
    return files(paths.MOVEMENT, session, take, camera=still)


def every_export(study: Study) -> list[str]:
    """Return the files for other programs, of persons who agreed to them."""
    found = []
    for session, take in study.takes():
        refusing = consent.refusing(session, take, "export")
        persons = [name for name in take.subjects if name not in refusing]
        stages = session.parameters["export_stages"]
        ways, models = session.take_calibrations(), session.parameters["models"]
        methods = persons, ways, session.fusions_of(take), models
        for person, way, fusion, model in product(*methods):
            known = {"person": person, "calibration": way, "fusion": fusion, "model": model}
            there = [stage for stage in stages if stage in study.written_stages(model)]
            joints, trees = ("trc", "c3d", "csv"), ("bvh", "glb")
            measured = [stage for stage in there if stage != paths.MODELLED]
            every = joints + trees
            found += files(paths.EXPORT, session, take, **known, stage=measured, suffix=every)
            if paths.MODELLED in there:
                modelled = (*joints, "mot", "osim")
                found += files(paths.MODELLED_EXPORT, session, take, **known, suffix=modelled)
                found += files(paths.MOTION_EXPORT, session, take, **known, suffix=trees)
    return found


def every_verdict(study: Study) -> list[str]:
    """Return the tables of verdicts on all takes that fixed cameras measure."""
    return [path for session, take in study.takes() for path in verdicts(session, take)]


def verdicts(session: Session, take: Take) -> list[str]:
    """Return the table of verdicts on a take; none without calibration or cameras to fuse."""
    return files(paths.QUALITY, session, take) if session.measures(take) else []


def every_figure(study: Study) -> list[str]:
    """Return the figures of all takes."""
    stems = []
    for session, take in study.takes():
        names = allowed_figures(session, take, session.parameters["take_figures"])
        stems += files(paths.TAKE_FIGURE, session, take, figure=names)
    return paths.formats(stems)


def allowed_figures(session: Session, take: Take, figures: Iterable[str]) -> list[str]:
    """Return those figures that a take can have and consent to pictures allows.

    A take without videos has none with pictures, one that is not on a badminton court none of
    strokes.
    """
    figures = [name for name in figures if badminton(session) or name not in OF_STROKES]
    refused = consent.refusing(session, take, "pictures") or not take.videos
    return [name for name in figures if not refused or name not in PICTURED]


def every_shake(study: Study) -> list[str]:
    """Return the figures of camera shake, for the takes in which it is removed."""
    stems = []
    for session, take in study.takes():
        if take.steady:
            stems += files(paths.TAKE_FIGURE, session, take, figure="shake")
    return paths.formats(stems)


def every_kinematics(study: Study) -> list[str]:
    """Return the measures of all takes, those of other programs' skeletons included."""
    imported, own = [], []
    for session, take in study.takes():
        trc = {"calibration": IMPORTED, "fusion": "trc", "model": take.pose3d}
        imported += files(paths.MEASURES, session, take, **trc)
        own += files(paths.MEASURES, session, take)
        models = session.parameters["models"]
        fitted = [name for name in models if paths.MODELLED in study.written_stages(name)]
        own += files(paths.JOINT_ANGLES, session, take, model=fitted)
    return imported + own


def every_footwork(study: Study) -> list[str]:
    """Return the measures of the feet of all takes, and their errors where there is truth."""
    return [
        path
        for session, take in study.takes()
        for pattern in (paths.FOOTWORK_MEASURES, *([paths.CONTACT_ERRORS] * bool(session.virtual)))
        for path in files(pattern, session, take)
    ]


def badminton(session: Session) -> bool:
    """Return whether a session is on a badminton court, so that strokes are looked for."""
    return (session.court or "").startswith("badminton")


def every_stroke(study: Study) -> list[str]:
    """Return the strokes of all takes of badminton by the first network; errors of virtual ones."""
    return [
        path
        for session, take in study.takes()
        if badminton(session)
        for pattern in (paths.STROKES, *(ERRORS_OF_STROKES if session.virtual else ()))
        for path in files(pattern, session, take, model=session.parameters["models"][:1])
    ]


def every_comparison_of_views(study: Study) -> list[str]:
    """Return the comparisons of sets of cameras with all cameras, in real takes."""
    return [
        path
        for session, take in study.takes()
        if not session.virtual and session.fusions_of(take, "compared_fusions")
        for path in files(paths.VIEW_DISTANCES, session, take)
    ]


OF_A_TAKE = {  # kinds of errors: one table for each calibration and network
    "errors": paths.ERRORS,
    "angles": paths.ANGLE_ERRORS,
    "reliability": paths.RELIABILITY,
}


def evaluations(study: Study, kind: str) -> list[str]:
    """Return the tables of one kind of error of all takes of virtual sessions.

    Kinds: errors, angles, reliability (of stated errors), kinematics, clocks (of cameras without a
    common one), gains (between fusions).
    """
    found = []
    fused = [(s, take) for s, take in study.takes() if s.virtual and s.fusions_of(take)]
    for session, take in fused:
        if kind in OF_A_TAKE:
            found += files(OF_A_TAKE[kind], session, take)
        elif kind == "clocks" and not take.synchronised:
            found += files(paths.CLOCK_ERRORS, session, take)
        elif kind == "kinematics":
            found += files(paths.MEASURE_ERRORS, session, take)
        elif kind == "gains" and session.fusions_of(take, "compared_fusions"):
            for way, model in product(session.take_calibrations(), session.parameters["models"]):
                known = {"calibration": way, "model": model}
                stages = ("pose3d", study.stages(model)[-1])
                found += files(paths.GAINS, session, take, **known, stage=stages)
    return found
