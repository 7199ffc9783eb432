"""Find out what the files of a folder are: videos, photos, clicks, calibrations, of devices."""

import math
import os
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from courtside.calibration import file_formats
from courtside.devices import depth_folder, frame_numbers, openpose
from courtside.drafting.recordings import Recording
from courtside.records.cameras import clicks
from courtside.study.errors import InputError, StrPath
from courtside.study.execution.files import PHOTOS
from courtside.video import images, walk_frames
from courtside.video import reader as video

Reader = Callable[[Path], dict[str, Any] | None]  # what keys of a `Recording` a path has, if any
VIDEOS = {".mp4", ".mov", ".m4v", ".avi", ".mkv", ".mts", ".m2ts", ".ts", ".mpg", ".mpeg"}
VIDEOS |= {".webm", ".wmv", ".3gp"}
BAGS = {".bag", ".db3"}
# A YAML file in a folder of recordings may be anything.
CALIBRATIONS = {".toml", ".txt", ".xml", ".xcp", ".mcal"}
CLICKED = {"camera", "x_px", "y_px"}
OTHER_TABLES = {  # by the key of a session that names them: columns beside those
    "board: corners": {"picture", "corner"},
    "wand: points": {"marker"},
}
TABLES = {  # by kind: columns
    "own_points": {*CLICKED, "x_m", "y_m", "z_m"},
    "court_points": set(clicks.COLUMNS),
    "racket": {"take", "camera", "frame_idx", "end"},
    "people": {*CLICKED, "take", "subject", "time_s"},
}
NAMED = {f"{kind}.csv": kind for kind in ("court_points", "people")}  # as the draft names them
LONGEST = 10_000  # characters of a header; a file of something else may have no line's end
DEPTH = (
    "16 bits and one channel, as pictures of depth: a depth camera's folder has cameras.toml, "
    "colour.mp4 and depth/ (config/README.md); write photos with 8 bits"
)
# Folders that cameras make on their cards; they say nothing.
OF_CARDS = re.compile(
    "DCIM|PRIVATE|M4ROOT|CLIP|[1-9][0-9]{2}(GOPRO|MEDIA|APPLE|CANON|MSDCF|NIKON|_PANA|_FUJI)"
)
EMPTY = "an empty folder; copy its recordings into it, or delete it"


def survey(folder: StrPath, *, root: StrPath) -> list[Recording]:
    """Describe every recording of a folder and of the folders in it, in name order.

    Links are followed. Files that are clearly no recordings are left out; unreadable ones come as
    `unusable` with the reason. Paths start from `root`, as those of sessions do; a folder elsewhere
    gives absolute paths. An `InputError` if there is no such folder.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(
            f"{folder}: expected a folder of recordings, found "
            f"{'a file' if folder.exists() else 'none'}; correct the path"
        )
    found = []
    for at, inner, names in os.walk(folder, followlinks=True):
        inner[:] = [
            name for name in _in_name_order(inner) if not _leads_back(Path(at, name), folder)
        ]
        if depth_folder.is_one(at):
            found.append(_described(Path(at), folder, root, _depth))
            inner[:] = []
            continue
        files = _in_name_order(names)
        for path, reader in _readers(Path(at), inner, files, below=Path(at) != folder):
            found.append(_described(path, folder, root, reader))
    return [recording for recording in found if recording]


def _leads_back(path: Path, folder: Path) -> bool:
    """Say whether a link leads to a folder in which it lies, whose recordings would come again."""
    if not path.is_symlink():
        return False
    above = [parent.resolve() for parent in path.parents if parent.is_relative_to(folder)]
    return any(one.is_relative_to(path.resolve()) for one in above)


def _in_name_order(names: Sequence[str]) -> list[str]:
    """Return the names in a folder but hidden ones, numbers by value: `clip 9` before `clip 10`."""
    shown = [name for name in names if not name.startswith(".")]
    return sorted(shown, key=lambda name: images.name_order(Path(name)))


def _readers(
    at: Path, inner: Sequence[str], names: Sequence[str], *, below: bool
) -> Iterator[tuple[Path, Reader]]:
    """Yield what there is to describe in a folder, itself or files, and by what.

    `inner` are the folders in it, `names` its files, and it lies `below` the folder that is looked
    through.
    """
    files = [at / name for name in names if (at / name).is_file()]  # reading a pipe would block
    yield from (
        (at / name, _lost)
        for name in names
        if (at / name).is_symlink() and not (at / name).exists()
    )
    photos = [path for path in files if READERS.get(path.suffix.lower()) is _photos]
    # Beside videos, photos in the folder itself are of its cameras.
    alone = not inner and not any(_reads_no_photo(path) for path in files)
    together = len(photos) > 1 and (below or alone)
    if together:
        yield at, _photos
    if below and not names and not inner:
        yield at, _empty
    if below and sum(path.suffix == ".json" for path in files) > 1:
        yield at, _keypoints
    for path in files:
        reader = READERS.get(path.suffix.lower())
        if path.name.startswith("alphapose") and path.suffix == ".json":
            reader = _points_of_all_frames
        if reader and not (together and path in photos):
            yield path, reader


def _reads_no_photo(path: Path) -> bool:
    return READERS.get(path.suffix.lower(), _photos) is not _photos


def _described(path: Path, folder: Path, root: StrPath, reader: Reader) -> Recording | None:
    """Return the `Recording` of a file; None if it is none."""
    inside = path.relative_to(folder)
    folders = [part for part in inside.parts[:-1] if not OF_CARDS.fullmatch(part)]
    parts = (*folders, inside.stem or path.resolve().name)
    keys: dict[str, Any] = {"path": written(path, root), "parts": parts}
    if any(not letter.isprintable() for letter in keys["path"]):
        return Recording(**keys, kind="unusable", note="a control character in its name; rename it")
    if {"{", "}"} & set(keys["path"]):
        return Recording(**keys, kind="unusable", note="braces in its path; rename it")
    try:
        more = reader(path)
    except InputError as error:
        return Recording(**keys, kind="unusable", note=str(error).removeprefix(f"{path}: "))
    return Recording(**keys, **more) if more else None


def written(path: Path, root: StrPath) -> str:
    """Return a path as a session names it: relative to `root` if below it, else absolute."""
    whole, start = path.absolute(), Path(root).absolute()
    return (whole.relative_to(start) if whole.is_relative_to(start) else whole).as_posix()


def _depth(_: Path) -> dict[str, Any]:
    return {"kind": "depth"}


def _lost(path: Path) -> dict[str, Any]:
    where = f"a link to {path.readlink()}, where nothing is"
    return {"kind": "unusable", "note": f"{where}; connect that disk, or copy the recording here"}


def _empty(_: Path) -> dict[str, Any]:
    return {"kind": "unusable", "note": EMPTY}


def _video(path: Path) -> dict[str, Any]:
    info = video.probe(path)
    note = "frames come at irregular times" if info.variable_rate else ""
    rate_hz = info.rate_hz if math.isfinite(info.rate_hz) else None
    length = {"rate_hz": rate_hz, "duration_s": info.duration_s, "n_frames": info.n_frames}
    return {"kind": "video", "size": info.size, **length, "note": note}


def _photos(path: Path) -> dict[str, Any]:
    """Describe a photo or a folder of photos by the first of them."""
    photos = walk_frames.photo_paths(path)
    first = images.read(photos[0], cv2.IMREAD_UNCHANGED, what=walk_frames.PHOTO)
    if first.dtype == np.uint16 and first.ndim == 2:
        return {"kind": "unusable", "note": DEPTH}
    height, width = walk_frames.read_photo(photos[0]).shape[:2]
    more = {"kind": "photos", "n_photos": len(photos)} if path.is_dir() else {"kind": "photo"}
    return {"size": (width, height), **more}


def _keypoints(path: Path) -> dict[str, Any] | None:
    """Describe a folder of 2D keypoints of another program; None if its files are others."""
    if not openpose.is_one(next(iter(sorted(path.glob("[!.]*.json"))))):
        return None
    skeletons, n_files = openpose.skeletons(path), len(frame_numbers.numbered(path))
    return {"kind": "keypoints", "n_frames": n_files, "skeleton": skeletons}


def _points_of_all_frames(path: Path) -> dict[str, Any] | None:
    """Describe AlphaPose's file of all frames; None of other JSON files."""
    if not frame_numbers.is_of_all_frames(path):
        return None
    return {"kind": "unusable", "note": frame_numbers.OF_ALPHAPOSE}


def _table(path: Path) -> dict[str, Any] | None:
    """Describe a table by its columns, or by the name that the draft gives it.

    Also one with other characters than commas between the cells, which is refused later.
    """
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as stream:
            first = stream.readline(LONGEST)
    except OSError:
        return None
    header = {cell.strip(' "\n') for cell in re.split("[,;\t]", first)}
    for kind, columns in TABLES.items():
        if header >= columns:
            return {"kind": kind}
    for key, columns in OTHER_TABLES.items():
        if header >= CLICKED | columns:
            note = f"by its columns the table of the key `{key}`; name it there in the session"
            return {"kind": "unusable", "note": note}
    if path.name in NAMED:
        return {"kind": NAMED[path.name]}
    if header >= CLICKED:
        expected = ",".join(clicks.COLUMNS)
        note = f"clicked points? expected the columns {expected}, found {','.join(sorted(header))}"
        return {"kind": "unusable", "note": note}
    return None


def _calibration(path: Path) -> dict[str, Any] | None:
    try:
        cameras = file_formats.read(path)
    except InputError:  # any other text file
        return None
    sizes = {camera.name: tuple(camera.size) for camera in cameras}
    return {"kind": "calibration", "cameras": sizes}


READERS: dict[str, Reader] = {  # by the ending of a file
    **dict.fromkeys(VIDEOS, _video),
    **dict.fromkeys((*PHOTOS, *walk_frames.UNREADABLE), _photos),
    **dict.fromkeys(CALIBRATIONS, _calibration),
    ".csv": _table,
    ".bvh": lambda path: {"kind": "bvh"},
    **dict.fromkeys(BAGS, lambda path: {"kind": "bag"}),
}
