"""Still pictures of fixed cameras: their temporal median, whether the camera moved, and their light."""

import numpy as np

from courtside.study.errors import InputError
from courtside.video.camera_movement import MIN_MATCHES, movement, unknown

BAND_PX = 64  # rows of the median at a time: bounds the memory
TAKE = "its static picture and in its take"
AGAIN = "film the static picture and the walk again with the camera as in the take"
BLACK_LEVEL, BLACK_SHARE = 20, 0.8  # too dark: so much of the picture is darker than that


def temporal_median(frames):
    """Return the per-pixel median of pictures of one fixed camera: who walks about disappears.

    Parameters
    ----------
    frames : sequence of (H, W, 3) uint8, length T
        Spread over the recording; a person must leave each place in more than half of them.

    Returns
    -------
    image : (H, W, 3) uint8
        Of an even number, the mean of the two middle values, half a level rounded up.

    Raises
    ------
    ValueError
        If there is no picture, or they differ in size.
    """
    frames = list(frames)
    if not frames or len({frame.shape for frame in frames}) > 1:
        raise ValueError(f"expected pictures of one size, found {[f.shape for f in frames]}")
    low, high = (len(frames) - 1) // 2, len(frames) // 2
    image = np.empty_like(frames[0])
    for at in range(0, len(image), BAND_PX):
        band = np.stack([frame[at : at + BAND_PX] for frame in frames])
        band = np.partition(band, (low, high), axis=0)
        image[at : at + BAND_PX] = (band[low].astype(np.uint16) + band[high] + 1) // 2
    return image


def check_still(
    camera, reference, other, *, max_shift_px, max_zoom_percent, where=TAKE, mend=AGAIN
):
    """Check that a fixed camera neither moved nor zoomed between two pictures.

    Parameters
    ----------
    camera : str
        Its name, for the message.
    reference, other : (H, W, 3) uint8
        Its static picture, and a picture of later, BGR.
    max_shift_px : float
        Largest shift of the picture's centre; also of the middle of its sides by a turn, pixels.
    max_zoom_percent : float
        Largest change of scale.
    where, mend : str
        What the pictures are from, and what to do, for the message.

    Returns
    -------
    movement : Movement
        What was measured, within the limits.

    Raises
    ------
    InputError
        If the sizes differ, the camera moved, or too few background points agree to tell.
    """
    start = f"camera {camera}: expected the same view in {where}"
    if reference.shape != other.shape:
        sizes = [f"{image.shape[1]}x{image.shape[0]}" for image in (reference, other)]
        raise InputError(
            f"{start}, found {sizes[0]} and {sizes[1]} pixels: film both with the same settings"
        )
    found = movement(reference, other)
    if not found.known:
        raise InputError(
            f"{start}, found only {found.n_matches} background points that agree (of {MIN_MATCHES} needed, "
            f"spread over the picture): check that both are of this camera, in light, and {mend}"
        )
    shift_px = float(np.hypot(*found.shift_px))
    zoom_percent = 100 * (found.zoom - 1)
    max_rotation_deg = np.degrees(max_shift_px / (reference.shape[1] / 2))
    within = (shift_px, abs(zoom_percent), abs(found.rotation_deg))
    if any(np.array(within) > (max_shift_px, max_zoom_percent, max_rotation_deg)):
        raise InputError(
            f"{start}, found it shifted by {shift_px:.1f} px, zoomed by {zoom_percent:+.2f} % and turned by "
            f"{found.rotation_deg:+.2f} deg (limits {max_shift_px:g} px, {max_zoom_percent:g} %, "
            f"{max_rotation_deg:.2g} deg): {mend}"
        )
    return found


def static_picture(camera, source, images, *, max_shift_px, max_zoom_percent):
    """Make the static picture of a fixed camera, after checking that it stood still meanwhile.

    Parameters
    ----------
    camera : str
        Its name, for messages.
    source : str or Path
        The recording, for messages.
    images : list of (H, W, 3) uint8
        Spread over the recording, in order, BGR.
    max_shift_px, max_zoom_percent : float
        As for `check_still`, between the medians of the first and of the last third.

    Returns
    -------
    image : (H, W, 3) uint8
        The temporal median.
    movement : Movement
        From the first to the last third; unknown for fewer than three pictures, which are not checked.

    Raises
    ------
    InputError
        If the camera moved, that cannot be told, or the median is mostly black.
    """
    image, third, found = temporal_median(images), len(images) // 3, unknown()
    check_light(source, image)
    if third:
        found = check_still(
            camera,
            temporal_median(images[:third]),
            temporal_median(images[-third:]),
            max_shift_px=max_shift_px,
            max_zoom_percent=max_zoom_percent,
            where=f"the first and the last third of {source}",
            mend="film it again without touching the camera",
        )
    return image, found


def too_dark(image):
    """Tell whether a picture is mostly black.

    Parameters
    ----------
    image : (H, W, 3) uint8
        BGR.

    Returns
    -------
    dark : bool
        Whether 80 % of its pixels are below 20 of 255 in every channel.
    """
    return bool(np.mean(image.max(axis=2) < BLACK_LEVEL) > BLACK_SHARE)


def check_light(path, image):
    """Check that a picture is not mostly black.

    Parameters
    ----------
    path : str or Path
        Its file, for the message.
    image : (H, W, 3) uint8
        BGR.

    Raises
    ------
    InputError
        If it is.
    """
    if too_dark(image):
        share = np.mean(image.max(axis=2) < BLACK_LEVEL)
        raise InputError(
            f"{path}: expected a picture with light in it, found {100 * share:.0f} % of it black: "
            "take off the lens cap, light the room or expose longer, and film again"
        )
