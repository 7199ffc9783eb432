"""Read colour and depth from a folder of plain files, for cameras of any maker.

The folder holds
- `cameras.toml`: two cameras named `colour` and `depth` in the study's form (`name size matrix
  distortions rotation translation`; see `geometry.camera.read_toml`), both placed in one frame of
  axes. Its `[metadata]` may hold `unit` (of the translations: m, cm or mm; m where absent),
  `depth_unit_m` (metres of one step of depth; 0.001 where absent) and `baseline_m` (between the
  imagers that depth comes from);
- `colour.mp4` (or .mkv .mov .avi): the colour video;
- `depth/`: one 16-bit PNG of one channel per frame, taken in the order of their names, numbers by
  value; 0 is a hole;
- where a frame was lost or the clocks differ, `colour.csv` and `depth.csv` with the columns
  `number` (as the camera counted) and `time_s` (on one clock), one row per frame. Without them
  frame k of both is taken at the time the video says, and both must hold equally many.

    [colour]
    name = "colour"
    size = [1280, 720]
    matrix = [[924.0, 0.0, 639.5], [0.0, 924.0, 359.5], [0.0, 0.0, 1.0]]
    distortions = [0.0, 0.0, 0.0, 0.0, 0.0]
    rotation = [0.0, 0.0, 0.0]
    translation = [0.015, 0.0, 0.0]

    [depth]
    ...
    [metadata]
    unit = "m"
    depth_unit_m = 0.001
"""

import itertools
import re
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.devices import plausible
from courtside.devices.depth_recording import DEFAULT_UNIT_M, STANDING_STILL, DepthRecording
from courtside.geometry import camera as camera_models
from courtside.geometry import camera_fields, rotations
from courtside.records.cameras.frame_times import FrameTimes
from courtside.study.errors import RAISED_BY_READERS, InputError, StrPath, reading
from courtside.video import images, reader

VIDEOS = (".mp4", ".mkv", ".mov", ".avi")
EXPORT = "export depth again, without conversion"


def read(path: StrPath, name: str = "rgbd") -> DepthRecording:
    """Read such a folder; `name` is the device's in the study.

    An `InputError` if a file is missing or not as described above. A damaged picture is found only
    when read.
    """
    folder = Path(path)
    toml = folder / "cameras.toml"
    if not toml.is_file():
        raise InputError(
            f"{folder}: expected cameras.toml with the cameras colour and depth, found no such "
            "file; add it"
        )
    found = {camera.name: camera for camera in camera_models.read_toml(toml)}
    if set(found) != {"colour", "depth"}:
        raise InputError(
            f"{toml}: expected cameras named colour and depth, found {sorted(found)}; rename them"
        )
    depth_unit_m, baseline_m, remarks = _metadata(toml)
    film, pictures = _film(folder), _pictures(folder / "depth")
    colour_index, depth_index = _indices(folder, film, len(pictures))
    colour, depth = found["colour"], found["depth"]
    camera_models.check_size(colour, reader.probe(film).size, film)
    back = rotations.invert(depth.cam_from_world)
    turn, shift = colour.cam_from_world[:, :3], colour.cam_from_world[:, 3]
    try:
        return DepthRecording(
            name=name,
            colour=replace(colour, name=f"{name}-colour", cam_from_world=STANDING_STILL),
            depth=replace(depth, name=f"{name}-depth", cam_from_world=STANDING_STILL),
            colour_from_depth=np.column_stack([turn @ back[:, :3], turn @ back[:, 3] + shift]),
            depth_unit_m=depth_unit_m,
            colour_frames=lambda: _colour(film, colour_index.time_s),
            depth_frames=lambda: _depth(pictures, depth_index.time_s, depth.size),
            colour_index=lambda: colour_index,
            baseline_m=baseline_m,
            remarks=remarks,
        )
    except ValueError as error:
        raise InputError(f"{toml}: {error}; correct it, or the units in [metadata]") from error


def _metadata(toml: Path) -> tuple[float, float, tuple[str, ...]]:
    metadata = tomllib.loads(toml.read_text(encoding="utf-8-sig")).get("metadata", {})
    if not isinstance(metadata, dict):
        raise InputError(
            f"{toml}: expected a table [metadata], found {camera_fields.short(metadata)}"
        )
    where = f"{toml}: [metadata]"
    remarks: tuple[str, ...] = ()
    if "depth_unit_m" not in metadata:
        remarks = (f"no depth_unit_m in {toml}: {DEFAULT_UNIT_M} m assumed",)
    unit = metadata.get("depth_unit_m", DEFAULT_UNIT_M)
    depth_unit_m = float(camera_fields.numbers(where, "depth_unit_m", unit, ()))
    baseline = metadata.get("baseline_m")
    baseline_m = (
        np.nan if baseline is None else camera_fields.numbers(where, "baseline_m", baseline, ())
    )
    return depth_unit_m, float(baseline_m), remarks


def is_one(path: StrPath) -> bool:
    """Return whether a folder is meant as such, by the names in it; it need not be complete.

    It has cameras named colour and depth, or a colour video beside a folder of depth pictures.
    """
    folder = Path(path)
    if _films(folder) and (folder / "depth").is_dir():
        return True
    try:
        found = tomllib.loads((folder / "cameras.toml").read_text(encoding="utf-8-sig"))
    except RAISED_BY_READERS:
        return False
    tables = [(key, table) for key, table in found.items() if isinstance(table, dict)]
    return {"colour", "depth"} <= {str(table.get("name", key)) for key, table in tables}


def _films(folder: Path) -> list[Path]:
    return [path for path in sorted(folder.glob("colour.*")) if path.suffix.lower() in VIDEOS]


def _film(folder: Path) -> Path:
    found = _films(folder)
    if len(found) != 1:
        names = [path.name for path in found]
        raise InputError(
            f"{folder}: expected one video colour{'|'.join(VIDEOS)}, found {names}; add or remove"
        )
    return found[0]


def _pictures(folder: Path) -> list[Path]:
    found = sorted(folder.glob("[!.]*.png"), key=images.name_order)
    if not found:
        raise InputError(f"{folder}: expected 16-bit PNG pictures of depth, found none; add them")
    _check_order(found)
    return found


def _check_order(found: Sequence[Path]) -> None:
    """Refuse names that may be times without zeros at the end, if these have another order.

    Of times, 7.5 is after 7.033; of nanoseconds after the point, and of takes, it is before.
    """
    ends = [end for path in found if (end := re.search(r"(\d+)(?:\.(\d+))?$", path.stem))]
    digits = {len(end[2] or "") for end in ends}
    if len(ends) < len(found) or len(digits) == 1 or len({end[1] for end in ends}) == 1:
        return
    times = [float(end[0]) for end in ends]
    for (path, time_s), (later, later_s) in itertools.pairwise(zip(found, times, strict=True)):
        if time_s > later_s:
            raise InputError(
                f"{path.parent}: expected names whose order is clear, found {path.name} and "
                f"{later.name}; number the pictures in order of time"
            )


def _indices(folder: Path, film: Path, n_depth: int) -> tuple[FrameTimes, FrameTimes]:
    """Return the frame times of colour and of depth."""
    times_s = reader.frame_times(film)
    tables = [folder / "colour.csv", folder / "depth.csv"]
    given = [path.is_file() for path in tables]
    if all(given):
        return _table(tables[0], len(times_s)), _table(tables[1], n_depth)
    if any(given):
        raise InputError(f"{folder}: expected colour.csv and depth.csv, found one; add the other")
    if len(times_s) != n_depth:
        raise InputError(
            f"{folder}: expected as many depth pictures as colour frames, {len(times_s)}, found "
            f"{n_depth}; add colour.csv and depth.csv that say when each was taken"
        )
    index = FrameTimes(times_s, np.arange(n_depth))
    return index, index


def _table(path: Path, n_frames: int) -> FrameTimes:
    with reading(path, "columns number (whole) and time_s", "correct them"):
        rows = pd.read_csv(path)
        times_s = rows["time_s"].to_numpy(dtype=float)
        numbers = rows["number"].to_numpy(dtype=np.int64)
    rising = np.isfinite(times_s).all() and (np.diff(times_s) > 0).all()
    if len(rows) != n_frames or not rising or not (np.diff(numbers) > 0).all():
        raise InputError(
            f"{path}: expected {n_frames} rows with rising number and time_s, one for each frame, "
            f"found {len(rows)} rows or others; correct them"
        )
    plausible.check_rate(path, times_s, "write time_s in seconds")
    return FrameTimes(times_s, numbers)


def _colour(film: Path, times_s: NDArray) -> Iterator[tuple[float, NDArray]]:
    for time_s, (_, image) in zip(times_s.tolist(), reader.frames(film), strict=True):
        yield time_s, image


def _depth(
    pictures: Sequence[Path], times_s: NDArray, size: tuple[int, int]
) -> Iterator[tuple[float, NDArray]]:
    for path, time_s in zip(pictures, times_s.tolist(), strict=True):
        what = "a 16-bit picture of one channel"
        image = images.read(path, cv2.IMREAD_UNCHANGED, what=what, advice=EXPORT)
        if image.dtype != np.uint16 or image.ndim != 2:
            n_channels = 1 if image.ndim == 2 else image.shape[2]
            raise InputError(
                f"{path}: expected {what}, found {image.dtype}, channels: {n_channels}; {EXPORT}"
            )
        if image.shape != size[::-1]:
            raise InputError(
                f"{path}: expected {camera_fields.times(size)} px, the `size` of the camera depth "
                f"in cameras.toml, found {camera_fields.times(image.shape[::-1])}; correct the "
                "size there, or export depth again as the camera recorded it"
            )
        yield time_s, image
