"""Left and right mixed up by a network in some views: how far the views contradict one another.

A network that sees a person from behind or the side sometimes names the left leg right for a while. Such
keypoints are precise but belong to the other limb. Each view can then be read in two ways, and the views
together tell which readings belong to one body.
"""

import numpy as np

from courtside.geometry import epipolar, triangulation

APART = 2.0  # joints of a pair closer than this many limits in a view say less about sides there
NEAREST_M = 1e-6  # depth: points behind a camera come out far from any keypoint
BATCH = 20000  # pairs at a time: keeps the working set in the cache and memory flat


def disagreement(cameras, straight, weight, swapped, limit_px):
    """Return how far views are from showing one body, for several readings of their sides.

    Parameters
    ----------
    cameras : list of Camera, length C
    straight : (C, T, K, 2, 2) float
        Straight px (`epipolar.straight_px`) of the left and the right joint of K pairs; NaN where unseen.
    weight : (C, T, K) float
        Of a pair in a view, such as the lower score of its joints; 0 where one of them is unseen.
    swapped : (R, C, T) bool
        R readings: the views whose left and right change places.
    limit_px : (C,) float
        Disagreement of a keypoint is counted up to this reprojection error.

    Returns
    -------
    disagreement : (R, T) float
        Sum over views, pairs and both joints of the squared errors in units of the limit, cut off at 1,
        times the weight. A pair counts less in a view where its joints are close.

    Notes
    -----
    A joint is triangulated from all views that see it, by DLT: where one is read wrong, all are off.
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


class _Views:
    """A piece of a take: what every reading of it needs. Matrices (C, 3, 4) project to straight px."""

    def __init__(self, matrix, straight, weight, limit_px):
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

    def disagreement(self, swapped):
        """Return (T,) for one reading (C, T)."""
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


def _read(values, swapped):
    """Return values (C, T, K, 2, ...) with left and right exchanged where told, (C, T)."""
    shaped = swapped.reshape(swapped.shape + (1,) * (values.ndim - 2))
    return np.where(shaped, values[:, :, :, ::-1], values)
