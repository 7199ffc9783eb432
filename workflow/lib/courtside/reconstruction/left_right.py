"""Detection of left-right swaps of a pose network, from the other views and over time."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import epipolar, triangulation
from courtside.geometry.camera import Camera

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md). The unit of cost is
# the full disagreement of one keypoint.
TOGETHER = 4  # views decided at once, 2^4 hypotheses; further ones follow one by one
LIMIT = 0.2  # share of the person's size at which disagreement is cut off at the latest
JUMP = 0.5  # person's sizes: a movement between two frames of the full cost `CONTINUITY`
CONTINUITY = 2.0  # cost of a keypoint's full jump
SWITCH = 1.0  # cost of a view that changes from right to wrong or back
PRIOR = 0.01  # cost of a pair of keypoints read against the network's labels
# The same where two views show the pair. They hardly tell the sides of a person apart who faces the
# middle between the cameras, and the keypoints' errors last for several frames. With all pairs of
# cameras of 34 development takes, 0.01 exchanged right sides for whole takes: 4.2 % of the joints
# were more than 150 mm off; with 0.03, 0.1 and 0.3 it is 3.1, 2.4 and 2.4 %.
PRIOR_OF_TWO = 0.1
LONGEST_GAP = 15  # frames: over longer gaps movements are not judged


def swapped_views(
    cameras: Sequence[Camera],
    xy: NDArray,
    score: NDArray,
    mirror: Sequence[int] | NDArray,
    groups: Sequence[Sequence[int]],
    *,
    max_error_px: ArrayLike,
) -> NDArray:
    """Find where networks confused left and right in a take of one person.

    Return (C, T, J) bool: True where the left and right keypoints of a view should be exchanged.
    `xy` (C, T, J, 2) are distorted px at uniform times and `score` (C, T, J) is 0 to 1, both NaN
    where unseen; `mirror` (J,) is the index of the same joint of the other side, its own for joints
    without sides. `groups` are joints that a network confuses together, such as both legs; each
    closed under `mirror`. Disagreement of a view is cut off at the reprojection error
    `max_error_px`, a number or (C,), or at `LIMIT` of the person's size there if this is less.

    For each group, the cheapest path over time through the hypotheses (Viterbi 1967). A hypothesis
    costs the disagreement of the views (`disagreement`) and a little for each view it exchanges; a
    change in a view costs the additional movement of its joints (`jumps`) and a little more. If all
    views are exchanged, they are as consistent as if none is. The hypothesis with fewer exchanges
    is kept, so each view must be right in most frames. If a view is wrong only while its sides
    cross in the picture, only the other views can detect this.
    """
    mirror = np.asarray(mirror)
    straight = np.stack([epipolar.straight_px(c, at) for c, at in zip(cameras, xy, strict=True)])
    size_px = sizes(straight)
    limit_px = np.minimum(max_error_px, LIMIT * np.median(size_px, axis=1))
    seen = np.isfinite(straight).all(axis=-1) & (np.nan_to_num(score) > 0)
    swapped = np.zeros(score.shape, dtype=bool)
    for group in groups:
        pairs = np.array([(at, mirror[at]) for at in group if mirror[at] > at], int).reshape(-1, 2)
        weight = np.where(seen[:, :, pairs].all(axis=-1), score[:, :, pairs].min(axis=-1), 0.0)
        change = SWITCH + CONTINUITY * jumps(straight[:, :, pairs], weight, size_px)
        flags = _Group(cameras, straight[:, :, pairs], weight, change, limit_px).decide()
        swapped[:, :, pairs.ravel()] = flags[..., None]
    return swapped & (seen | seen[:, :, mirror])


def sizes(xy: NDArray) -> NDArray:
    """Return the size (C, T), px, of a person: root mean square distance of joints from their mean.

    `xy` (C, T, J, 2) is NaN where unseen. Frames with less than half of the most joints ever seen
    at once get the size of their neighbours.
    """
    known = np.isfinite(xy).all(axis=-1)
    count = known.sum(axis=-1)
    share = known / np.maximum(count, 1)[..., None]
    filled = np.where(known[..., None], xy, 0.0)
    middle = (filled * share[..., None]).sum(axis=2, keepdims=True)
    size_px = np.sqrt((((filled - middle) ** 2).sum(axis=-1) * share).sum(axis=-1))
    frames = np.arange(xy.shape[1])
    for of_view, number in zip(size_px, count, strict=True):
        enough = np.flatnonzero(number >= max(2, number.max(initial=0) / 2))
        of_view[:] = np.interp(frames, enough, of_view[enough]) if len(enough) else 1.0
    return np.maximum(size_px, 1.0)


def jumps(xy: NDArray, weight: NDArray, size_px: NDArray) -> NDArray:
    """Return how much further joints move if sides change from one frame to the next, (C, T).

    `xy` (C, T, K, 2, 2) px has the left and right joint of K pairs, NaN where unseen; `weight` (C,
    T, K) is of each pair, 0 where unseen; `size_px` (C, T) of the person. The result is the
    weighted sum over pairs of the squared movements in units of `JUMP`, cut off at 1, with a change
    minus without: negative where a change is the smaller movement.

    A movement is the distance of left relative to right from its prediction, by the last frame that
    shows the pair, by its velocity, or by the velocity of the next frame: the smallest of the
    three. Sides that cross with a velocity are thus neutral. After a gap, `JUMP` squared grows with
    its frames.
    """
    apart = (xy[..., 0, :] - xy[..., 1, :]) / size_px[..., None, None]
    frame = np.arange(weight.shape[1])[None, :, None]
    latest = np.maximum.accumulate(np.where(weight > 0, frame, -1), axis=1)
    start = np.full_like(latest[:, :1], -1)
    last = np.concatenate([start, latest[:, :-1]], axis=1)
    gap = frame - last
    at = np.maximum(last, 0)
    step = np.nan_to_num(np.diff(apart, axis=1, prepend=np.nan, append=np.nan))
    before = np.take_along_axis(apart, at[..., None], axis=1)
    came = np.take_along_axis(step[:, :-1], at[..., None], axis=1)
    goes = step[:, 1:]

    def movement(sign: int) -> NDArray:
        moved = sign * apart - before
        ways = (moved, moved - came, moved - sign * goes)
        square = np.min([(way**2).sum(axis=-1) for way in ways], axis=0)
        return np.minimum(square / (JUMP**2 * gap), 1.0)

    known = (weight > 0) & (last >= 0) & (gap <= LONGEST_GAP)
    shared = np.minimum(weight, np.take_along_axis(weight, at, axis=1))
    return np.where(known, shared * (movement(-1) - movement(1)), 0.0).sum(axis=-1)


class _Group:
    """Joints that are confused together; `change` (C, T) is the cost of a view's change."""

    def __init__(self, cameras, straight, weight, change, limit_px) -> None:
        self.cameras, self.straight, self.weight = cameras, straight, weight
        self.change, self.limit_px = change, limit_px
        prior = np.where((weight > 0).sum(axis=0) > 2, PRIOR, PRIOR_OF_TWO)
        self.label_cost = (prior * weight).sum(axis=-1)

    def decide(self) -> NDArray:
        """Return (C, T) bool: the best-seen views together, then each further view given those."""
        order = np.argsort(-self.label_cost.sum(axis=1), kind="stable").tolist()
        flags = np.zeros(self.label_cost.shape, dtype=bool)
        self._choose(flags, order[:TOGETHER], order[:TOGETHER])
        for n_used in range(TOGETHER + 1, len(order) + 1):
            self._choose(flags, order[:n_used], [order[n_used - 1]])
        for camera in order if len(order) > TOGETHER else []:
            self._choose(flags, order, [camera])
        return flags

    def _choose(self, flags: NDArray, used: list[int], free: list[int]) -> None:
        """Set the flags of the free views, by those that are used."""
        exchanged = (np.arange(2 ** len(free))[:, None] >> np.arange(len(free))) & 1 == 1
        trials = np.repeat(flags[None], len(exchanged), axis=0)
        trials[:, free] = exchanged[..., None]
        # If all views are free, a hypothesis and its mirror image have the same disagreement.
        n_costed = len(trials) // 2 if len(free) == len(used) else len(trials)
        cost = disagreement(
            [self.cameras[at] for at in used],
            self.straight[used],
            self.weight[used],
            trials[:n_costed, used],
            self.limit_px[used],
        )
        cost = np.concatenate([cost, cost[::-1]])[: len(trials)] + exchanged @ self.label_cost[free]
        path = cheapest_path(cost.T, (exchanged @ self.change[free]).T)
        flags[free] = exchanged[path].T


def cheapest_path(cost: NDArray, change: NDArray) -> NDArray:
    """Return the cheapest states (T,) over time, by Viterbi 1967.

    `cost` (T, S) is that of each state; S is a power of two, its bits are switches. `change` (T, S)
    is the cost of changing, from the frame before, the switches that are the bits of the index.
    """
    n_frames, n_states = cost.shape
    state = np.arange(n_states)
    between = change[:, state[:, None] ^ state]
    best = np.zeros((n_frames, n_states), dtype=int)
    total = np.zeros(n_states)
    for frame in range(n_frames):
        ways = total + between[frame] * (frame > 0)
        best[frame] = ways.argmin(axis=1)
        total = ways[state, best[frame]] + cost[frame]
    path = np.empty(n_frames, dtype=int)
    at = int(total.argmin())
    for frame in range(n_frames - 1, -1, -1):
        path[frame] = at
        at = best[frame, at]
    return path


APART = 2.0  # ASSUME: limits: pairs of joints closer than this in a view weigh less there
NEAREST_M = 1e-6  # least depth: points behind a camera project far from any keypoint
BATCH = 20000  # pairs at a time: keeps the working set in the cache and memory flat


def disagreement(
    cameras: Sequence[Camera],
    straight: NDArray,
    weight: NDArray,
    swapped: NDArray,
    limit_px: NDArray,
) -> NDArray:
    """Return the disagreement of views (R, T) for R hypotheses of their sides.

    `straight` (C, T, K, 2, 2) is `epipolar.straight_px` of the left and the right joint of K pairs,
    NaN where unseen; `weight` (C, T, K) that of a pair in a view, such as the lower score of its
    joints, 0 if one of them is unseen; `swapped` (R, C, T) bool the views with exchanged left and
    right; `limit_px` (C,) the reprojection error at which the disagreement of a keypoint is cut
    off.

    The weighted sum over views, pairs and both joints of the squared errors in units of the limit,
    cut off at 1. A pair counts less in a view where its joints are close. A joint is triangulated
    by DLT from all views that see it: one wrong view moves all errors.
    """
    n_frames, n_pairs = weight.shape[1:]
    matrix = np.stack([camera.cam_from_world for camera in cameras])
    matrix[:, :2] *= np.array([epipolar.focal_px(camera) for camera in cameras])[:, None, None]
    found = np.empty((len(swapped), n_frames))
    step = max(1, BATCH // max(n_pairs, 1))
    for first in range(0, n_frames, step):
        at = slice(first, first + step)
        views = _Views(matrix, straight[:, at], weight[:, at], limit_px)
        found[:, at] = [views.disagreement(reading) for reading in swapped[:, :, at]]
    return found


def apply_swaps(values: NDArray, swapped: NDArray, mirror: Sequence[int] | NDArray) -> NDArray:
    """Exchange left and right of values (..., J, ...) where `swapped` (..., J)."""
    shaped = swapped.reshape(swapped.shape + (1,) * (values.ndim - swapped.ndim))
    return np.where(shaped, np.take(values, mirror, axis=swapped.ndim - 1), values)


def exchange(values: NDArray, swapped: NDArray, mirror: Sequence[int] | NDArray) -> None:
    """Exchange left and right of values (C, ..., J, ...) in place, where `swapped` (C, ..., J)."""
    for of_camera, where in zip(values, swapped, strict=True):
        of_camera[:] = apply_swaps(of_camera, where, mirror)


class _Views:
    """What all hypotheses share; `matrix` (C, 3, 4) projects to straight px."""

    def __init__(self, matrix, straight, weight, limit_px) -> None:
        used = weight > 0
        apart = np.linalg.norm(straight[..., 0, :] - straight[..., 1, :], axis=-1)
        share = np.minimum(apart / (APART * limit_px[:, None, None]), 1.0)
        self.counted = np.where(used, weight * share**2, 0.0)
        self.matrix, self.limit_px = matrix, limit_px
        self.xy = np.where(used[..., None, None], straight, 0.0)
        around = matrix[:, None, None, None]
        rows = self.xy[..., None] * around[..., 2:, :] - around[..., :2, :]
        rows *= np.sqrt(weight)[..., None, None, None]
        self.normal = rows.swapaxes(-1, -2) @ rows

    def disagreement(self, swapped: NDArray) -> NDArray:
        """Return (T,) for one hypothesis (C, T)."""
        normal = _read(self.normal, swapped).sum(axis=0)
        flat = normal.reshape(-1, 4, 4)
        xyz = triangulation.solve_3x3(flat[:, :3, :3], -flat[:, :3, 3])
        total = np.zeros(normal.shape[:2])
        views = zip(self.matrix, _read(self.xy, swapped), self.limit_px, self.counted, strict=True)
        for matrix, xy, limit_px, counted in views:
            in_cam = (xyz @ matrix[:, :3].T + matrix[:, 3]).reshape(*xy.shape[:-1], 3)
            miss = in_cam[..., :2] / np.maximum(in_cam[..., 2:], NEAREST_M) - xy
            square = (miss[..., 0] ** 2 + miss[..., 1] ** 2) / limit_px**2
            # One view alone gives no point and contradicts nothing: a full miss in every reading.
            total += counted * np.minimum(np.nan_to_num(square, nan=1.0), 1.0).sum(axis=-1)
        return total.sum(axis=1)


def _read(values: NDArray, swapped: NDArray) -> NDArray:
    """Return values (C, T, K, 2, ...) with left and right exchanged where `swapped` (C, T)."""
    shaped = swapped.reshape(swapped.shape + (1,) * (values.ndim - 2))
    return np.where(shaped, values[:, :, :, ::-1], values)
