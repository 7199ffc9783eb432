"""Frames of a walk, and of static recordings: from a video, or from photos in name order."""

import re
from pathlib import Path

import cv2
import numpy as np
import pandas as pd

from courtside.study.errors import InputError
from courtside.video import images, reader
from courtside.video.decoder import pictures
from courtside.video.packets import list_packets
from courtside.video.static_picture import check_light

PHOTOS = (".jpg", ".jpeg", ".png", ".tif", ".tiff", ".bmp", ".webp")
UNREADABLE = (".heic", ".heif", ".avif", ".dng", ".raw", ".cr2", ".cr3", ".nef", ".arw", ".orf")
PHOTO = "a photo"
SMALL_PX = 320  # width of the pictures that `courtside.sfm.usable.judge` compares


def frames(source, *, every_s=None, every_frame=None):
    """Decode the frames of a walk on a fixed grid, or all its photos.

    Parameters
    ----------
    source : str, Path or list of them
        A video; a photo, photos, or the folder of photos. Those come in name order, numbers by value, all
        of them.
    every_s : float or None
        Spacing of the grid in seconds, as for `reader.extract_frames`.
    every_frame : int or None
        Or else: every so many frames of the video, from the first.

    Yields
    ------
    frame_idx : int
        Of the video; of photos, the place in name order.
    time_s : float
        Since the video's first frame; NaN for photos.
    image : (H, W, 3) uint8
        BGR, upright, all of one size.

    Raises
    ------
    InputError
        If the source is missing, damaged, holds no picture or pictures of several sizes, or a photo is mostly
        black.
    ValueError
        If for a video not exactly one of `every_s` and `every_frame` is given, and positive.
    """
    paths = photo_paths(source)
    if paths:
        yield from ((at, np.nan, image) for at, image in enumerate(_photos(paths)))
    elif every_frame is None and every_s is not None:
        yield from reader.extract_frames(_single(source), every_s)
    elif every_s is None and isinstance(every_frame, int) and every_frame > 0:
        listing = list_packets(_single(source))
        for index, image in pictures(listing, range(0, len(listing.times_s), every_frame), None):
            yield index, float(listing.times_s[index]), image
    else:
        raise ValueError(f"one of every_s and every_frame, not {every_s} and {every_frame}")


def spread(source, n_frames):
    """Decode pictures spread evenly over a static recording, the first and the last among them.

    Parameters
    ----------
    source : str, Path or list of them
        As for `frames`.
    n_frames : int
        How many; fewer where it holds fewer.

    Returns
    -------
    images : list of (H, W, 3) uint8
        BGR, upright, of one size.

    Raises
    ------
    InputError
        As for `frames`.
    """
    paths = photo_paths(source)
    listing = None if paths else list_packets(_single(source))
    n_available = len(paths) if paths else len(listing.times_s)
    wanted = np.unique(np.linspace(0, n_available - 1, n_frames).round().astype(int)).tolist()
    if paths:
        return list(_photos([paths[at] for at in wanted]))
    return [image for _, image in pictures(listing, wanted, None)]


def extract(found, folder):
    """Write frames as PNG files `%06d.png`, the number being the frame's index, and describe them.

    Parameters
    ----------
    found : iterable of (frame_idx, time_s, image)
        From `frames`.
    folder : str or Path

    Returns
    -------
    table : DataFrame
        One row per frame: `frame_idx`, `time_s`, `name`, `sharpness`.
    small : list of (h, 320) uint8
        The same frames, grey, reduced by averaging (no larger than they were).
    """
    rows, small = [], []
    for frame_idx, time_s, image in found:
        name = f"{frame_idx:06d}.png"
        reader.write_png(Path(folder) / name, image)
        rows.append((frame_idx, time_s, name, reader.sharpness(image)))
        small.append(_small(image))
    return pd.DataFrame(rows, columns=["frame_idx", "time_s", "name", "sharpness"]), small


def photo_paths(source):
    """List the photos that a source is.

    Parameters
    ----------
    source : str, Path or list of them
        A folder, photos, or a video.

    Returns
    -------
    paths : list of Path
        In name order, numbers by value: photo 9 before photo 10. Empty for a video.

    Raises
    ------
    InputError
        If there is no photo, or a picture of a form that cannot be read.
    """
    single = _single(source)
    if single is None:
        paths = [Path(path) for path in source]
    elif single.is_dir():
        paths = [path for path in single.iterdir() if not path.name.startswith(".")]
    else:
        paths = [single]
    for path in sorted(paths):
        if path.suffix.lower() in UNREADABLE:
            raise InputError(
                f"{path}: expected photos as {' '.join(PHOTOS)}, found {path.suffix}: convert all to .jpg"
            )
    photos = sorted((p for p in paths if p.suffix.lower() in PHOTOS), key=_name_order)
    if not photos and (single is None or single.is_dir()):
        raise InputError(
            f"{single or 'list of photos'}: expected photos as {' '.join(PHOTOS)}, found none: put them there"
        )
    return photos


def read_photo(path):
    """Read a photo, upright as its EXIF orientation says.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    image : (H, W, 3) uint8
        BGR.

    Raises
    ------
    InputError
        If the file is missing, no picture, cut short, or mostly black.
    """
    path = Path(path)
    data = path.read_bytes() if path.is_file() else b""
    image = images.decode(path, data, what=PHOTO)
    if _cut_short(data):
        raise InputError(f"{path}: expected {PHOTO}, found one cut short; {images.AGAIN}")
    check_light(path, image)
    return image


def _photos(paths):
    size = None
    for path in paths:
        image = read_photo(path)
        found = f"{image.shape[1]}x{image.shape[0]}"
        if found != (size or found):
            raise InputError(
                f"{path}: expected {size} pixels as in {paths[0].name}, found {found}: take all photos with "
                "one camera, zoom and orientation, or leave this one out"
            )
        size = found
        yield image


def _single(source):
    """Return the only path of a source, None for several."""
    if isinstance(source, str | Path):
        return Path(source)
    return Path(source[0]) if len(source) == 1 else None


def _name_order(path):
    parts = re.split(r"(\d+)", path.stem)
    return [int(part) if at % 2 else part for at, part in enumerate(parts)], str(path)


def _cut_short(data):
    """Tell whether a JPEG lacks its end; OpenCV fills the rest with grey and says nothing."""
    if data[:2] != b"\xff\xd8":
        return False
    at = 2
    while data[at : at + 1] == b"\xff" and data[at + 1] != 0xDA:  # segments before the scan
        at += 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return data.find(b"\xff\xd9", at) < 0


def _small(image):
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    height, width = grey.shape
    if width <= SMALL_PX:
        return grey
    size = (SMALL_PX, round(height * SMALL_PX / width))
    return cv2.resize(grey, size, interpolation=cv2.INTER_AREA)
