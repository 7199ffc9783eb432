"""Tracklet rows of one camera: body centres, sizes, and cuts where a row may change its body."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints2D

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
# Share of the body's height: a centre that deviates more from its course is another body.
JUMP = 0.15
CLOSE = 0.4  # share of the body's height: rows with closer centres may swap their bodies
AROUND = 2  # frames before and after such an encounter in which they may still swap
SMOOTHING = 2  # frames before and after that are averaged into a centre
MIN_SHARE = 0.4  # share of the joints that must be seen for a row to count
# Standard deviation of a joint: share of the body's height, plus px.
SIGMA_SHARE, SIGMA_PX = 0.02, 2.0
MOST_PIECES = 16  # of one camera and take: pairs of pieces take time


@dataclass(frozen=True)
class Rows:
    """The P rows of one camera in T frames, before any comparison across views."""

    present: NDArray  # (P, T): whether the row shows a body
    # (P, T, 2): mean of the trunk's joints over at most five frames, px; NaN where absent
    centre: NDArray
    height_px: NDArray  # (P, T): longer side of the joints' box; NaN where absent
    sigma_px: NDArray  # (P,): expected standard deviation of a joint, per axis
    cut: NDArray  # (P, T): true where the row may show another body than in the frame before
    # (P, T): number of the uncut piece, unique within this camera; -1 where absent
    piece: NDArray
    close: NDArray  # (P, T): whether another body is close enough for a tracker to confuse them


def describe(xy: NDArray, trunk: Sequence[int], stride: int = 1) -> Rows:
    """Describe the rows of one camera, keypoints `xy` (P, T, J, 2) in px, NaN where missing.

    The mean of the joints `trunk` (shoulders and hips) is the body's centre. A row is cut after
    each frame without a body, where its centre jumps off its course, and in every frame in which
    another body is close enough for a tracker to confuse them. Of a camera slower than the times of
    `xy`, `stride` is the number of these for each of its own frames, which the limits count.
    """
    seen = np.isfinite(xy[..., 0])
    present = seen.mean(axis=-1) >= MIN_SHARE
    centre = np.where(present[..., None], _centre(xy, seen, trunk), np.nan)
    present &= np.isfinite(centre[..., 0])
    # Who lies, dives or does push-ups is longer than high.
    height = (np.fmax.reduce(xy, axis=2) - np.fmin.reduce(xy, axis=2)).max(axis=-1)
    height = np.where(present & (height > 0), height, np.nan)
    typical = np.array(
        [np.median(h[np.isfinite(h)]) if np.isfinite(h).any() else 0 for h in height]
    )
    before = np.zeros_like(present)
    before[:, 1:] = present[:, :-1]
    limit = (JUMP * typical + SIGMA_PX)[:, None]
    broken = present & (~before | (_off_course(centre, stride) > limit))
    close = present & _close_to_another(centre, typical, AROUND * stride)
    cut = broken | close
    centre = _smoothed(centre, np.where(present, np.cumsum(broken, axis=1), -1), stride)
    number = np.cumsum(cut, axis=1) + np.cumsum(cut.sum(axis=1))[:, None] - cut.sum(axis=1)[:, None]
    piece = np.where(present, number, -1)
    return Rows(present, centre, height, SIGMA_SHARE * typical + SIGMA_PX, cut, piece, close)


def separate(view: Keypoints2D) -> NDArray:
    """Return the row (N, T) int of each piece that shows one body, -1 in other frames.

    A tracker may exchange people where they are close, resume a row with another body after a gap,
    and jump to another body. Rows are cut there, and frames in which another body is close belong
    to no piece. The longest pieces come first, at most `MOST_PIECES`. A row may have none.
    """
    joints, limbs = list(view.joints), list(skeleton.JOINTS)
    found = describe(
        view.xy[:, :, [joints.index(name) for name in limbs]],
        [limbs.index(name) for name in skeleton.TRUNK],
    )
    pieces = []
    for row, alone in enumerate(found.present & ~found.close):
        frames = np.flatnonzero(alone)
        each = np.split(frames, np.flatnonzero(np.diff(found.piece[row, frames])) + 1)
        pieces += [(row, piece) for piece in each if len(piece)]
    pieces.sort(key=lambda one: -len(one[1]))
    index = np.full((len(pieces[:MOST_PIECES]), len(view.time_s)), -1)
    for own, (row, piece) in zip(index, pieces, strict=False):
        own[piece] = row
    return index


def _centre(xy: NDArray, seen: NDArray, trunk: Sequence[int]) -> NDArray:
    """Return the mean of the trunk's joints, or of all if less than half the trunk is seen."""
    mean: list[NDArray] = []
    for joints in (list(trunk), list(range(xy.shape[2]))):
        count = seen[:, :, joints].sum(axis=-1)[..., None]
        enough = count * 2 >= len(joints) if not mean else count > 0
        total = np.nansum(xy[:, :, joints], axis=2)
        mean.append(np.where(enough, total / np.maximum(count, 1), np.nan))
    return np.where(np.isfinite(mean[0]), mean[0], mean[1])


def _off_course(centre: NDArray, stride: int) -> NDArray:
    """Return the distance (P, T), px, of each centre from the course of two frames before it.

    These are `stride` and twice `stride` earlier. It is 0 where unknown.
    """
    off = np.zeros(centre.shape[:2])
    first, both = stride, 2 * stride
    bend = centre[:, both:] - 2 * centre[:, first:-first] + centre[:, :-both]
    off[:, both:] = np.nan_to_num(np.linalg.norm(bend, axis=-1))
    step = np.linalg.norm(centre[:, first:] - centre[:, :-first], axis=-1)
    # After a gap there is no course yet: then the limit is twice as far, from the last place.
    alone = np.isfinite(step[:, first:]) & ~np.isfinite(bend[..., 0])
    off[:, both:] = np.where(alone, step[:, first:] / 2, off[:, both:])
    return off


def _smoothed(centre: NDArray, run: NDArray, stride: int) -> NDArray:
    """Return the symmetric mean over neighbouring frames of one unbroken run."""
    total, count = centre.copy(), np.ones(run.shape)
    for shift in range(stride, SMOOTHING * stride + 1, stride):
        whole = np.zeros(run.shape, dtype=bool)
        middle = slice(shift, -shift)
        whole[:, middle] = (run[:, : -2 * shift] == run[:, 2 * shift :]) & (run[:, middle] >= 0)
        whole[:, middle] &= run[:, middle] == run[:, 2 * shift :]
        pair = np.zeros_like(centre)
        pair[:, middle] = np.nan_to_num(centre[:, : -2 * shift] + centre[:, 2 * shift :])
        total += np.where(whole[..., None], pair, 0.0)
        count += 2 * whole
    return total / count[..., None]


def _close_to_another(centre: NDArray, typical: NDArray, around: int) -> NDArray:
    """Return (P, T) bool: another row is close, or was or will be at most `around` frames away."""
    close = np.zeros(centre.shape[:2], dtype=bool)
    for one in range(len(centre)):
        for other in range(one + 1, len(centre)):
            apart = np.linalg.norm(centre[one] - centre[other], axis=-1)
            near = np.nan_to_num(apart, nan=np.inf) < CLOSE * max(typical[one], typical[other])
            close[one] |= near
            close[other] |= near
    wide = close.copy()
    for shift in range(1, around + 1):
        wide[:, shift:] |= close[:, :-shift]
        wide[:, :-shift] |= close[:, shift:]
    return wide
