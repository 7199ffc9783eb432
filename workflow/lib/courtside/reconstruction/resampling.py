"""Resampling of keypoints from cameras with their own clocks to common, uniform times."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import interpolation
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.video.glance import longest_step_s

# Frame times closer than this share of a frame are equal: rounding of containers' clocks.
RATE_TOLERANCE = 1e-3
# Beside a step so many times as long as its neighbour, the cubic would take the noise of two frames
# close together for a speed: at 3 times it adds half a standard deviation.
MOST_UNEVEN = 3.0


def common_times(views: Sequence[Keypoints2D], clocks: Sequence[Clock]) -> NDArray:
    """Return uniform times (T,) of a take on the reference clock.

    They have the frame interval of the first camera and cover the span that at least two
    cameras share; there are none if no two share any time.
    """
    on_reference = [c.to_reference(v.time_s) for c, v in zip(clocks, views, strict=True)]
    spans = [(time_s[0], time_s[-1]) for time_s in on_reference]
    enough = min(2, len(views))

    def shared(time_s: float) -> bool:
        return sum(first <= time_s <= last for first, last in spans) >= enough

    if not any(shared(first) for first, _ in spans):
        return np.empty(0)
    start = min(first for first, _ in spans if shared(first))
    stop = max(last for _, last in spans if shared(last))
    step_s = interpolation.frame_step_s(on_reference[0])
    return start + step_s * np.arange(int(np.floor((stop - start) / step_s + RATE_TOLERANCE)) + 1)


def resample(view: Keypoints2D, time_s: NDArray, clock: Clock) -> tuple[NDArray, NDArray]:
    """Return one camera's xy (P, T, J, 2) and score (P, T, J) at times (T,) of the reference clock.

    They are NaN where a neighbouring frame is missing: gaps are not bridged (`longest_step_s`). The
    score is the lower one. The interpolant is a cubic through the two frames before and the two
    after (Catmull & Rom 1974), a line where the outer ones are missing: at 30 frames per second the
    line alone is 3 cm off at the turning point of a wrist with 200 m/s2.
    """
    own, known = clock.from_reference(time_s), view.time_s
    step_s = float(np.median(np.diff(known))) if len(known) > 1 else 1.0
    longest_s = longest_step_s(step_s)
    left = np.clip(np.searchsorted(known, own, side="right") - 1, 0, len(known) - 1)
    right = np.minimum(left + 1, len(known) - 1)
    span = known[right] - known[left]
    share = np.where(span > 0, (own - known[left]) / np.where(span > 0, span, 1.0), 0.0)
    on_left = np.abs(own - known[left]) <= RATE_TOLERANCE * step_s
    on_right = np.abs(own - known[right]) <= RATE_TOLERANCE * step_s
    left = np.where(on_right, right, left)
    exact = on_left | on_right
    right = np.where(exact, left, right)
    unknown = (own < known[0]) | (own > known[-1]) | (span > longest_s)
    share = np.where(exact, 0.0, np.where(unknown, np.nan, share))
    xy = np.empty((len(view.xy), len(own), *view.xy.shape[2:]))
    for at in keypoints.blocks(len(own)):
        xy[:, at] = _cubic(view.xy, known, left[at], right[at], share[at], longest_s)
    score = np.minimum(view.score[:, left], view.score[:, right])
    return xy, np.where(np.isfinite(xy).all(axis=-1), score, np.nan)


def resample_all(
    views: Sequence[Keypoints2D], clocks: Sequence[Clock], time_s: NDArray
) -> tuple[NDArray, NDArray]:
    """Return all cameras' xy (C, P, T, J, 2) and score (C, P, T, J), each as by `resample`."""
    persons, joints = views[0].score.shape[::2]
    xy, scores = np.empty((len(views), persons, len(time_s), joints, 2)), []
    for of_camera, view, clock in zip(xy, views, clocks, strict=True):
        of_camera[:], score = resample(view, time_s, clock)
        scores.append(score)
    return xy, np.stack(scores)


def nearest(view: Keypoints2D, time_s: NDArray, clock: Clock) -> NDArray:
    """Return a camera's frames (T,) nearest to times (T,) of the reference clock."""
    return interpolation.nearest(view.time_s, clock.from_reference(time_s), "left")


def _cubic(values, known, left, right, share, longest_s) -> NDArray:
    """Return values (P, T, J, 2) between frames, linear where the cubic lacks a frame."""
    share = share[:, None, None]
    before, after = values[:, left], values[:, right]
    straight = before + share * (after - before)
    outer_left, outer_right = np.maximum(left - 1, 0), np.minimum(right + 1, len(known) - 1)
    whole = (outer_left < left) & (outer_right > right)
    step, step_left = known[right] - known[left], known[left] - known[outer_left]
    step_right = known[outer_right] - known[right]
    whole &= (step_left <= longest_s) & (step_right <= longest_s)
    whole &= step <= (MOST_UNEVEN + RATE_TOLERANCE) * np.minimum(step_left, step_right)
    first = _at_even_steps(values[:, outer_left], before, after, step_left, step)
    last = _at_even_steps(values[:, outer_right], after, before, step_right, step)
    bent = interpolation.cubic_bend(first, before, after, last, share)
    fine = np.isfinite(bent) & whole[:, None, None]
    return straight + np.where(fine & (left != right)[:, None, None], bent, 0.0)


def _at_even_steps(outer, inner, other, step_outer, step) -> NDArray:
    """Return `outer` as far from `inner` as `other` is, by the parabola through the three.

    A camera may have changed its rate there, or dropped a frame.
    """
    uneven = (np.abs(step_outer - step) > RATE_TOLERANCE * step) & (step_outer > 0) & (step > 0)
    ratio = np.where(uneven, step / np.where(uneven, step_outer, 1.0), 1.0)[:, None, None]
    slope = ((inner - outer) * ratio + (other - inner) / ratio) * ratio / (1 + ratio)
    return np.where(uneven[:, None, None], other - 2 * slope, outer)
