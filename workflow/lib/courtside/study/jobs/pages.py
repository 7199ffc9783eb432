"""Files and settings of viewers and of videos with skeletons."""

from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.jobs import devices, takes
from courtside.study.jobs.job import Job
from courtside.study.methods import STAGE_WORDS
from courtside.study.targets import takes as targets


def layers(job: Job) -> list[dict[str, Any]]:
    """Return the layers of a take's viewer: each stage of the fixed cameras, then each device."""
    found = _fused_layers(job) if viewed_cameras(job) else []
    for name, source in devices.sources(job).items() if job.take.devices else ():
        if name != "cameras":
            found.append(
                {
                    "file": source.file,
                    "name": name,
                    "of": source.skeleton,
                    "shown": not found,
                    "person": job.take.person_of_devices,
                    "source": name.removesuffix("-corrected"),
                    "placed": bool(found),
                }
            )
    known = list(dict.fromkeys(layer["of"] for layer in found))
    return [{**layer, "skeleton": known.index(layer["of"])} for layer in found]


def _fused_layers(job: Job) -> list[dict[str, Any]]:
    """Return the layers of the fixed cameras; only the last stage is shown at first."""
    stages = job.stages()
    return [
        {
            "file": devices.fused(job, stage),
            "name": STAGE_WORDS[stage],
            "of": job.model.skeleton,
            "shown": stage == stages[-1],
        }
        for stage in reversed(stages)
    ]


def skeleton_files(job: Job) -> list[Path]:
    """Return the skeletons of a viewer's layers, each once, in their order."""
    names = dict.fromkeys(layer["of"] for layer in layers(job))
    return [job.study.skeleton_yaml(name) for name in names]


def people_target(job: Job) -> str:
    """Return where the file with names is to be saved."""
    return job.session.people or job.fill(paths.PEOPLE_CSV)


def judged_takes(job: Job) -> list[dict[str, Any]]:
    """Return what a session's page for quality shows of each judged take.

    `pose2d` and `videos` are of each camera; none, with the reason in `left_out`, where pictures
    are not agreed to or there are no videos.
    """
    session, found = job.session, []
    for take in (one for one in session.takes.values() if targets.verdicts(session, one)):
        refused = consent.refusing(session, take, "pictures")
        why = f"No pictures: {', '.join(refused)} not agreed to pictures." if refused else ""
        why = why or ("" if take.videos else "No pictures: there are keypoints alone, no videos.")
        of_take = Job(job.study, {**job.wildcards, **_first(job), "take": take.name})
        videos = {} if why else take.videos
        entry = {"name": take.name, "quality": of_take.fill(paths.QUALITY), "left_out": why}
        entry |= {"people": of_take.fill(paths.PEOPLE)}
        entry |= {"skeleton": of_take.skeleton_file().as_posix()}
        pose2d = of_take.of_each(paths.POSE2D, camera=videos) if videos else []
        found.append({**entry, "pose2d": pose2d, "videos": list(videos.values())})
    return found


def known_takes(job: Job) -> list[str]:
    """Return the takes that a file with names may name."""
    return [*job.session.takes, *job.session.withheld]


def _first(job: Job) -> dict[str, str]:
    """Return the first ways to measure a session."""
    session = job.session
    return {
        "calibration": session.take_calibrations()[0],
        "model": session.parameters["models"][0],
    }


def first_way(job: Job, pattern: str) -> str:
    """Return a file of a take, by the first calibration and network."""
    return job.fill(pattern, **_first(job))


def first_keypoints(job: Job) -> list[str]:
    """Return the 2D keypoints of each camera by these."""
    return takes.keypoints_2d(Job(job.study, {**job.wildcards, **_first(job)}))


def viewed_cameras(job: Job) -> str | list:
    """Return the cameras that a viewer draws; none of a take whose views are not fused."""
    return first_way(job, paths.CAMERAS) if job.session.measures(job.take) else []


def viewed_court(job: Job) -> Path | list:
    """Return the court that a viewer draws, where the skeletons stand on one."""
    return job.court_file() if viewed_cameras(job) else []


def overlay(job: Job) -> dict[str, Any]:
    """Return how videos with skeletons are written."""
    step = job.study.parameters["export_overlay_video"]
    return {key: value for key, value in step.items() if key != "takes"}
