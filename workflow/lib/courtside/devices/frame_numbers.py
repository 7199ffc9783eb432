"""Which frames the files of a folder are of, by the numbers in their names."""

import os
import re
from collections.abc import Collection, Mapping
from pathlib import Path

from courtside.study.errors import LONGEST, InputError, StrPath

# ASSUME: of fewer files, numbers without gaps may be those of frames by chance.
LEAST_FILES = 10
RENUMBER = "number the files by the frames of the video, from 0, or name the video of these files"
OF_ALPHAPOSE = (
    "a file of all frames; `AlphaPose_to_OpenPose` of Pose2Sim writes one of each frame from it: "
    "give it a folder of its own"
)
# ASSUME: in a take somebody is seen in more than one of so many frames.
SPARSEST = 20


def matched(
    folder: StrPath, numbers: Collection[int], n_frames: int, n_needed: int | None = None
) -> tuple[int, str]:
    """Return the number of a video's first frame, and a remark or "" on how files are matched.

    As many `numbers` as frames begin anywhere. One more: the last one is left out. Fewer are those
    of frames, counted from 0, as of programs that write no file where nobody is seen. An
    `InputError` where there are more, where numbers are beyond the video, or where they begin at 0
    or 1, have no gap and end more than one frame early, before the `n_needed` that are used: such
    files are of every second frame, or of another video.
    """
    first, last = min(numbers), max(numbers)
    span = last - first + 1
    if span == n_frames:
        return first, ""
    found = f"{folder}: {len(numbers)} files for {n_frames} frames"
    if span == n_frames + 1:
        return first, f"{found}; taken in their order, the last one, number {last}, is left out"
    if span > n_frames:
        raise InputError(
            f"{folder}: expected at most {n_frames} frames, as many as the video has, found "
            f"{len(numbers)} files numbered {first} to {last}; name the video that the files were "
            "made from"
        )
    short = last + 1 < min(n_frames - 1, n_frames if n_needed is None else n_needed)
    if first <= 1 and len(numbers) == span >= LEAST_FILES and short:
        every = round(n_frames / span)
        whole_share = every > 1 and abs(span * every - n_frames) < every
        as_of = f", as of every {_ordinal(every)} frame" if whole_share else ""
        raise InputError(
            f"{folder}: expected a file for each of {n_frames} frames of the video, found {span} "
            f"numbered {first} to {last}{as_of}; {RENUMBER}, or let `trim_s` end with them"
        )
    if last >= n_frames:
        raise InputError(
            f"{folder}: expected numbers of frames from 0 to {n_frames - 1} or a file for each, "
            f"found {len(numbers)} files numbered {first} to {last}; {RENUMBER}"
        )
    return 0, f"{found}; taken as frames {first} to {last}, counted from 0"


def common(folders: Mapping[str, StrPath]) -> range:
    """Return the numbers of the frames of a take without videos, from its `folders` by camera.

    They reach from the lowest to the highest number of all cameras. An `InputError` if those of
    different cameras cannot count the frames of one take.
    """
    numbers = {camera: numbered(folder) for camera, folder in folders.items()}
    found = range(min(map(min, numbers.values())), max(map(max, numbers.values())) + 1)
    if len(found) > SPARSEST * max(map(len, numbers.values())):
        each = ", ".join(f"{min(own)} to {max(own)} ({name})" for name, own in numbers.items())
        raise InputError(
            f"{', '.join(map(str, folders.values()))}: expected files numbered by the frames of "
            f"one take, found {each}; number them alike"
        )
    return found


def _ordinal(number: int) -> str:
    return {2: "second", 3: "third"}.get(number, f"{number}th")


def is_of_all_frames(path: StrPath) -> bool:
    """Tell whether a JSON file holds a list, as AlphaPose writes the points of all frames."""
    try:
        with Path(path).open(encoding="utf-8") as stream:
            return stream.read(LONGEST).lstrip().startswith("[")
    except (OSError, ValueError):
        return False


def numbered(folder: StrPath) -> dict[int, str]:
    """Return the names of the JSON files of a folder by the last number in them.

    An `InputError` if there are none, or a name has no number or that of another. An hour of one
    camera has hundreds of thousands: names are sorted in a tenth of the time of paths.
    """
    if not (folder := Path(folder)).is_dir():
        raise InputError(f"{folder}: expected a folder of JSON files, found none; correct the path")
    files: dict[int, str] = {}
    with os.scandir(folder) as every:
        names = sorted(one.name for one in every if one.name.endswith(".json"))
    for name in (name for name in names if name[0] != "."):
        digits = re.findall(r"[0-9]+", name.removesuffix(".json"))
        if not digits:
            found = "none; rename it"
            if is_of_all_frames(folder / name):
                found = OF_ALPHAPOSE
            raise InputError(
                f"{folder / name}: expected the frame's number in the name, found {found}"
            )
        number = int(digits[-1])
        if number in files:
            raise InputError(
                f"{folder / name}: expected one file for frame {number}, found {files[number]} as "
                "well; the last number in a name is the frame's: rename them, or keep the files of "
                "one camera in one folder"
            )
        files[number] = name
    if not files:
        raise InputError(
            f"{folder}: expected JSON files, found none; give the folder of one camera"
        )
    return files
