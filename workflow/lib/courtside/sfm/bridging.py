"""Bridging images: which frames of a walk's grid are usable, and which of them are taken.

Places in the grid are counted from 0 to G - 1, one per row of the walk's frame table. Nothing here
knows where the camera was.
"""

import numpy as np

from courtside.sfm.pairs import STRIDES
from courtside.study.errors import InputError

OFFSETS = 3  # offsets of the taken images, in thirds of their spacing
COARSE = 0.4  # places are multiples of a power of two that is at most this share of the spacing
CLEARLY = 1.25  # times as sharp as the nearest usable frame: worth moving there
GAP_COST = 1e6  # of a gap wider than that: taken only where no other choice is left
BLOCKS = (9, 16)  # rows and columns of blocks in which two pictures are compared
FLAT, RICH = (
    25,
    50,
)  # percentiles: blocks with less texture show the noise, those with more the motion
BLACK_LEVEL, BLACK_SHARE = 20, 0.8  # dark: so much of the picture is below that
MIN_TEXTURE = (
    1.0  # squared grey levels per pixel; less in most blocks: nothing can be said of motion
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


def choose(kept_idx, n_grid, n, offset_idx, sharpness, rule="even", *, walk="walk"):
    """Choose the bridging images among the usable frames of a walk's grid.

    Parameters
    ----------
    kept_idx : (K,) int
        Places of the usable frames in the grid, ascending.
    n_grid : int
        Frames of the grid, G.
    n : int
        Images wanted, at least 2.
    offset_idx : int
        0, 1 or 2: the images start this many thirds of their spacing late.
    sharpness : (G,) float
        Sharpness of every frame of the grid.
    rule : {"even", "interval"}
        "even": evenly spaced over the grid, sharper neighbours preferred. "interval": every d-th usable
        frame, d = floor(K / n), as published.
    walk : str
        Its name, for the message.

    Returns
    -------
    place_idx : (n,) int
        Places in the grid, strictly increasing.

    Raises
    ------
    InputError
        If there are fewer than n usable frames.
    ValueError
        If an argument is out of its range.

    Notes
    -----
    "even" places images on multiples of q, the largest power of two up to 0.4 of the spacing (or 1), so
    that `courtside.sfm.pairs.pair_list` holds all neighbours. Each wanted place goes to the nearest usable
    multiple; one within q of it wins that is the sharpest and clearly (1.25 times) sharper. Places are then
    settled together: none twice, where another choice exists no gap above 8 q and both ends less than a
    spacing from the grid's, and otherwise as near to the preferred as can be.
    "interval" ignores q: ask `courtside.sfm.pairs.missing_pairs`.
    """
    kept_idx = np.asarray(kept_idx, dtype=int)
    if n < 2 or not 0 <= offset_idx < OFFSETS or rule not in ("even", "interval"):
        raise ValueError(f"n {n}, offset {offset_idx}, rule {rule}")
    if np.any(np.diff(kept_idx) <= 0) or np.any((kept_idx < 0) | (kept_idx >= n_grid)):
        raise ValueError("kept_idx must ascend from 0 to below n_grid")
    if len(kept_idx) < n:
        raise InputError(
            f"{walk}: expected at least {n} usable frames, found {len(kept_idx)} of {n_grid} "
            "(the others are dark, blurred or duplicates): film longer, or lower n"
        )
    if rule == "interval":
        every = len(kept_idx) // n
        return kept_idx[every * offset_idx // OFFSETS + every * np.arange(n)]
    return _choose_even(kept_idx, n_grid, n, offset_idx, np.asarray(sharpness, dtype=float))


def neighbour_angles_deg(centres, point):
    """Measure the angles between neighbouring views, as seen from a point.

    Parameters
    ----------
    centres : (V, 3) float
        Optical centres in order along the path, the fixed cameras at its ends included; metres.
    point : (3,) float
        Where the angles are measured: for the study the court's centre, 1 m high.

    Returns
    -------
    angle_deg : (V - 1,) float
        Between 0 and 180; NaN beside a centre that is NaN.
    """
    ray = np.asarray(centres, dtype=float) - np.asarray(point, dtype=float)
    cross = np.linalg.norm(np.cross(ray[:-1], ray[1:]), axis=1)
    return np.degrees(np.arctan2(cross, np.sum(ray[:-1] * ray[1:], axis=1)))


def path_order(centres, fixed):
    """Put fixed cameras where a walk passes them.

    Parameters
    ----------
    centres : (V, 3) float
        Optical centres, those of the walk in order.
    fixed : (V,) bool
        Which are fixed cameras.

    Returns
    -------
    order : (V,) int
        Each fixed camera stands where it lengthens the path least: before, within or behind the walk.
    """
    order = np.flatnonzero(~fixed).tolist()
    for camera in np.flatnonzero(fixed):
        near = np.linalg.norm(centres[order] - centres[camera], axis=1)
        steps = np.linalg.norm(np.diff(centres[order], axis=0), axis=1)
        longer = np.concatenate([near[:1], near[:-1] + near[1:] - steps, near[-1:]])
        order.insert(int(np.argmin(longer)), int(camera))
    return np.array(order, dtype=int)


def _block_means(values):
    """Average (h, w) values in blocks of nearly equal size."""
    for axis, count in enumerate(BLOCKS):
        edges = np.linspace(0, values.shape[axis], count + 1).astype(int)
        sums = np.add.reduceat(values, edges[:-1], axis=axis)
        values = sums / np.expand_dims(np.diff(edges), 1 - axis)
    return values


def _choose_even(kept_idx, n_grid, n, offset_idx, sharpness):
    step = (n_grid - 1) / (n - 1)
    q = 1
    while 2 * q <= COARSE * step:
        q *= 2
    while np.count_nonzero(kept_idx % q == 0) < n:
        q //= 2
    usable = np.zeros((n_grid - 1) // q + 1, dtype=bool)
    usable[kept_idx[kept_idx % q == 0] // q] = True
    late = round(offset_idx * step / OFFSETS / q)
    wanted = late + np.linspace(0, (n_grid - 1) / q, n)
    wanted = np.minimum(wanted.round().astype(int), len(usable) - 1)
    preferred = np.array([_prefer(place, usable, sharpness[::q]) for place in wanted])
    places = np.arange(len(usable))
    costs = np.where(usable, (places - preferred[:, None]) ** 2.0, np.inf)
    costs[0, places * q > step] += GAP_COST
    costs[-1, places * q < n_grid - 1 - step] += GAP_COST
    return q * _settle(costs)


def _prefer(place, usable, sharpness):
    """Return the usable place nearest to a wanted one, or a clearly sharper one beside that."""
    places = np.flatnonzero(usable)
    nearest = places[np.argmin(np.abs(places - place))]
    near = places[np.abs(places - place) <= 1]
    if len(near) == 0:
        return nearest
    sharpest = near[np.argmax(sharpness[near])]
    return sharpest if sharpness[sharpest] > CLEARLY * sharpness[nearest] else nearest


def _settle(costs):
    """Assign each image a place, strictly increasing, at the least total cost: costs (n, places).

    A gap above `STRIDES` costs `GAP_COST` besides. Solved exactly, image after image, over all places.
    """
    places = np.arange(costs.shape[1])
    total, came_from = costs[0], []
    for cost in costs[1:]:
        near = np.full((STRIDES, len(places)), np.inf)
        for stride in range(1, min(STRIDES, len(places) - 1) + 1):
            near[stride - 1, stride:] = total[:-stride]
        stride = np.argmin(near, axis=0) + 1
        best, origin = near.min(axis=0), places - stride
        if len(places) > STRIDES + 1:
            running = np.minimum.accumulate(total)
            first = np.maximum.accumulate(np.where(total <= running, places, 0))
            far = running[: -STRIDES - 1] + GAP_COST
            better = far < best[STRIDES + 1 :]
            best[STRIDES + 1 :][better] = far[better]
            origin[STRIDES + 1 :][better] = first[: -STRIDES - 1][better]
        came_from.append(origin)
        total = best + cost
    chosen = [int(np.argmin(total))]
    for origin in reversed(came_from):
        chosen.append(int(origin[chosen[-1]]))
    return np.array(chosen[::-1])
