"""Folders of 2D keypoints of another program: their frames, their points, whose they are."""

import math
from collections.abc import Callable, Iterator, Mapping
from itertools import combinations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from courtside.devices import frame_numbers, openpose
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.configuration.session_files import is_there
from courtside.study.configuration.sessions import Take
from courtside.study.errors import InputError
from courtside.video.glance import Glance


def check(
    take: Take, looks: Mapping[str, Glance], skeleton_file: Callable[[str], Path]
) -> tuple[list[str], list[str]]:
    """Return faults of the folders of a take, and remarks on how their files are matched.

    `looks` are those at its videos, by camera; `skeleton_file` returns the file of a skeleton.
    Folders that are not there are told elsewhere.
    """
    faults: list[str] = []
    remarks: list[str] = []
    for name, folders in take.pose2d.items():
        there = {camera: path for camera, path in folders.items() if is_there(Path(path))}
        faults += _point_faults(there, skeleton.read(skeleton_file(name)))
        try:
            if take.videos:
                remarks += _against_videos(take, there, looks)
            elif there:
                remarks += _against_each_other(there)
        except InputError as error:
            faults += error.lines
    return list(dict.fromkeys(faults)), remarks


def _point_faults(folders: Mapping[str, str], named: Skeleton) -> Iterator[str]:
    """Yield the folders with points of another skeleton, and those of the same points."""
    seen: dict[str, NDArray] = dict.fromkeys(folders, np.empty(0))
    for camera, folder in folders.items():
        try:
            seen[camera] = openpose.sample(folder, named)
        except InputError as error:
            yield from error.lines
    for one, other in combinations(folders, 2):
        same = len(seen[one]) and np.array_equal(seen[one], seen[other], equal_nan=True)
        if same or Path(folders[one]).resolve() == Path(folders[other]).resolve():
            yield (
                f"cameras {one} and {other}: expected two views, found the same points in "
                f"{folders[one]} and {folders[other]}; name each camera's own folder"
            )


def _against_videos(
    take: Take, folders: Mapping[str, str], looks: Mapping[str, Glance]
) -> list[str]:
    """Return remarks; an `InputError` has the faults of all cameras."""
    faults: list[str] = []
    remarks: list[str] = []
    for name, folder in folders.items():
        look = looks.get(name)
        try:
            numbers = frame_numbers.numbered(folder)
            if look and look.n_frames:
                needed = _n_needed(take, look)
                remarks.append(frame_numbers.matched(folder, numbers, look.n_frames, needed)[1])
        except InputError as error:
            faults += error.lines
    if faults:
        raise InputError(*faults)
    return list(filter(None, remarks))


def _n_needed(take: Take, look: Glance) -> int | None:
    """Return the number of frames before the end of the trimmed part, None where it has none."""
    if not take.trim_s or not look.rate_hz:
        return None
    return math.ceil(take.trim_s[1] * look.rate_hz - 1e-6)  # the rate is rounded


def _against_each_other(folders: Mapping[str, str]) -> Iterator[str]:
    """Yield a remark where cameras have files of different frames; `InputError` if of others."""
    shared = frame_numbers.common(folders)
    by_frames: dict[str, list[str]] = {}
    for name, folder in folders.items():
        numbers = frame_numbers.numbered(folder)
        found = f"{len(numbers)} files of frames {min(numbers)} to {max(numbers)}"
        by_frames.setdefault(found, []).append(name)
    if len(by_frames) > 1:
        each = ", ".join(f"{found} ({', '.join(names)})" for found, names in by_frames.items())
        yield (
            f"pose2d has {each}: taken as frames {shared[0]} to {shared[-1]} of every camera, "
            "nobody seen where there is no file; right if the same number is the same frame"
        )
