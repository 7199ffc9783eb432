"""What the study makes to look around in: viewers, pages to click and name on, videos, plans."""

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Session, Study, Take
from courtside.study.targets import takes


def every_viewer(study: Study) -> list[str]:
    """Return the viewers of all takes."""
    return [path for session, take in study.takes() for path in viewers(session, take)]


def viewers(session: Session, take: Take) -> list[str]:
    """Return the viewer of a take, with the first network; none where there is no skeleton."""
    if not (take.devices or session.measures(take)):
        return []
    model = session.parameters["models"][0]
    return takes.files(paths.VIEWER, session, take, model=model)


def every_clicking_page(study: Study) -> list[str]:
    """Return the pages for clicking the court points of sessions that wait for them."""
    waiting = [session for session in study.sessions.values() if session.unclicked]
    return [paths.CLICKING_PAGE.format(session=session.name) for session in waiting]


def every_people_page(study: Study) -> list[str]:
    """Return the pages on which persons are named."""
    return [path for session, take in study.takes() for path in people_pages(session, take)]


def people_pages(session: Session, take: Take) -> list[str]:
    """Return the page on which the persons of a take are named; none without consent to pictures.

    A virtual take of one subject shows nobody else, and has none.
    """
    known = take.videos and session.measures(take) and session.parameters["models"]
    wanted = not session.virtual or len(take.subjects) > 1
    if not (known and wanted) or consent.refusing(session, take, "pictures"):
        return []
    return takes.files(paths.PEOPLE_PAGE, session, take)


def every_quality_page(study: Study) -> list[str]:
    """Return the pages with the verdicts on all takes of a session."""
    return [path for session in study.sessions.values() for path in quality_pages(session)]


def quality_pages(session: Session) -> list[str]:
    """Return the page with the verdicts of a session; none where no take is judged."""
    judged = any(takes.verdicts(session, take) for take in session.takes.values())
    return [paths.QUALITY_PAGE.format(session=session.name)] if judged else []


def every_overlay_video(study: Study) -> list[str]:
    """Return the videos with skeletons that the study asks for."""
    return [
        path for session, take in study.takes() for path in overlay_videos(study, session, take)
    ]


def overlay_videos(study: Study, session: Session, take: Take) -> list[str]:
    """Return the videos of a take, by first fusion and network; none without consent."""
    wanted = study.parameters["export_overlay_video"]["takes"]
    if f"{session.name}/{take.name}" not in wanted or consent.refusing(session, take, "pictures"):
        return []
    first = {"fusion": session.fusions_of(take)[:1], "model": session.parameters["models"][:1]}
    each = {"camera": take.videos, "calibration": session.take_calibrations()}
    return takes.files(paths.OVERLAY_VIDEO, session, take, **first, **each)


def every_plan(study: Study) -> list[str]:
    """Return the figures of all planned sessions."""
    plans = study.parameters["plans"]
    return paths.formats(paths.each(paths.PLAN_FIGURE, plan=plans, figure=("growth", "map")))
