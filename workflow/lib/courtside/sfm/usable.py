"""Which frames of a walk's grid are usable for structure from motion."""

import numpy as np

BLOCKS = (9, 16)  # rows and columns of blocks in which two pictures are compared
# Percentiles: blocks with less texture than the first show the noise, with more than the second the motion.
FLAT, RICH = 25, 50
BLACK_LEVEL, BLACK_SHARE = 20, 0.8  # dark: so much of the picture is below that
MIN_TEXTURE = (
    1.0  # squared grey levels per pixel; with less in most blocks nothing is said of motion
)


def judge(table, images, *, window=15, min_share=0.6, still_share=5e-4):
    """Judge which frames of a walk's grid are usable for structure from motion.

    Parameters
    ----------
    table : DataFrame
        One row per frame of the grid, in order: `frame_idx`, `time_s`, `sharpness` (variance of the
        Laplacian), `name`.
    images : sequence of (h, w) uint8, length G
        The same frames, grey, reduced by averaging to one small size, about 320 pixels wide.
    window : int
        Frames, the judged one in the middle, whose median sharpness is the measure; fewer at the ends.
    min_share : float
        A frame is blurred where its sharpness is below this share of that median.
    still_share : float
        A frame is a duplicate where it moved less than this, in picture widths, from the last kept
        frame. The default, 0.6 px of 1280, is about the noise of a feature's place.

    Returns
    -------
    kept : (G,) bool
        Whether the frame may become a bridging image.
    why : (G,) str
        "dark", "blurred", "duplicate", or "" for a kept frame.

    Raises
    ------
    ValueError
        If table and images differ in number, or the images in size.

    Notes
    -----
    A frame is dark where 80 % of it is below 20 of 255. A stretch of blur longer than half the window
    becomes its own measure and is kept: those frames are all there is of that part of the walk. Of a
    walker who stands still the first frame is kept.
    """
    sharpness = table["sharpness"].to_numpy(float)
    shapes = {np.shape(image) for image in images}
    if len(sharpness) != len(images) or len(shapes) > 1:
        raise ValueError(f"{len(sharpness)} rows, {len(images)} images, shapes {shapes}")
    medians = table["sharpness"].rolling(window, center=True, min_periods=1).median().to_numpy()
    why = np.where(sharpness < min_share * medians, "blurred", "").astype("<U9")
    why[[np.mean(np.asarray(image) < BLACK_LEVEL) > BLACK_SHARE for image in images]] = "dark"
    last = None
    for at in np.flatnonzero(why == ""):
        if (
            last is not None
            and motion_px(images[last], images[at]) < still_share * images[at].shape[1]
        ):
            why[at] = "duplicate"
        else:
            last = at
    return why == "", why


def motion_px(image, other):
    """Estimate how far a picture's content moved, for motions near the noise.

    Parameters
    ----------
    image, other : (h, w) uint8
        Two grey pictures of one size.

    Returns
    -------
    motion_px : float
        Typical displacement, in pixels of these pictures; up to 1.4 times too large in sharp ones, too small
        but not small beyond a few pixels. Infinite where they show too little texture to tell.

    Raises
    ------
    ValueError
        If they are not two grey pictures of one size, at least 16 by 9.

    Notes
    -----
    A small displacement d changes a pixel by d times the slope there; noise adds the same everywhere. So
    in each block the mean squared difference is (squared noise) + (squared d)(mean squared slope). Noise
    is the median over the flattest quarter of the blocks, d the median over the richer half: people who
    walk about in less than half of those do not count.
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
    if np.median(slope[rich]) < MIN_TEXTURE:
        return np.inf
    squared = 0.0
    for _ in range(10):  # the flattest blocks have some slope too
        noise = np.median(np.maximum(changed[flat] - squared * slope[flat], 0))
        squared = np.median(np.maximum(changed[rich] - noise, 0) / slope[rich])
    return float(np.sqrt(squared))


def _block_means(values):
    """Average (h, w) values in blocks of nearly equal size."""
    for axis, count in enumerate(BLOCKS):
        edges = np.linspace(0, values.shape[axis], count + 1).astype(int)
        sums = np.add.reduceat(values, edges[:-1], axis=axis)
        values = sums / np.expand_dims(np.diff(edges), 1 - axis)
    return values
