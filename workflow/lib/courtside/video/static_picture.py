"""Static pictures of fixed cameras: temporal median, and checks of movement and light."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.study.errors import InputError, StrPath
from courtside.video.camera_movement import MIN_MATCHES, Movement, movement, unknown

BAND = 65536  # values of the median at a time: those of 25 pictures fit into the cache
TAKE = "its static picture and in its take"
AGAIN = "film the static picture and the walk again with the camera as in the take"
UNTOUCHED = "film it again without touching the camera"
KNOCKED = (
    "end the take before it with `trim_s`, or, unless it zoomed, state `steady: true` to measure "
    "the movement"
)
# ASSUME: a picture is too dark if this share of its pixels is below this level in all channels.
BLACK_LEVEL, BLACK_SHARE = 20, 0.8


def temporal_median(frames: Iterable[NDArray]) -> NDArray:
    """Return the median per pixel of pictures (H, W, 3) uint8 of a fixed camera; people disappear.

    A person must leave each place in more than half of the pictures. Of an even number, it is the
    mean of the two middle values, half a level rounded up. Raise ValueError if there is no picture,
    or they differ in size.
    """
    frames = list(frames)
    if not frames or len({frame.shape for frame in frames}) > 1:
        raise ValueError(f"expected pictures of one size, found {[f.shape for f in frames]}")
    middle = (len(frames) - 1) // 2, len(frames) // 2
    exchanges = _exchanges(len(frames), middle)
    every = [frame.ravel() for frame in frames]
    image = np.empty_like(every[0])
    for at in range(0, len(image), BAND):
        band = np.stack([frame[at : at + BAND] for frame in every])
        for low, high in exchanges:
            smaller = np.minimum(band[low], band[high])
            np.maximum(band[low], band[high], out=band[high])
            band[low] = smaller
        image[at : at + BAND] = (band[middle[0]].astype(np.uint16) + band[middle[1]] + 1) // 2
    return image.reshape(frames[0].shape)


def _exchanges(n: int, ranks: Iterable[int]) -> list[tuple[int, int]]:
    """Return the pairs (low, high) to put in order, in turn, so that n values have these ranks.

    Merge exchange sort [Batcher1968], without what the ranks do not need. The order of comparisons
    is fixed, so that numpy compares whole pictures: the median of 25 is found 16 times as fast as
    by `np.partition`.
    """
    pairs, size = [], 1
    while size < n:
        step = size
        while step:
            pairs += [
                (low, low + step)
                for start in range(step % size, n - step, 2 * step)
                for low in range(start, min(start + step, n - step))
                if low // (2 * size) == (low + step) // (2 * size)
            ]
            step //= 2
        size *= 2
    needed, used = set(ranks), []
    for pair in reversed(pairs):
        if needed.intersection(pair):
            needed.update(pair)
            used.append(pair)
    return used[::-1]


def check_still(
    camera: str,
    reference: NDArray,
    other: NDArray,
    *,
    max_shift_px: float,
    max_zoom_percent: float,
    where: str = TAKE,
    mend: str = AGAIN,
    must_be_known: bool = True,
) -> Movement:
    """Check that a fixed camera neither moved nor zoomed between two pictures.

    Pictures are (H, W, 3) uint8, BGR. `max_shift_px` limits the shift of the picture's centre, and
    that of the middle of its sides by rotation. `where` and `mend` tell in the message where the
    pictures are from and what to do. Raises `InputError` if the sizes differ, the camera moved, or
    too few background points agree to tell; with `must_be_known` False these say nothing.
    """
    start = f"camera {camera}: expected the same view in {where}"
    if reference.shape != other.shape:
        sizes = [f"{image.shape[1]}x{image.shape[0]}" for image in (reference, other)]
        raise InputError(
            f"{start}, found {sizes[0]} and {sizes[1]} pixels: film both with the same settings"
        )
    found = movement(reference, other)
    if not found.known:
        if not must_be_known:
            return found
        raise InputError(
            f"{start}, found only {found.n_matches} background points that agree (of {MIN_MATCHES} "
            "needed, spread over the picture): check that both are of this camera, in light, and "
            f"{mend}"
        )
    shift_px = float(np.hypot(*found.shift_px))
    zoom_percent = 100 * (found.zoom - 1)
    max_rotation_deg = np.degrees(max_shift_px / (reference.shape[1] / 2))
    within = (shift_px, abs(zoom_percent), abs(found.rotation_deg))
    if any(np.array(within) > (max_shift_px, max_zoom_percent, max_rotation_deg)):
        raise InputError(
            f"{start}, found it shifted by {shift_px:.1f} px, zoomed by {zoom_percent:+.2f} % and "
            f"turned by {found.rotation_deg:+.2f} deg (limits {max_shift_px:g} px, "
            f"{max_zoom_percent:g} %, {max_rotation_deg:.2g} deg): {mend}"
        )
    return found


def static_picture(
    camera: str, source: StrPath, images: Sequence[NDArray], **limits: float
) -> tuple[NDArray, Movement]:
    """Make the static picture of a fixed camera, after checking that it stood still meanwhile.

    Of images (H, W, 3) uint8, BGR, spread over a recording, in order, it is the temporal median.
    Also return the movement between the medians of the first and of the last third, which
    `check_still` checks within its `**limits`; it is unknown for fewer than three pictures, which
    are not checked. Raises `InputError` if the camera moved, that cannot be told, or the median is
    mostly black.
    """
    image = temporal_median(images)
    check_light(source, image)
    return image, _check_thirds(camera, source, images, mend=UNTOUCHED, **limits)


def check_kept_still(
    camera: str, source: StrPath, images: Sequence[NDArray], **limits: float
) -> None:
    """Check that a fixed camera did not move during a take, as `static_picture` does.

    The median of a whole take shows nothing of a knock in its later half. If people leave too
    little of the background in a third, nothing is checked.
    """
    _check_thirds(camera, source, images, mend=KNOCKED, must_be_known=False, **limits)


def _check_thirds(
    camera: str, source: StrPath, images: Sequence[NDArray], **options: Any
) -> Movement:
    """Check the first against the last third of a recording; unknown below three pictures."""
    third = len(images) // 3
    if not third:
        return unknown()
    ends = temporal_median(images[:third]), temporal_median(images[-third:])
    where = f"the first and the last third of {source}"
    return check_still(camera, *ends, where=where, **options)


def check_light(path: StrPath, image: NDArray) -> None:
    """Raise InputError if a picture (H, W, 3) uint8, BGR, from the file `path` is mostly black."""
    share = np.mean(image.max(axis=2) < BLACK_LEVEL)
    if share > BLACK_SHARE:
        raise InputError(
            f"{path}: expected a picture with light in it, found {100 * share:.0f} % of it black: "
            "take off the lens cap, light the room or expose longer, and film again"
        )
