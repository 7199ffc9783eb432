"""What the study makes to look around in: viewers, clicking pages, videos with skeletons, plans."""

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Session, Study, Take


def every_viewer(study: Study) -> list[str]:
    """Return the viewers of all takes."""
    return [path for session, take in study.takes() for path in viewers(session, take)]


def viewers(session: Session, take: Take) -> list[str]:
    """Return the viewer of a take, with the first network; none where there is no skeleton."""
    if not (take.devices or (take.videos and session.take_calibrations())):
        return []
    model = session.parameters["models"][0]
    return [paths.VIEWER.format(session=session.name, take=take.name, model=model)]


def every_clicking_page(study: Study) -> list[str]:
    """Return the pages for clicking the court points of sessions that wait for them."""
    waiting = [session for session in study.sessions.values() if session.unclicked]
    return [paths.CLICKING_PAGE.format(session=session.name) for session in waiting]


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
    known = {"session": session.name, "take": take.name, "model": session.parameters["models"][0]}
    return [
        paths.OVERLAY_VIDEO.format(
            **known, fusion=session.fusions()[0], calibration=way, camera=camera
        )
        for camera in take.videos
        for way in session.take_calibrations()
    ]


def every_plan(study: Study) -> list[str]:
    """Return the figures of all planned sessions."""
    return paths.formats(
        [
            paths.PLAN_FIGURE.format(plan=plan, figure=figure)
            for plan in study.parameters["plans"]
            for figure in ("growth", "map")
        ]
    )
