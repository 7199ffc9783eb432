"""Epipolar loss of clocks: least at the truth, derivatives against differences, matches."""

import numpy as np
import pytest

from courtside.geometry import epipolar
from courtside.records.devices.clocks import Clock
from courtside.synchronisation import smooth_tracks
from courtside.synchronisation.epipolar import Epipolar
from fixtures.cameras import sync_takes

CAMERAS = sync_takes.rig(3)
OWN_S = np.arange(300) / 30
TIME_S = OWN_S[30:-30]


def evidence(people_of_each, offsets_s=(0.0, 0.4, -0.6), **errors):
    rng = np.random.default_rng(0)
    tracks = []
    for camera, people, offset_s in zip(CAMERAS, people_of_each, offsets_s, strict=True):
        view = sync_takes.seen(rng, camera, people, OWN_S, Clock(offset_s), faults=False, **errors)
        xy = epipolar.straight_px(camera, view.xy)
        tracks.append(smooth_tracks.build(OWN_S, xy, 0.85 / 30))
    return Epipolar(CAMERAS, tracks)


@pytest.fixture(scope="module")
def people():
    rng = np.random.default_rng(1)
    return [sync_takes.athlete(rng, 10.0) for _ in range(2)]


def own(*offsets_s):
    return TIME_S + np.array(offsets_s)[:, np.newaxis]


def test_the_scan_is_lowest_at_the_truth(people):
    found = evidence([people[:1]] * 3)
    lags_s = np.arange(-30, 31) / 15
    for (a, b), truth_s in {(0, 1): 0.4, (0, 2): -0.6, (1, 2): -1.0}.items():
        loss = np.nanmean(found.scan(a, b, lags_s), axis=0)
        assert abs(lags_s[np.argmin(loss)] - truth_s) <= 1 / 15


def test_persons_are_matched_whatever_their_order_and_number(people):
    found = evidence([people, people[::-1], people[1:]])
    assert sorted(found.match(own(0, 0.4, -0.6), [0, 1, 2])) == [(0, 1), (0, 2), (1, 2)]
    whole = slice(0, len(TIME_S))  # a short take is one block
    assert sorted(found.matches[0, 1]) == [(0, 1, whole), (1, 0, whole)]
    assert found.matches[0, 2] == [(1, 0, whole)]
    assert found.matches[1, 2] == [(0, 0, whole)]


def test_strangers_are_not_matched(people):
    found = evidence([people[:1], people[1:], people[:1]])
    assert found.match(own(0, 0.4, -0.6), [0, 1, 2]) == [(0, 2)]


def test_without_noise_the_slope_is_zero_at_the_truth_and_points_back_elsewhere(people):
    found = evidence([people[:1]] * 3, noise_px=0.0, bias_px=0.0)
    found.match(own(0, 0.4, -0.6), [0, 1, 2])
    slope, curvature, steep = (part.sum() for part in found.terms(own(0, 0.4, -0.6))[0, 1])
    assert abs(slope / curvature) < 1e-4  # a tenth of a millisecond
    assert curvature == pytest.approx(steep, rel=0.05)
    late, early = (found.terms(own(0, at, -0.6))[0, 1][0].sum() for at in (0.405, 0.395))
    assert late > 0 > early


def test_the_curvature_is_the_change_of_the_slope(people):
    found = evidence([people[:1]] * 3)
    found.match(own(0, 0.4, -0.6), [0, 1, 2])
    before, after = (found.terms(own(0, 0.4 + d, -0.6))[0, 1][0].sum() for d in (-1e-3, 1e-3))
    stated = found.terms(own(0, 0.4, -0.6))[0, 1][1].sum()
    assert (after - before) / 2e-3 == pytest.approx(stated, rel=0.1)


def test_a_bias_that_stays_does_not_shift_the_clock(people):
    found = evidence([people[:1]] * 3, noise_px=0.0, bias_px=0.0)
    first = found.tracks[1]
    moved = first.values + np.array([3.0, -5.0])
    found.tracks[1] = smooth_tracks.Track(first.start_s, first.step_s, moved)
    found.match(own(0, 0.4, -0.6), [0, 1, 2])
    slope, curvature, _ = (part.sum() for part in found.terms(own(0, 0.4, -0.6))[0, 1])
    assert abs(slope / curvature) < 1.5e-3
