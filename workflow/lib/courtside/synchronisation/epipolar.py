"""What calibrated cameras say about their clocks: the pixels of one moment lie on epipolar lines."""

from itertools import combinations, permutations

import numpy as np
from scipy import ndimage

from courtside.geometry import epipolar
from courtside.synchronisation import smooth_tracks

SCAN_TIMES = 120  # moments of a camera that are compared at every offset
SCAN_STEP_S = 1 / 15
SCALE_OF_PERSON = 0.2  # a miss of this share of the joints' spread counts half
CLIP = 3.0  # misses count up to so many such shares where their slow part is taken off
FINER = 0.5  # what is left then is measured on a scale this much finer
LARGEST_MATCH = 0.55  # mean loss up to which two tracklets may show one person
FADE = 4.0  # standard deviations at which a miss has a quarter of its weight
SMALLEST_PX = 0.3  # ASSUME: no network is better
WINDOW_S = 3.0  # misses that last longer are the network's, not the clock's
NOISE_OF_MAD = 1.4826
PROBE_S = 2e-3  # the step of numerical derivatives


class Epipolar:
    """Loss of pairs of cameras from the epipolar distances of all joints.

    Parameters
    ----------
    cameras : list of Camera, length C
    tracks : list of Track, length C
        Straight px of `epipolar.straight_px`, smoothed alike.
    """

    scan_step_s = SCAN_STEP_S

    def __init__(self, cameras, tracks):
        self.tracks = tracks
        self.matrix = {
            (a, b): epipolar.fundamental(cameras[a], cameras[b])
            for a, b in permutations(range(len(cameras)), 2)
        }
        self.scale_px = [SCALE_OF_PERSON * spread_px(track.values) for track in tracks]
        self.count = len(tracks)
        self.matches = {}

    def scan(self, a, b, lags_s):
        """Return the loss (N, L) of camera b against a at N times of a, for offsets of b against a."""
        track_a, track_b = self.tracks[a], self.tracks[b]
        every = max(1, track_a.values.shape[1] // SCAN_TIMES)
        at = np.arange(0, track_a.values.shape[1], every)
        lines = epipolar.lines(self.matrix[a, b], track_a.values[:, at]).astype(np.float32)
        own_b = track_a.start_s + track_a.step_s * at[:, None] + lags_s
        index = np.rint((own_b - track_b.start_s) / track_b.step_s).astype(int)
        inside = (index >= 0) & (index < track_b.values.shape[1])
        index = np.where(inside, index, 0)
        window = max(3, round(WINDOW_S / (every * track_a.step_s)))
        losses = np.stack(
            [self._of_persons(line, track_b.values, index, b, window) for line in lines]
        )
        # Every person of the camera that sees fewer has the one of the other camera who fits best.
        more = int(losses.shape[0] <= losses.shape[1])
        loss = np.nanmean(np.fmin.reduce(losses, axis=more), axis=0)
        return np.where(inside, loss, np.nan)

    def _of_persons(self, line, values, index, b, window):
        """Return the loss (Q, N, L) of one tracklet's lines (N, J, 3) against each person of camera b."""
        found = []
        for person in values.astype(np.float32):
            xy = person[index]
            distance = line[:, None, :, 0] * xy[..., 0] + line[:, None, :, 1] * xy[..., 1]
            distance += line[:, None, :, 2]
            found.append(self._two_losses(distance, self.scale_px[b], window))
        return np.stack(found)

    def _two_losses(self, distance, scale_px, window):
        """Return the mean loss of misses (N, L, J), and of what is left without their slow part."""
        limit = CLIP * scale_px
        known = np.isfinite(distance)
        clipped = np.where(known, np.clip(distance, -limit, limit), 0)
        left = clipped - _slow(clipped, known.astype(np.float32), window)
        left = np.where(known, left, np.nan)
        return (_mean_loss(distance, scale_px) + _mean_loss(left, FINER * scale_px)) / 2

    def match(self, own, used):
        """Find which tracklets of pairs of cameras show one person.

        Parameters
        ----------
        own : (C, T) float
            What each clock shows, to the step of the scan.
        used : list of int
            The cameras to compare.

        Returns
        -------
        pairs : list of (int, int)
            Of cameras that see one person at least together.
        """
        self.matches = {}
        sampled = self._sample(own)
        for a, b in combinations(sorted(used), 2):
            loss = np.array(
                [[self._between(a, b, x[0], y[0]) for y in sampled[b]] for x in sampled[a]]
            )
            loss = np.where(np.isfinite(loss), loss, 1.0)
            best = (loss == loss.min(axis=0)) | (loss == loss.min(axis=1, keepdims=True))
            found = [tuple(at) for at in np.argwhere(best & (loss <= LARGEST_MATCH)).tolist()]
            if found:
                self.matches[a, b] = found
        return list(self.matches)

    def _between(self, a, b, xy_a, xy_b):
        distance = epipolar.distance_px(self.matrix[a, b], xy_a, xy_b)
        scale = min(self.scale_px[a], self.scale_px[b])
        loss = _mean_loss(distance, scale)
        return np.nanmean(loss) if np.isfinite(loss).any() else np.nan

    def terms(self, own):
        """Return what each pair says, as `clock_adjustment.adjust` asks for."""
        sampled = self._sample(own)
        result = {}
        for pair, matches in self.matches.items():
            for p, q in matches:
                result.setdefault(pair, []).append(self._of(pair, sampled, p, q, own))
        return {pair: tuple(np.sum(parts, axis=0)) for pair, parts in result.items()}

    def _sample(self, own):
        """Return per camera the tracklets as (value, velocity, acceleration), (T, J, 2) each."""
        return [
            list(zip(*smooth_tracks.sample(track, time_s), strict=True))
            for track, time_s in zip(self.tracks, own, strict=True)
        ]

    def _of(self, pair, sampled, p, q, own):
        miss, slope, bend = self._derivatives(pair, sampled[pair[0]][p], sampled[pair[1]][q])
        known = np.isfinite(miss) & np.isfinite(slope) & np.isfinite(bend)
        miss, slope, bend = (np.where(known, part, 0.0) for part in (miss, slope, bend))
        window = max(3, round(WINDOW_S / (own[0, 1] - own[0, 0])))
        weight = known.astype(float)
        for _ in range(3):
            left = miss - _slow(miss, weight, window)
            sigma_px = NOISE_OF_MAD * np.median(np.abs(left[known])) if known.any() else 1.0
            sigma_px = max(sigma_px, SMALLEST_PX)
            share = (left / (FADE * sigma_px)) ** 2
            weight = known / (1 + share) ** 2
        slope, bend = (part - _slow(part, weight, window) for part in (slope, bend))
        steep = weight * slope**2
        curvature = steep * (1 - 3 * share) / (1 + share) + weight * left * bend
        series = (weight * left * slope, curvature, steep)
        return np.stack([part.sum(axis=1) for part in series]) / sigma_px**2

    def _derivatives(self, pair, first, second):
        """Return the miss (T, J) and its derivatives by the offset of the second camera."""
        misses = []
        for half in (-PROBE_S / 2, 0.0, PROBE_S / 2):
            xy_a, xy_b = (
                value + sign * half * velocity + half**2 / 2 * acceleration
                for sign, (value, velocity, acceleration) in ((-1, first), (1, second))
            )
            misses.append(epipolar.distance_px(self.matrix[pair], xy_a, xy_b))
        before, here, after = misses
        return here, (after - before) / (2 * PROBE_S), (after - 2 * here + before) / PROBE_S**2


def spread_px(values):
    """Return the median spread of a person's joints in the picture, px; of tracks (P, T, J, 2)."""
    seen = np.isfinite(values).all(axis=-1)
    usual = values[seen.mean(axis=-1) > 0.5]
    if not len(usual):
        return 1.0
    return max(1.0, float(np.median(np.linalg.norm(np.nanstd(usual, axis=1), axis=-1))))


def _mean_loss(distance, scale_px):
    """Return the mean over joints, the last axis, of a loss from 0 to 1; NaN without half of them."""
    square = (distance / scale_px) ** 2
    loss = square / (1 + square)
    known = np.isfinite(loss)
    count = known.sum(axis=-1)
    total = np.where(known, loss, 0).sum(axis=-1)
    return np.where(count >= max(1, loss.shape[-1] // 2), total / np.maximum(count, 1), np.nan)


def _slow(values, weight, window):
    """Return the weighted running mean over time of values (T, J)."""
    blur = {"size": window, "axis": 0, "mode": "constant"}
    total = ndimage.uniform_filter1d(weight * values, **blur)
    return total / np.maximum(ndimage.uniform_filter1d(weight, **blur), 1e-9)
