"""Frames of walks and static recordings: from a video, or from photos in name order."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.study.errors import InputError, StrPath
from courtside.study.execution.files import PHOTOS
from courtside.video import images, reader
from courtside.video.decoder import pictures
from courtside.video.packets import list_packets
from courtside.video.static_picture import check_light

UNREADABLE = (".heic", ".heif", ".avif", ".dng", ".raw", ".cr2", ".cr3", ".nef", ".arw", ".orf")
PHOTO = "a photo"  # for messages
SMALL_PX = 320  # width of the pictures that `courtside.sfm.usable.judge` compares

Source = StrPath | Sequence[StrPath]


def frames(
    source: Source, *, every_s: float | None = None, every_frame: int | None = None
) -> Iterator[tuple[int, float, NDArray]]:
    """Decode the frames of a walk on a fixed grid, or all its photos: index, time and picture.

    The source is a video, or photos or a folder of these: all are used, in name order, numbers by
    value, without a time (NaN). For a video give one of `every_s` and `every_frame`, positive
    (ValueError if not): the spacing of the grid in seconds, as for `reader.extract_frames`, or in
    frames, from the first. Pictures are (H, W, 3) uint8, BGR, upright, all of one size. Raises
    `InputError` if the source is missing, damaged, holds no picture or pictures of several sizes,
    or a photo is mostly black.
    """
    paths = photo_paths(source)
    if paths:
        yield from ((at, np.nan, image) for at, image in enumerate(_photos(paths)))
    elif every_frame is None and every_s is not None:
        yield from reader.extract_frames(_paths(source)[0], every_s)
    elif every_s is None and isinstance(every_frame, int) and every_frame > 0:
        listing = list_packets(_paths(source)[0])
        for index, image in pictures(listing, range(0, len(listing.times_s), every_frame)):
            yield index, float(listing.times_s[index]), image
    else:
        raise ValueError(f"one of every_s and every_frame, not {every_s} and {every_frame}")


def spread(
    source: Source, n_frames: int, *, trim_s: Sequence[float] | None = None
) -> list[NDArray]:
    """Decode at most `n_frames` pictures spread evenly over a recording, with both ends.

    Of a video with `trim_s` (start, stop), only frames from the start to before the stop count.
    They are (H, W, 3) uint8, BGR, upright, of one size. Source and errors are those of `frames`.
    """
    paths = photo_paths(source)
    if paths:
        return list(_photos([paths[at] for at in _evenly(range(len(paths)), n_frames)]))
    start_s, stop_s = trim_s or (None, None)
    listing = list_packets(_paths(source)[0], stop_s=stop_s)
    chosen = _evenly(reader.in_range(listing, start_s, stop_s), n_frames)
    return [image for _, image in pictures(listing, chosen)]


def _evenly(there: range, n_wanted: int) -> list[int]:
    return np.unique(np.linspace(there[0], there[-1], n_wanted).round().astype(int)).tolist()


def extract(
    found: Iterable[tuple[int, float, NDArray]], folder: StrPath, photos: Sequence[Path] = ()
) -> tuple[pd.DataFrame, list[NDArray]]:
    """Write frames, from `frames`, as PNG files named `%06d.png` by the frame's index.

    Return a table with one row per frame (`frame_idx`, `time_s`, `name`, `sharpness`, `photo`) and
    the same frames, grey, reduced by averaging to a width of 320 px (not enlarged). `photos` are
    those of `photo_paths`, whose own names the table gives.
    """
    rows, small = [], []
    for frame_idx, time_s, image in found:
        name = f"{frame_idx:06d}.png"
        reader.write_png(Path(folder) / name, image)
        own = photos[frame_idx].name if photos else ""
        rows.append((frame_idx, time_s, name, reader.sharpness(image), own))
        small.append(_small(image))
    columns = ["frame_idx", "time_s", "name", "sharpness", "photo"]
    return pd.DataFrame(rows, columns=columns), small


def photo_paths(source: Source) -> list[Path]:
    """List the photos of a source in name order, numbers by value: photo 9 before photo 10.

    The list is empty for a video. Raise InputError if there is no photo, or one of a format that
    cannot be read.
    """
    paths = _paths(source)
    single = paths[0] if len(paths) == 1 else None
    if single is not None and single.is_dir():
        paths = [path for path in single.iterdir() if not path.name.startswith(".")]
    for path in sorted(paths):
        if path.suffix.lower() in UNREADABLE:
            raise InputError(
                f"{path}: expected photos as {' '.join(PHOTOS)}, found {path.suffix}: "
                "convert all to .jpg"
            )
    photos = sorted((p for p in paths if p.suffix.lower() in PHOTOS), key=images.name_order)
    if not photos and (single is None or single.is_dir()):
        raise InputError(
            f"{single or 'list of photos'}: expected photos as {' '.join(PHOTOS)}, found none: "
            "put them there"
        )
    return photos


def read_photo(path: StrPath) -> NDArray:
    """Read a photo (H, W, 3) uint8, BGR, upright by its EXIF orientation.

    Raise InputError if the file is missing, no picture, cut short, or mostly black.
    """
    path = Path(path)
    data = path.read_bytes() if path.is_file() else b""
    image = images.decode(path, data, what=PHOTO)
    if _cut_short(data):
        raise InputError(f"{path}: expected {PHOTO}, found one cut short; {images.AGAIN}")
    check_light(path, image)
    return image


def _photos(paths: Sequence[Path]) -> Iterator[NDArray]:
    size = None
    for path in paths:
        image = read_photo(path)
        found = f"{image.shape[1]}x{image.shape[0]}"
        if found != (size or found):
            raise InputError(
                f"{path}: expected {size} pixels as in {paths[0].name}, found {found}: take all "
                "photos with one camera, zoom and orientation, or leave this one out"
            )
        size = found
        yield image


def _paths(source: Source) -> list[Path]:
    return [Path(p) for p in ([source] if isinstance(source, StrPath) else source)]


def _cut_short(data: bytes) -> bool:
    """Return whether a JPEG lacks its end; OpenCV fills the rest with grey and reports nothing."""
    if data[:2] != b"\xff\xd8":
        return False
    at = 2
    while data[at : at + 1] == b"\xff" and data[at + 1] != 0xDA:  # segments before the scan
        at += 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return data.find(b"\xff\xd9", at) < 0


def _small(image: NDArray) -> NDArray:
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    height, width = grey.shape
    if width <= SMALL_PX:
        return grey
    size = (SMALL_PX, round(height * SMALL_PX / width))
    return cv2.resize(grey, size, interpolation=cv2.INTER_AREA)
