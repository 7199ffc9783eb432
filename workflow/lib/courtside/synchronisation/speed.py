"""Loss of clock offsets without calibration: joints are fast at the same times in all views."""

from collections.abc import Collection, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from courtside.synchronisation import smooth_tracks

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
SCAN_TIMES = 450  # times of a camera that are compared at every offset: costs grow with it
SCAN_STEP_S = 1 / 30
CLIP = 3.0  # speeds are limited to this many times their median


class Speeds:
    """Loss of pairs of cameras from products of the speeds of all joints, persons summed.

    Tracks are in px, one per camera, all smoothed with one kernel.
    """

    scan_step_s, scan_times = SCAN_STEP_S, SCAN_TIMES

    def __init__(self, tracks: Sequence[smooth_tracks.Track]) -> None:
        self.tracks = [_features(track) for track in tracks]
        self.pairs: list[tuple[int, int]] = []

    def scan(self, a: int, b: int, lags_s: NDArray, most: int = SCAN_TIMES) -> NDArray:
        """Return the loss (N, L) of camera b against a, at N times of one, by the offset of b.

        Offsets `lags_s` are (L,), or (N, L) if they differ from time to time.
        """
        at, swapped = smooth_tracks.compared(self.tracks[a], self.tracks[b], most)
        a, b, lags_s = (b, a, -lags_s) if swapped else (a, b, lags_s)
        track_a, track_b = self.tracks[a], self.tracks[b]
        first = track_a.values[0].reshape(track_a.values.shape[1], -1)
        index, inside = smooth_tracks.counterparts(track_a, at, track_b, lags_s)
        second = track_b.values[0].reshape(track_b.values.shape[1], -1)
        seen_a = np.isfinite(first).any(axis=1)[at]
        seen_b = np.isfinite(second).any(axis=1)
        first, second = np.nan_to_num(first[at]), np.nan_to_num(second)
        product = _products(first, second, np.where(inside, index, -1))
        known = inside & seen_a[:, None] & seen_b[np.where(inside, index, 0)]
        return np.where(known, -product / first.shape[1], np.nan)

    def match(self, own: NDArray, used: Collection[int]) -> list[tuple[int, int]]:
        """Return all pairs of the cameras `used`: the speeds of all persons are summed."""
        self.pairs = list(combinations(sorted(used), 2))
        return self.pairs

    def terms(self, own: NDArray) -> dict[tuple[int, int], tuple[NDArray, ...]]:
        """Return the terms of each pair for `clock_adjustment.adjust`."""
        sampled = [
            [np.nan_to_num(part[0]) for part in smooth_tracks.sample(track, time_s)]
            for track, time_s in zip(self.tracks, own, strict=True)
        ]
        return {
            (a, b): tuple(
                part.sum(axis=(1, 2))
                for part in smooth_tracks.product_terms(sampled[a], sampled[b])
            )
            for a, b in self.pairs
        }


def _products(first: NDArray, second: NDArray, index: NDArray) -> NDArray:
    """Return the products (N, L) of first (N, K) with the rows `index` of second (T, K)."""
    result = np.zeros(index.shape)
    for row, (values, places) in enumerate(zip(first, index, strict=True)):
        asked = places[places >= 0]
        if len(asked):
            low = asked.min()
            piece = second[low : asked.max() + 1] @ values
            result[row] = piece[np.maximum(places - low, 0)]
    return result


def _features(track: smooth_tracks.Track) -> smooth_tracks.Track:
    """Return a track (1, T, J, 2) of vertical and total speed per person's size, persons summed.

    Downward speeds are negative; the total speed has its mean removed. Both change little when a
    camera stands elsewhere on the floor, the vertical speed hardly at all.
    """
    values = track.values
    velocity = (values[:, 2:] - values[:, :-2]) / (2 * track.step_s)
    velocity = np.pad(velocity, ((0, 0), (1, 1), (0, 0), (0, 0)), constant_values=np.nan)
    velocity /= _size(values)
    speed = np.linalg.norm(velocity, axis=-1)
    speed -= np.nanmean(speed, axis=1, keepdims=True) if np.isfinite(speed).any() else 0.0
    features = np.stack([velocity[..., 1], speed], axis=-1)
    known = np.isfinite(features).all(axis=-1).any(axis=(0, 2))
    usual = np.nanmedian(np.abs(features), axis=(0, 1, 2)) + 1e-9 if known.any() else 1.0
    squeezed = np.tanh(features / (CLIP * usual))
    summed = np.nansum(squeezed, axis=0, keepdims=True)
    summed[:, ~known] = np.nan
    return smooth_tracks.Track(track.start_s, track.step_s, summed)


def _size(values: NDArray) -> NDArray:
    """Return the spread of each person's joints, (P, T, 1, 1) px, the median over the take."""
    centre = np.nanmedian(values, axis=2, keepdims=True)
    spread = np.nanmedian(np.linalg.norm(values - centre, axis=-1), axis=(1, 2))
    return np.maximum(spread, 1.0)[:, None, None, None]
