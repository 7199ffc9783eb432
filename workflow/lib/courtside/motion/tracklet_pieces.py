"""Rows of 2D tracklets of one camera: where a body is, and where it may be another one."""

from dataclasses import dataclass

import numpy as np

JUMP = (
    0.15  # of the body's height: a centre that is further from where it was heading is another body
)
CLOSE = 0.4  # of the body's height: rows with centres closer than this may exchange their bodies
AROUND = 2  # frames before and after a close meeting in which they may still do so
STEADY = 2  # frames before and after that steady a centre
MIN_SHARE = 0.4  # of the joints must be seen for a row to count
SIGMA_SHARE, SIGMA_PX = (
    0.02,
    2.0,
)  # standard deviation of a joint: share of the body's height, and a floor


@dataclass(frozen=True)
class Rows:
    """What is known of the P rows of one camera in T frames before any are compared across views.

    Attributes
    ----------
    present : (P, T) bool
        Whether the row shows a body.
    centre : (P, T, 2) float
        Mean of the trunk's joints over five frames at most, px; NaN where absent.
    height_px : (P, T) float
        From the highest to the lowest joint; NaN where absent.
    sigma_px : (P,) float
        Standard deviation to expect of a joint, per axis.
    cut : (P, T) bool
        True where the row may show another body than in the frame before.
    piece : (P, T) int
        Number of the uncut piece, unlike those of other rows of this camera; -1 where absent.
    """

    present: np.ndarray
    centre: np.ndarray
    height_px: np.ndarray
    sigma_px: np.ndarray
    cut: np.ndarray
    piece: np.ndarray


def describe(xy, trunk):
    """Describe the rows of one camera.

    Parameters
    ----------
    xy : (P, T, J, 2) float
        Keypoints in px; NaN where missing.
    trunk : list of int
        Joints whose mean is the body's centre: shoulders and hips.

    Returns
    -------
    rows : Rows

    Notes
    -----
    A row is cut after each frame without a body, where its centre jumps off its course, and in every frame
    in which another body is so close that a tracker may confuse them.
    """
    seen = np.isfinite(xy[..., 0])
    present = seen.mean(axis=-1) >= MIN_SHARE
    centre = np.where(present[..., None], _centre(xy, seen, trunk), np.nan)
    present &= np.isfinite(centre[..., 0])
    ys = xy[..., 1]
    height = np.fmax.reduce(ys, axis=-1) - np.fmin.reduce(ys, axis=-1)
    height = np.where(present & (height > 0), height, np.nan)
    typical = np.array(
        [np.median(h[np.isfinite(h)]) if np.isfinite(h).any() else 0 for h in height]
    )
    before = np.zeros_like(present)
    before[:, 1:] = present[:, :-1]
    limit = (JUMP * typical + SIGMA_PX)[:, None]
    broken = present & (~before | (_off_course(centre) > limit))
    cut = broken | (present & _meeting(centre, typical))
    centre = _steadied(centre, np.where(present, np.cumsum(broken, axis=1), -1))
    number = np.cumsum(cut, axis=1) + np.cumsum(cut.sum(axis=1))[:, None] - cut.sum(axis=1)[:, None]
    piece = np.where(present, number, -1)
    return Rows(present, centre, height, SIGMA_SHARE * typical + SIGMA_PX, cut, piece)


def _centre(xy, seen, trunk):
    """Return the mean of the trunk's joints, or of all joints where less than half of the trunk is seen."""
    mean = []
    for joints in (list(trunk), list(range(xy.shape[2]))):
        count = seen[:, :, joints].sum(axis=-1)[..., None]
        enough = count * 2 >= len(joints) if not mean else count > 0
        total = np.nansum(xy[:, :, joints], axis=2)
        mean.append(np.where(enough, total / np.maximum(count, 1), np.nan))
    return np.where(np.isfinite(mean[0]), mean[0], mean[1])


def _off_course(centre):
    """Return (P, T) how far each centre is from where two frames before it point, 0 where unknown, px."""
    off = np.zeros(centre.shape[:2])
    bend = centre[:, 2:] - 2 * centre[:, 1:-1] + centre[:, :-2]
    off[:, 2:] = np.nan_to_num(np.linalg.norm(bend, axis=-1))
    step = np.linalg.norm(np.diff(centre, axis=1), axis=-1)
    # After a gap there is no course yet: then the place itself must not jump twice as far.
    alone = np.isfinite(step[:, 1:]) & ~np.isfinite(bend[..., 0])
    off[:, 2:] = np.where(alone, step[:, 1:] / 2, off[:, 2:])
    return off


def _steadied(centre, run):
    """Return the mean over neighbouring frames of one unbroken run, as many before as after."""
    total, count = centre.copy(), np.ones(run.shape)
    for shift in range(1, STEADY + 1):
        whole = np.zeros(run.shape, dtype=bool)
        middle = slice(shift, -shift)
        whole[:, middle] = (run[:, : -2 * shift] == run[:, 2 * shift :]) & (run[:, middle] >= 0)
        whole[:, middle] &= run[:, middle] == run[:, 2 * shift :]
        pair = np.zeros_like(centre)
        pair[:, middle] = np.nan_to_num(centre[:, : -2 * shift] + centre[:, 2 * shift :])
        total += np.where(whole[..., None], pair, 0.0)
        count += 2 * whole
    return total / count[..., None]


def _meeting(centre, typical):
    """Return (P, T) bool: another row of this camera is close."""
    close = np.zeros(centre.shape[:2], dtype=bool)
    for one in range(len(centre)):
        for other in range(one + 1, len(centre)):
            apart = np.linalg.norm(centre[one] - centre[other], axis=-1)
            near = np.nan_to_num(apart, nan=np.inf) < CLOSE * max(typical[one], typical[other])
            close[one] |= near
            close[other] |= near
    wide = close.copy()
    for shift in range(1, AROUND + 1):
        wide[:, shift:] |= close[:, :-shift]
        wide[:, :-shift] |= close[:, shift:]
    return wide
