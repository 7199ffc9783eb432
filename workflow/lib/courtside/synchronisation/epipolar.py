"""Loss of clock offsets with calibrated cameras: joints at one time lie on epipolar lines."""

from collections.abc import Collection, Sequence
from itertools import combinations, permutations

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.geometry import epipolar
from courtside.geometry.camera import Camera
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA
from courtside.synchronisation import smooth_tracks

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
SCAN_TIMES = 120  # times of a camera that are compared at every offset: costs grow with it
SCAN_STEP_S = 1 / 15
SCALE_OF_PERSON = 0.2  # an error of this share of the joints' spread has half the full loss
CLIP = 3.0  # errors are cut off at this many such shares before their slow part is removed
FINER = 0.5  # scale of the remaining errors, relative to the first scale
LARGEST_MATCH = 0.55  # mean loss up to which two tracklets may show one person
BLOCK_S = 20.0  # tracklets are matched anew in each: a row of a long take shows one after another
FADE = 4.0  # standard deviations at which an error has a quarter of its weight
# The same for clocks as the scan leaves them: weights by `FADE` hide errors of many milliseconds.
# On takes of `players-dev` and `cross-dev` 10 and 20 serve alike.
FIRST_FADE = 20.0
SMALLEST_PX = 0.3  # no network is more precise
WINDOW_S = 3.0  # slower errors are the network's, not the clock's

PROBE_S = 2e-3  # step of numerical derivatives: small against a frame

# Value, velocity and acceleration of a track, (T, J, 2) each.
Sample = tuple[NDArray, NDArray, NDArray]


class Epipolar:
    """Loss of pairs of cameras from the epipolar distances of all joints.

    Tracks are straight px of `epipolar.straight_px`, one per camera, all smoothed with one kernel.
    """

    scan_step_s, scan_times = SCAN_STEP_S, SCAN_TIMES

    def __init__(self, cameras: Sequence[Camera], tracks: Sequence[smooth_tracks.Track]) -> None:
        self.tracks = tracks
        self.matrix = {
            (a, b): epipolar.fundamental(cameras[a], cameras[b])
            for a, b in permutations(range(len(cameras)), 2)
        }
        self.scale_px = [SCALE_OF_PERSON * _spread_px(track.values) for track in tracks]
        # Of pairs of cameras: pairs of rows that show one person in a block of times.
        self.matches: dict[tuple[int, int], list[tuple[int, int, slice]]] = {}

    def scan(self, a: int, b: int, lags_s: NDArray, most: int = SCAN_TIMES) -> NDArray:
        """Return the loss (N, L) of camera b against a, at N times of one, by the offset of b.

        Offsets `lags_s` are (L,), or (N, L) if they differ from time to time.
        """
        at, swapped = smooth_tracks.compared(self.tracks[a], self.tracks[b], most)
        a, b, lags_s = (b, a, -lags_s) if swapped else (a, b, lags_s)
        track_a, track_b = self.tracks[a], self.tracks[b]
        every = at[1] - at[0] if len(at) > 1 else 1
        lines = epipolar.lines(self.matrix[a, b], track_a.values[:, at]).astype(np.float32)
        index, inside = smooth_tracks.counterparts(track_a, at, track_b, lags_s)
        index = np.where(inside, index, 0)
        window = max(3, round(WINDOW_S / (every * track_a.step_s)))
        losses = np.stack(
            [self._of_persons(line, track_b.values, index, b, window) for line in lines]
        )
        # Each person of the camera with fewer persons gets the best match of the other camera.
        more = int(losses.shape[0] <= losses.shape[1])
        loss = np.nanmean(np.fmin.reduce(losses, axis=more), axis=0)
        return np.where(inside, loss, np.nan)

    def _of_persons(self, line, values, index, b, window) -> NDArray:
        """Return the loss (Q, N, L) of one tracklet's lines (N, J, 3) against each person of b."""
        found = []
        for person in values.astype(np.float32):
            xy = person[index]
            distance = line[:, None, :, 0] * xy[..., 0] + line[:, None, :, 1] * xy[..., 1]
            distance += line[:, None, :, 2]
            found.append(self._two_losses(distance, self.scale_px[b], window))
        return np.stack(found)

    def _two_losses(self, distance: NDArray, scale_px: float, window: int) -> NDArray:
        """Return the mean loss of errors (N, L, J), with and without their slow part."""
        limit = CLIP * scale_px
        known = np.isfinite(distance)
        clipped = np.where(known, np.clip(distance, -limit, limit), 0)
        left = clipped - _slow(clipped, known.astype(np.float32), window)
        left = np.where(known, left, np.nan)
        return (_mean_loss(distance, scale_px) + _mean_loss(left, FINER * scale_px)) / 2

    def match(self, own: NDArray, used: Collection[int]) -> list[tuple[int, int]]:
        """Match the tracklets of pairs of cameras that show one person, block by block.

        `own` (C, T) is what each clock shows, to the step of the scan; `used` are the cameras to
        compare. Return the pairs of cameras that share at least one person.
        """
        self.matches = {}
        sampled = self._sample(own)
        for block in _blocks(own[0]):
            for a, b in combinations(sorted(used), 2):
                loss = np.array(
                    [[self._between(a, b, x[0][block], y[0][block]) for y in sampled[b]]
                     for x in sampled[a]]
                )  # fmt: skip
                loss = np.where(np.isfinite(loss), loss, 1.0)
                best = (loss == loss.min(axis=0)) | (loss == loss.min(axis=1, keepdims=True))
                for p, q in np.argwhere(best & (loss <= LARGEST_MATCH)).tolist():
                    self.matches.setdefault((a, b), []).append((p, q, block))
        return list(self.matches)

    def _between(self, a: int, b: int, xy_a: NDArray, xy_b: NDArray) -> float:
        distance = epipolar.distance_px(self.matrix[a, b], xy_a, xy_b)
        scale = min(self.scale_px[a], self.scale_px[b])
        loss = _mean_loss(distance, scale)
        return np.nanmean(loss) if np.isfinite(loss).any() else np.nan

    def terms(self, own: NDArray, fade: float = FADE) -> dict[tuple[int, int], tuple[NDArray, ...]]:
        """Return the terms of each pair for `clock_adjustment.adjust`."""
        sampled = self._sample(own)
        result = {pair: np.zeros((3, own.shape[1])) for pair in self.matches}
        for pair, matches in self.matches.items():
            for *rows, block in matches:
                first, second = (
                    tuple(part[block] for part in sampled[camera][row])
                    for camera, row in zip(pair, rows, strict=True)
                )
                result[pair][:, block] += self._of(pair, first, second, own[:, block], fade)
        return {pair: tuple(found) for pair, found in result.items()}

    def _sample(self, own: NDArray) -> list[list[Sample]]:
        """Return per camera the tracklets as (value, velocity, acceleration), (T, J, 2) each."""
        return [
            list(zip(*smooth_tracks.sample(track, time_s), strict=True))
            for track, time_s in zip(self.tracks, own, strict=True)
        ]

    def _of(self, pair, first, second, own, fade) -> NDArray:
        miss, slope, bend = self._derivatives(pair, first, second)
        known = np.isfinite(miss) & np.isfinite(slope) & np.isfinite(bend)
        miss, slope, bend = (np.where(known, part, 0.0) for part in (miss, slope, bend))
        window = max(3, round(WINDOW_S / (own[0, 1] - own[0, 0])))
        weight = known.astype(float)
        for _ in range(3):
            left = miss - _slow(miss, weight, window)
            sigma_px = MEDIAN_TO_SIGMA * np.median(np.abs(left[known])) if known.any() else 1.0
            sigma_px = max(sigma_px, SMALLEST_PX)
            share = (left / (fade * sigma_px)) ** 2
            weight = known / (1 + share) ** 2
        slope, bend = (part - _slow(part, weight, window) for part in (slope, bend))
        steep = weight * slope**2
        curvature = steep * (1 - 3 * share) / (1 + share) + weight * left * bend
        series = (weight * left * slope, curvature, steep)
        return np.stack([part.sum(axis=1) for part in series]) / sigma_px**2

    def _derivatives(self, pair, first, second) -> tuple[NDArray, NDArray, NDArray]:
        """Return the error (T, J) and its derivatives by the offset of the second camera."""
        misses = []
        for half in (-PROBE_S / 2, 0.0, PROBE_S / 2):
            xy_a, xy_b = (
                value + sign * half * velocity + half**2 / 2 * acceleration
                for sign, (value, velocity, acceleration) in ((-1, first), (1, second))
            )
            misses.append(epipolar.distance_px(self.matrix[pair], xy_a, xy_b))
        before, here, after = misses
        return here, (after - before) / (2 * PROBE_S), (after - 2 * here + before) / PROBE_S**2


def _blocks(time_s: NDArray) -> list[slice]:
    """Return slices of uniform times (T,), of about `BLOCK_S` each."""
    count = max(1, round((time_s[-1] - time_s[0]) / BLOCK_S))
    ends = np.linspace(0, len(time_s), count + 1).astype(int).tolist()
    return list(map(slice, ends[:-1], ends[1:]))


def _spread_px(values: NDArray) -> float:
    """Return the median spread of a person's joints in the picture, px; of tracks (P, T, J, 2)."""
    seen = np.isfinite(values).all(axis=-1)
    usual = values[seen.mean(axis=-1) > 0.5]
    if not len(usual):
        return 1.0
    return max(1.0, float(np.median(np.linalg.norm(np.nanstd(usual, axis=1), axis=-1))))


def _mean_loss(distance: NDArray, scale_px: float) -> NDArray:
    """Return the mean over joints (last axis) of a loss from 0 to 1; NaN without half of them."""
    square = (distance / scale_px) ** 2
    loss = square / (1 + square)
    known = np.isfinite(loss)
    count = known.sum(axis=-1)
    total = np.where(known, loss, 0).sum(axis=-1)
    return np.where(count >= max(1, loss.shape[-1] // 2), total / np.maximum(count, 1), np.nan)


def _slow(values: NDArray, weight: NDArray, window: int) -> NDArray:
    """Return the weighted running mean over time of values (T, J)."""
    blur = {"size": window, "axis": 0, "mode": "constant"}
    total = scipy.ndimage.uniform_filter1d(weight * values, **blur)
    return total / np.maximum(scipy.ndimage.uniform_filter1d(weight, **blur), 1e-9)
