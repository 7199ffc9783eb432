"""Left and right mixed up by a network in some views, found by the other views.

A network that sees a person from behind or the side sometimes names the left leg right for a while. Such
keypoints are precise but belong to the other limb. Each view can then be read in two ways, and the views
together tell which readings belong to one body.
"""

import numpy as np

from courtside.geometry import triangulation

ROUNDS = 4  # changes per frame and limb group at most, as many as there are views that can be wrong
GAIN = 2.0  # full disagreements of a keypoint that a swap must end: ties keep the network's word
APART = 2.0  # joints of a pair closer than this many limits in a view say nothing about sides there


def swapped_views(cameras, xy, score, mirror, groups, *, max_error_px):
    """Find the views in which a network took left for right.

    Parameters
    ----------
    cameras : list of Camera, length C
    xy : (C, T, J, 2) float
        Keypoints in px, distorted; NaN where unseen.
    score : (C, T, J) float
        Confidence, 0 to 1; NaN where unseen.
    mirror : (J,) int
        Index of the same joint of the other side, itself for joints without sides.
    groups : list of list of int
        Joints that a network confuses together, such as both legs; each closed under `mirror`.
    max_error_px : float
        Disagreement of a view is counted up to this reprojection error.

    Returns
    -------
    swapped : (C, T, J) bool
        True where the left and right keypoints of a view should change places.

    Notes
    -----
    For each frame and group, starting from the network's word, the view whose swap lowers the
    disagreement of all views most is swapped, until none helps: C trials a round, not 2^C readings. All
    views swapped together look as consistent as none, so the reading of fewer swaps is kept: more than
    half of the views must be right.
    """
    swapped = np.zeros(score.shape, dtype=bool)
    mirror = np.asarray(mirror)
    for group in groups:
        flags = _settle(
            cameras, xy[:, :, group], score[:, :, group], _within(mirror, group), max_error_px
        )
        swapped[:, :, group] = flags[..., None]
    return swapped & (mirror != np.arange(len(mirror)))


def apply_swaps(values, swapped, mirror):
    """Exchange left and right where told.

    Parameters
    ----------
    values : (C, T, J) or (C, T, J, K) array
        Anything per keypoint.
    swapped : (C, T, J) bool
    mirror : (J,) int

    Returns
    -------
    exchanged : array of the shape of `values`
    """
    shaped = swapped.reshape(swapped.shape + (1,) * (values.ndim - swapped.ndim))
    return np.where(shaped, values[:, :, np.asarray(mirror)], values)


def _within(mirror, group):
    return np.array([list(group).index(mirror[joint]) for joint in group])


def _settle(cameras, xy, score, mirror, max_error_px):
    """Return (C, T) bool for one group: greedy swaps, one view a round."""
    flags = np.zeros(score.shape[:2], dtype=bool)
    cost = _cost(cameras, xy, score, flags, mirror, max_error_px)
    for _ in range(ROUNDS):
        # A frame with less to gain than a swap must gain is settled, as is one without a gain before.
        open_ = np.flatnonzero(cost > GAIN)
        if not len(open_):
            break
        trials = []
        for camera in range(len(cameras)):
            trial = flags[:, open_]
            trial[camera] ^= True
            trials.append(
                _cost(cameras, xy[:, open_], score[:, open_], trial, mirror, max_error_px)
            )
        best, lowest = np.argmin(trials, axis=0), np.min(trials, axis=0)
        better = lowest < cost[open_] - GAIN
        flags[best[better], open_[better]] ^= True
        cost[open_] = np.where(better, lowest, 0.0)
    return _fewer(flags)


def _fewer(flags):
    """Prefer, of a reading and its mirror image, the one with fewer swapped views."""
    many = flags.sum(axis=0) * 2 > flags.shape[0]
    return flags ^ many


def _cost(cameras, xy, score, flags, mirror, max_error_px):
    """Return (T,) disagreement: score-weighted squared errors in units of the limit, cut off at 1.

    Only joints that lie apart from their mirror image in a view count there.
    """
    swapped = np.broadcast_to(flags[..., None], score.shape)
    xy, score = apply_swaps(xy, swapped, mirror), apply_swaps(score, swapped, mirror)
    flat = np.nan_to_num(score).reshape(len(cameras), -1)
    found = triangulation.triangulate_robust(
        cameras, xy.reshape(len(cameras), -1, 2), flat, sigma_px=1.0, max_error_px=max_error_px
    )
    share = np.minimum(np.nan_to_num(found.error_px / max_error_px, nan=1.0) ** 2, 1.0)
    apart = np.linalg.norm(xy - xy[:, :, mirror], axis=-1) > APART * max_error_px
    return (share.reshape(score.shape) * np.nan_to_num(score) * apart).sum(axis=(0, 2))
