"""Bridging images: which frames of a walk's grid are taken.

Places in the grid are counted from 0 to G - 1, one per row of the walk's frame table. Nothing here
knows where the camera was.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.sfm.pairs import STRIDES
from courtside.study import methods
from courtside.study.errors import InputError, few
from courtside.study.methods import OFFSETS

# ASSUME: places are multiples of a power of two that is at most this share of the spacing: a
# multiple is then always nearer than the next image.
COARSE = 0.4
CLEARLY = 1.25  # ASSUME: times as sharp as the nearest usable frame: worth moving there
N_NAMED = 3  # photos in a line
GAP_COST = 1e6  # of a gap above `STRIDES`: above the sum of all other costs of a walk's grid


def choose(
    kept_idx: ArrayLike,
    n_grid: int,
    n: int,
    offset_idx: int,
    sharpness: ArrayLike,
    rule: str = "even",
    *,
    walk: str = "walk",
    not_kept: Sequence[str] | None = None,
) -> NDArray:
    """Choose the bridging images, ascending places, among the usable frames of a walk's grid.

    "even" places images on multiples of q, the largest power of two up to 0.4 of the spacing (or
    1), so that `courtside.sfm.pairs.pair_list` holds all neighbours. Each wanted place goes to the
    nearest usable multiple; one within q of it wins that is the sharpest and clearly (1.25 times)
    sharper. Places are then settled together: none twice, where another choice exists no gap above
    8 q and both ends less than a spacing from the grid's, and otherwise as near to the preferred as
    can be. "interval" ignores q. Raises `InputError` if there are fewer than n usable frames,
    `ValueError` if an argument is out of its range.

    Parameters
    ----------
    kept_idx : (K,) int; places of the usable frames in the grid, ascending
    n_grid : frames of the grid, G
    n : images wanted, at least 2
    offset_idx : 0, 1 or 2: the images start this many thirds of their spacing late
    sharpness : (G,) float; of every frame of the grid
    rule : "even": evenly spaced over the grid, sharper neighbours preferred; or "interval": every
        d-th usable frame, d = floor(K / n), as published
    not_kept : of photos, in words which are not usable and why; None for frames of a video
    """
    kept_idx = np.asarray(kept_idx, dtype=int)
    if n < 2 or not 0 <= offset_idx < OFFSETS or rule not in ("even", "interval"):
        raise ValueError(f"n {n}, offset {offset_idx}, rule {rule}")
    if np.any(np.diff(kept_idx) <= 0) or np.any((kept_idx < 0) | (kept_idx >= n_grid)):
        raise ValueError("kept_idx must ascend from 0 to below n_grid")
    if len(kept_idx) < n:
        raise InputError(f"{walk}: {_too_few(len(kept_idx), n_grid, n, not_kept)}")
    if rule == "interval":
        every = len(kept_idx) // n
        return kept_idx[every * offset_idx // OFFSETS + every * np.arange(n)]
    return _choose_even(kept_idx, n_grid, n, offset_idx, np.asarray(sharpness, dtype=float))


def _too_few(n_kept: int, n_grid: int, n: int, not_kept: Sequence[str] | None) -> str:
    what = "frames" if not_kept is None else "photos"
    others = " (the others are dark, blurred or duplicates)" if not_kept is None else ""
    if not_kept:
        others = f" ({few(not_kept, N_NAMED)})"
    mend = "film longer" if not_kept is None else "take more, sharp and with an overlap"
    return (
        f"expected at least {n} usable {what}, found {n_kept} of {n_grid}{others}: {mend}, or ask "
        f"for fewer by `{methods.fewer_images(n_kept)}` in the session file"
    )


def _choose_even(kept_idx, n_grid, n, offset_idx, sharpness) -> NDArray:
    step = (n_grid - 1) / (n - 1)
    q = 1
    while 2 * q <= COARSE * step:
        q *= 2
    while np.count_nonzero(kept_idx % q == 0) < n:
        q //= 2
    usable = np.zeros((n_grid - 1) // q + 1, dtype=bool)
    usable[kept_idx[kept_idx % q == 0] // q] = True
    late = methods.start(n, n_grid, offset_idx, q)
    wanted = late + np.linspace(0, (n_grid - 1) / q, n)
    wanted = np.minimum(wanted.round().astype(int), len(usable) - 1)
    preferred = np.array([_prefer(place, usable, sharpness[::q]) for place in wanted])
    places = np.arange(len(usable))
    costs = np.where(usable, (places - preferred[:, None]) ** 2.0, np.inf)
    costs[0, places * q > step] += GAP_COST
    costs[-1, places * q < n_grid - 1 - step] += GAP_COST
    return q * _settle(costs)


def _prefer(place: int, usable: NDArray, sharpness: NDArray) -> int:
    """Return the usable place nearest to a wanted one, or a clearly sharper one beside that."""
    places = np.flatnonzero(usable)
    nearest = places[np.argmin(np.abs(places - place))]
    near = places[np.abs(places - place) <= 1]
    if len(near) == 0:
        return nearest
    sharpest = near[np.argmax(sharpness[near])]
    return sharpest if sharpness[sharpest] > CLEARLY * sharpness[nearest] else nearest


def _settle(costs: NDArray) -> NDArray:
    """Assign each image a place, strictly increasing, at the least total cost: costs (n, places).

    A gap above `STRIDES` costs `GAP_COST` besides. Solved exactly, image after image, over all
    places.
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
