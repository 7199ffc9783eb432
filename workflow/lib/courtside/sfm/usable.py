"""Which frames of a walk's grid are usable for structure from motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    import pandas as pd

BLOCKS = (9, 16)  # ASSUME: rows and columns of blocks in which two pictures are compared
# ASSUME: percentiles: blocks with less texture than the first show the noise, with more than the
# second the motion.
FLAT, RICH = 25, 50
BLACK_LEVEL, BLACK_SHARE = 20, 0.8  # ASSUME: dark: so much of the picture is below that level
WINDOW = 15  # ASSUME: frames, the judged one in the middle; fewer at the ends
MIN_SHARE = 0.6  # ASSUME: of the median sharpness in the window
# ASSUME: of photos, whose sharpness is compared with the coarse detail that each shows: of 72 parts
# of sharp pictures none had less than 0.33, blurred by 2 px none more than 0.15.
MIN_PHOTO_SHARE = 0.25
# Of a picture's longer side, from the last kept frame: 0.6 px of 1280 is about the noise of a
# feature's place.
STILL_SHARE = 5e-4
# ASSUME: squared grey levels per pixel; with less in most blocks motion cannot be measured.
MIN_TEXTURE = 1.0
# ASSUME: correlation of two pictures in most blocks: real pictures of one view have 0.99 and more,
# of different views in one hall less than 0.3.
SAME = 0.5


def judge(
    table: pd.DataFrame, images: Sequence[NDArray], *, photos: bool = False
) -> tuple[NDArray, NDArray]:
    """Judge which frames of a walk's grid are usable for structure from motion.

    Raises `ValueError` if table and images differ in number, or the images in size.

    A frame is dark where 80 % of it is below 20 of 255. It is blurred where its sharpness is below
    a share of the median in a window around it. A stretch of blur longer than half the window
    becomes its own measure and is kept: those frames are all there is of that part of the walk.
    Neighbouring photos may show different things, such as a bare wall: the sharpness of photos is
    first divided by their coarse detail, which blur leaves. Of a walker who stands still the first
    frame is kept; the others are duplicates.

    Parameters
    ----------
    table : one row per frame of the grid, in order: `frame_idx`, `time_s`, `sharpness` (variance of
        the Laplacian), `name`
    images : (h, w) uint8, length G; the same frames, grey, reduced by averaging to one small size,
        about 320 pixels wide
    photos : whether they are photos, not frames of a video

    Returns
    -------
    kept : (G,) bool; whether the frame may become a bridging image
    why : (G,) str; "dark", "blurred", "duplicate", or "" for a kept frame
    """
    sharpness = table["sharpness"].to_numpy(float)
    shapes = {np.shape(image) for image in images}
    if len(sharpness) != len(images) or len(shapes) > 1:
        raise ValueError(f"{len(sharpness)} rows, {len(images)} images, shapes {shapes}")
    share = MIN_SHARE
    if photos:
        share, sharpness = MIN_PHOTO_SHARE, sharpness / [_detail(image) for image in images]
    compared = table.assign(sharpness=sharpness)["sharpness"]
    medians = compared.rolling(WINDOW, center=True, min_periods=1).median().to_numpy()
    why = np.where(sharpness < share * medians, "blurred", "").astype("<U9")
    why[[np.mean(np.asarray(image) < BLACK_LEVEL) > BLACK_SHARE for image in images]] = "dark"
    last = None
    for at in np.flatnonzero(why == "").tolist():
        limit_px = STILL_SHARE * max(images[at].shape)
        if last is not None and motion_px(images[last], images[at]) < limit_px:
            why[at] = "duplicate"
        else:
            last = at
    return why == "", why


def motion_px(image: ArrayLike, other: ArrayLike) -> float:
    """Estimate how far the content of two grey pictures (h, w) moved, for motions near the noise.

    Raises `ValueError` if they are not two grey pictures of one size, at least 16 by 9.

    The result is a typical displacement, in pixels of these pictures. It is up to 1.4 times too
    large in sharp ones, and too small but not small beyond a few pixels. It is infinite where they
    show too little texture to tell, or different views.

    A small displacement d changes a pixel by d times the gradient there; noise adds the same
    everywhere. So in each block the mean squared difference is (squared noise) + (squared d)(mean
    squared gradient). Noise is the median over the flattest quarter of the blocks, d the median
    over the richer half: people who walk about in less than half of those do not count. Of
    different views flat blocks change as much as rich ones, which is no noise.
    """
    image, other = np.asarray(image, dtype=float), np.asarray(other, dtype=float)
    if image.shape != other.shape or image.ndim != 2 or np.any(np.array(image.shape) < BLOCKS):
        raise ValueError(
            f"expected two grey pictures of one size, found {image.shape}, {other.shape}"
        )
    middle = (image + other) / 2
    rise, run = np.gradient(middle)
    slope = _block_means((rise**2 + run**2) / 2)
    changed = _block_means((other - image) ** 2)
    flat = slope <= np.percentile(slope, FLAT)
    rich = slope >= np.percentile(slope, RICH)
    if np.median(slope[rich]) < MIN_TEXTURE or _correlation(image, other, rich) < SAME:
        return np.inf
    squared = 0.0
    for _ in range(10):  # the flattest blocks have some slope too
        noise = np.median(np.maximum(changed[flat] - squared * slope[flat], 0))
        squared = np.median(np.maximum(changed[rich] - noise, 0) / slope[rich])
    return float(np.sqrt(squared))


def _detail(image: ArrayLike) -> float:
    """Return the mean squared gradient of a grey picture (h, w); more than 0."""
    rise, run = np.gradient(np.asarray(image, dtype=float))
    return max(float(np.mean(rise**2 + run**2)), 1e-9)


def _correlation(image: NDArray, other: NDArray, blocks: NDArray) -> float:
    """Return the median correlation of two pictures within the chosen blocks, (9, 16) bool."""
    mean, other_mean = _block_means(image), _block_means(other)
    both = _block_means(image * other) - mean * other_mean
    squares = (_block_means(image**2) - mean**2) * (_block_means(other**2) - other_mean**2)
    return float(np.median((both / np.sqrt(np.maximum(squares, 1e-9)))[blocks]))


def _block_means(values: NDArray) -> NDArray:
    """Average (h, w) values in blocks of nearly equal size."""
    for axis, count in enumerate(BLOCKS):
        edges = np.linspace(0, values.shape[axis], count + 1).astype(int)
        sums = np.add.reduceat(values, edges[:-1], axis=axis)
        values = sums / np.expand_dims(np.diff(edges), 1 - axis)
    return values
