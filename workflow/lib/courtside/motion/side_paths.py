"""Which views of a person show left for right, decided over a whole take.

In one frame two views that contradict each other look alike: either may be wrong. Over time they do not: a
limb does not jump to the place of the other one, so the view that jumps is the wrong one.
"""

import numpy as np

from courtside.geometry import epipolar, sides

TOGETHER = 4  # views decided at once, of 2^4 readings; further ones follow one by one
LIMIT = 0.2  # disagreement is counted up to this share of the person's size at most
JUMP = 0.5  # sizes: a movement between two frames that speaks fully against itself
CONTINUITY = 2.0  # a keypoint's full jump, in units of its full disagreement
SWITCH = 1.0  # cost of a view that changes from right to wrong or back, in the same unit
PRIOR = 0.01  # cost of a pair of keypoints read against the network's word, in the same unit
LONGEST_GAP = 15  # frames: over longer gaps nothing is known of movements


def swapped_views(cameras, xy, score, mirror, groups, *, max_error_px):
    """Find where networks took left for right in a take of one person.

    Parameters
    ----------
    cameras : list of Camera, length C
    xy : (C, T, J, 2) float
        Keypoints in px, distorted, at uniform times; NaN where unseen.
    score : (C, T, J) float
        Confidence, 0 to 1; NaN where unseen.
    mirror : (J,) int
        Index of the same joint of the other side, itself for joints without sides.
    groups : list of list of int
        Joints that a network confuses together, such as both legs; each closed under `mirror`.
    max_error_px : float
        Disagreement of a view is counted up to this reprojection error, or to `LIMIT` of the person's
        size in that view where this is less.

    Returns
    -------
    swapped : (C, T, J) bool
        True where the left and right keypoints of a view should change places.

    Notes
    -----
    For each group, the path over time through the readings of the views that costs least (Viterbi 1967).
    A reading costs what the views disagree on (`sides.disagreement`) and a little for each view that it
    exchanges; a change of a view's reading costs what joints move further with the change than without,
    and a little more. All views exchanged look as consistent as none: the reading of fewer exchanges is
    kept, so each must be right more often than not. A view that errs only while its sides cross in the
    picture is found by the others alone.
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


def sizes(xy):
    """Return how large a person is in each view and frame: the root mean square distance from the middle.

    Parameters
    ----------
    xy : (C, T, J, 2) float
        Keypoints, px; NaN where unseen.

    Returns
    -------
    size_px : (C, T) float
        Of frames that show less than half of the joints ever shown at once, that of their neighbours.
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


def jumps(xy, weight, size_px):
    """Return how much further joints move where sides change between a frame and the one before.

    Parameters
    ----------
    xy : (C, T, K, 2, 2) float
        Left and right joint of K pairs, px; NaN where unseen.
    weight : (C, T, K) float
        Of each pair; 0 where unseen.
    size_px : (C, T) float
        Of the person.

    Returns
    -------
    further : (C, T) float
        Sum over pairs of the squared movements in units of `JUMP`, cut off at 1, with a change less
        without, times the weight. Negative where a change is the smaller movement.

    Notes
    -----
    A movement is the way of left relative to right from where the last frame that shows the pair, or its
    velocity, or the velocity of the next frame, puts it: the nearest of the three. Sides that cross with
    a velocity thus speak neither for nor against a change. After a gap, `JUMP` squared grows with its
    frames.
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

    def movement(sign):
        moved = sign * apart - before
        ways = (moved, moved - came, moved - sign * goes)
        square = np.min([(way**2).sum(axis=-1) for way in ways], axis=0)
        return np.minimum(square / (JUMP**2 * gap), 1.0)

    known = (weight > 0) & (last >= 0) & (gap <= LONGEST_GAP)
    shared = np.minimum(weight, np.take_along_axis(weight, at, axis=1))
    return np.where(known, shared * (movement(-1) - movement(1)), 0.0).sum(axis=-1)


class _Group:
    """Joints of a person that are confused together; `change` (C, T) is the cost of a view's change."""

    def __init__(self, cameras, straight, weight, change, limit_px):
        self.cameras, self.straight, self.weight = cameras, straight, weight
        self.change, self.limit_px = change, limit_px
        self.word = PRIOR * weight.sum(axis=-1)

    def decide(self):
        """Return (C, T) bool: the views that show most first, together, then each given the others."""
        order = np.argsort(-self.word.sum(axis=1), kind="stable").tolist()
        flags = np.zeros(self.word.shape, dtype=bool)
        self._choose(flags, order[:TOGETHER], order[:TOGETHER])
        for n_used in range(TOGETHER + 1, len(order) + 1):
            self._choose(flags, order[:n_used], [order[n_used - 1]])
        for camera in order if len(order) > TOGETHER else []:
            self._choose(flags, order, [camera])
        return flags

    def _choose(self, flags, used, free):
        """Set the flags of the free views, by those that are used."""
        exchanged = (np.arange(2 ** len(free))[:, None] >> np.arange(len(free))) & 1 == 1
        trials = np.repeat(flags[None], len(exchanged), axis=0)
        trials[:, free] = exchanged[..., None]
        # With no view given, a reading and its mirror image contradict themselves alike.
        n_costed = len(trials) // 2 if len(free) == len(used) else len(trials)
        cost = sides.disagreement(
            [self.cameras[at] for at in used],
            self.straight[used],
            self.weight[used],
            trials[:n_costed, used],
            self.limit_px[used],
        )
        cost = np.concatenate([cost, cost[::-1]])[: len(trials)] + exchanged @ self.word[free]
        path = cheapest_path(cost.T, (exchanged @ self.change[free]).T)
        flags[free] = exchanged[path].T


def cheapest_path(cost, change):
    """Find the states over time that cost least together.

    Parameters
    ----------
    cost : (T, S) float
        Of each state; S a power of two, whose bits are switches.
    change : (T, S) float
        Of changing the switches that are the bits of the index, from the frame before.

    Returns
    -------
    path : (T,) int

    Notes
    -----
    Viterbi 1967.
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
