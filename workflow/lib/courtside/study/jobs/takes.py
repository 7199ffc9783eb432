"""Files and settings of takes: keypoints, skeletons, measures, exports."""

import time
from itertools import product
from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.errors import InputError
from courtside.study.execution import verdicts
from courtside.study.jobs.job import Job
from courtside.study.methods import PEOPLE, Fusion


def first_skeleton(job: Job) -> Path:
    """Return the skeleton of the first network of a session."""
    return job.study.skeleton_file(job.session.parameters["models"][0])


def each_camera(job: Job, pattern: str) -> list[str]:
    """Return a file of each camera of a take, in the take's order."""
    return job.of_each(pattern, camera=job.take.cameras)


def every_take(job: Job, pattern: str, **more: str) -> list[str]:
    """Return a file of every take of a session."""
    return job.of_each(pattern, take=job.session.takes, **more)


def clocks(job: Job, names: Any) -> dict[str, dict]:
    """Return the clocks that a take states, of the cameras or devices named."""
    return {name: clock for name, clock in job.take.clocks.items() if name in names}


def keypoints_2d(job: Job) -> list[str]:
    """Return the 2D keypoints of each camera of a take, steadied where shake is removed."""
    return each_camera(job, paths.POSE2D_STEADIED if _steadied(job) else paths.POSE2D)


def shake(job: Job) -> list[str]:
    """Return the shake to remove from the keypoints of the job's camera, or of all cameras."""
    if not _steadied(job):
        return []
    pattern = paths.SHAKE_TAKEN_OUT
    return [job.fill(pattern)] if "camera" in job.wildcards else each_camera(job, pattern)


def measured_shake(job: Job) -> str | list:
    """Return the shake of the job's camera where it is measured in the take's pictures."""
    return job.fill(paths.SHAKE) if job.take.steady else []


def knocks(job: Job) -> str | list:
    """Return the knocks that people show, of a calibration refined by them."""
    return job.fill(paths.KNOCKS) if job["calibration"].endswith(PEOPLE) else []


def _steadied(job: Job) -> bool:
    """Return whether shake is taken out; fusions that leave it in share clocks and people."""
    way, steady = job.wildcards.get("fusion"), job.take.steady or bool(knocks(job))
    return steady and (way is None or Fusion.parse(way).steadied)


def sightings(job: Job) -> list[tuple[str, dict[str, Any]]]:
    """Return where the session's file says that subjects are in a take: (subject, entry)."""
    return [
        (name, {key: value for key, value in entry.items() if key != "take"})
        for name in job.take.subjects
        for entry in job.session.subjects[name].seen
        if entry.get("take", job.take.name) == job.take.name
    ]


def people_csv(job: Job) -> str | list:
    """Return the file in which people are named, where it was saved."""
    stated = job.session.people
    return stated if stated and Path(stated).is_file() else []


def fusion(job: Job) -> dict[str, Any]:
    """Return which cameras of a take are fused, and by which rule."""
    session, take, name = job.session, job.take, job["fusion"]
    used = session.fused_cameras_of(take, name)
    if not used:
        seen = ", ".join(take.cameras) or "none"
        wanted = ", ".join(session.fused_cameras(name)) or "none"
        raise InputError(
            f"{session.file}: takes.{take.name}: expected enough cameras for the fusion {name} "
            f"(of {wanted}), found {seen}; ask for a fusion of cameras that see the take"
        )
    return {"used": list(used), "rule": Fusion.parse(name).rule}


def every_fused(job: Job, pattern: str = paths.POSE3D) -> list[str]:
    """Return a file of every way to fuse views."""
    return job.of_each(pattern, fusion=job.every_fusion())


def sexes(job: Job) -> dict[str, str | None]:
    """Return {person: sex} of a take, else of the session; None unless stated as m or f."""
    known = job.session.subjects
    people = job.take.subjects if "take" in job.wildcards else known
    return {name: known[name].sex if known[name].sex in ("m", "f") else None for name in people}


def recorded(job: Job) -> bool:
    """Say whether real people were recorded, not simulated."""
    return not job.session.virtual


def stated(job: Job, key: str) -> dict[str, Any]:
    """Return {person: what the session states under a key} of a take; None where it does not."""
    return {name: getattr(job.session.subjects[name], key) for name in job.take.subjects}


def known_of_network(job: Job, pattern: str) -> Path | list:
    """Return a file of `config/` on a network, where there is one of it."""
    path = job.study.folder / pattern.format(model=job["model"])
    return path if path.is_file() else []


def exported_motion(job: Job) -> str:
    """Return the skeletal motion that a person's file is made from, where that is agreed to."""
    job.demand("export")
    return job.fill(paths.SKELETAL_MOTION)


def exported(job: Job) -> str:
    """Return the skeletons that a file for other programs is made from, where that is agreed to."""
    job.demand("export")
    return job.fill(paths.SKELETONS, stage=job.wildcards.get("stage", "pose3d"))


def measured(job: Job) -> str:
    """Return the skeletons that are measured: those of the last stage."""
    return job.fill(paths.SKELETONS, stage=job.stages()[-1])


def measured_stage(job: Job) -> str:
    """Return in a word what these skeletons are: filtered or corrected."""
    return job.stages()[-1].removeprefix("pose3d_")


def judged(job: Job) -> list[dict[str, Any]]:
    """Return the files of each way in which a take is measured and exported, with its labels.

    And the stated heights of its persons, m.
    """
    session, found = job.session, []
    ways = session.take_calibrations(), session.fusions_of(job.take), session.parameters["models"]
    for way in product(*ways):
        labels = dict(zip(verdicts.WAY, way, strict=True))
        one = Job(job.study, {**job.wildcards, **labels})
        patterns = {
            "cameras": paths.CAMERAS,
            "quality": paths.CALIBRATION_QUALITY,
            "people": paths.PEOPLE,
            "sync": paths.CAMERA_CLOCKS,
            "pose3d": paths.POSE3D,
        }
        files: dict[str, Any] = {name: one.fill(pattern) for name, pattern in patterns.items()}
        files["pose2d"] = keypoints_2d(one)
        files["skeleton"] = one.skeleton_file().as_posix()
        of_file = labels["calibration"] == "file"
        by_lines = of_file and session.shows_court()
        files["check"] = one.fill(paths.CALIBRATION_CHECK, suffix="json") if of_file else ""
        files["court_check"] = one.fill(paths.COURT_CHECK, suffix="json") if by_lines else ""
        files["heights_m"] = stated(job, "height_m")
        found.append({"labels": labels, **files})
    return found


def failed_before(job: Job) -> float:
    """Return a different number in each run for a failed take, so that it is judged again."""
    return time.time() if verdicts.failed(job.fill(paths.QUALITY)) else 0.0


def blur_faces(job: Job) -> bool:
    """Return whether faces are blurred in pictures of a take, where pictures are agreed to."""
    job.demand("pictures")
    return job.session.blur_faces
