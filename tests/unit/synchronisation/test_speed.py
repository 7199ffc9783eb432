"""Loss of clocks by joint speeds: least at the truth, slopes against differences."""

import numpy as np
import pytest

from courtside.records.devices.clocks import Clock
from courtside.synchronisation import smooth_tracks
from courtside.synchronisation.speed import Speeds
from fixtures.cameras import sync_takes

CAMERAS = sync_takes.rig(2)
OWN_S = np.arange(600) / 30
TIME_S = OWN_S[60:-60]


def evidence(people, offset_s=0.7, zoom=1.0):
    rng = np.random.default_rng(0)
    tracks = []
    for camera, at, size in zip(CAMERAS, (0.0, offset_s), (1.0, zoom), strict=True):
        view = sync_takes.seen(rng, camera, people, OWN_S, Clock(at))
        tracks.append(smooth_tracks.build(OWN_S, size * view.xy, 0.85 / 30))
    return Speeds(tracks)


@pytest.fixture(scope="module")
def person():
    return sync_takes.athlete(np.random.default_rng(1), 20.0)


@pytest.mark.parametrize("zoom", [1.0, 3.0])
def test_the_scan_is_lowest_at_the_truth_at_any_size(person, zoom):
    lags_s = np.arange(-90, 91) / 30
    loss = np.nanmean(evidence([person], zoom=zoom).scan(0, 1, lags_s), axis=0)
    assert abs(lags_s[np.argmin(loss)] - 0.7) <= 1.5 / 30


def test_the_scan_of_a_camera_that_shows_little_is_lowest_at_the_truth_too(person):
    found, lags_s = evidence([person]), np.arange(-90, 91) / 30
    found.tracks[1].values[:, : found.tracks[1].values.shape[1] * 2 // 3] = np.nan
    loss = np.nanmean(found.scan(0, 1, lags_s), axis=0)
    assert abs(lags_s[np.argmin(loss)] - 0.7) <= 1.5 / 30


def test_nothing_is_compared_where_a_camera_did_not_run(person):
    loss = evidence([person]).scan(0, 1, np.array([0.0, 5.0, 30.0]))
    known = np.isfinite(loss).mean(axis=0)
    assert known[0] > 0.95
    assert known[1] == pytest.approx(0.75, abs=0.05)
    assert known[2] == 0


def test_the_curvature_is_the_change_of_the_slope(person):
    found = evidence([person])
    assert found.match(None, [0, 1]) == [(0, 1)]

    def at(offset_s):
        return found.terms(np.stack([TIME_S, TIME_S + offset_s]))[0, 1]

    before, after = (at(0.7 + d)[0].sum() for d in (-2e-3, 2e-3))
    assert (after - before) / 4e-3 == pytest.approx(at(0.7)[1].sum(), rel=0.1)
    assert at(0.73)[0].sum() > 0 > at(0.67)[0].sum()


def test_the_slope_is_that_of_the_product(person):
    found = evidence([person])
    found.match(None, [0, 1])
    step_s = 1e-3

    def product(offset_s):
        values = [
            np.nan_to_num(smooth_tracks.sample(track, TIME_S + sign * offset_s / 2 + at)[0][0])
            for track, sign, at in zip(found.tracks, (-1, 1), (0.0, 0.7), strict=True)
        ]
        return -(values[0] * values[1]).sum()

    slope = found.terms(np.stack([TIME_S, TIME_S + 0.7]))[0, 1][0].sum()
    difference = (product(step_s) - product(-step_s)) / (2 * step_s)
    assert slope == pytest.approx(difference, rel=0.05, abs=1.0)
