"""Frames that a video lost are told; whole takes are not doubted."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.synchronisation import cameras
from fixtures.cameras import sync_takes

RIG = sync_takes.rig(3)
SECONDS, RATE_HZ = 24.0, 30


def views(seed, *, seconds=SECONDS, rate_hz=RATE_HZ, drift_ppm=0.0, rig=RIG):
    """Return what cameras see; the clock of the second one drifts."""
    rng = np.random.default_rng(seed)
    person = sync_takes.athlete(rng, seconds)
    own_s = np.arange(round(seconds * rate_hz)) / rate_hz
    clocks = [cameras.Clock(0.7 * at, drift_ppm * (at == 1)) for at in range(len(rig))]
    return [
        sync_takes.seen(rng, camera, [person], own_s, clock)
        for camera, clock in zip(rig, clocks, strict=True)
    ]


def without(view, at_s, n):
    """Return a view that lacks n frames and does not know it: later ones have too early times."""
    kept = np.ones(len(view.time_s), bool)
    first = np.searchsorted(view.time_s, at_s)
    kept[first : first + n] = False
    parts = ("xy", "score", "reason", "xyz_in_body", "clothing")
    frames = {key: getattr(view, key)[:, kept] for key in parts}
    return replace(view, time_s=view.time_s[: kept.sum()], **frames)


@pytest.mark.parametrize(("camera", "at_s", "lag_ms"), [(1, 6.0, 200), (2, 18.0, -200)])
def test_lost_frames_of_one_camera_are_told(camera, at_s, lag_ms):
    shown = views(0)
    shown[camera] = without(shown[camera], at_s, 6)
    found = cameras.synchronise(shown, RIG)
    assert {name for name, clock in found.items() if clock.doubt} == {f"c{camera}"}
    said = found[f"c{camera}"].doubt
    start, stop = (0, 6) if at_s < SECONDS / 2 else (18, 24)
    assert f"from {start} to {stop} s of its video" in said and f"{lag_ms:+d} ms" in said


def test_frames_lost_near_the_end_of_a_long_take_are_told():
    shown = views(0, seconds=240.0, rate_hz=15)
    shown[1] = without(shown[1], 222.0, 3)
    found = cameras.synchronise(shown, RIG)
    assert {name for name, clock in found.items() if clock.doubt} == {"c1"}
    assert "-200 ms" in found["c1"].doubt


def test_lost_frames_of_several_cameras_are_told_of_each():
    rig = sync_takes.rig(4)
    shown = views(0, seconds=60.0, rig=rig)
    shown[1], shown[3] = without(shown[1], 20.0, 6), without(shown[3], 40.0, 9)
    found = cameras.synchronise(shown, rig)
    assert {name for name, clock in found.items() if clock.doubt} == {"c1", "c3"}


@pytest.mark.parametrize(
    ("count", "guilty", "n", "seed"), [(3, 0, 4, 0), (3, 0, 4, 1), (4, 3, 5, 0), (4, 0, 4, 0)]
)
def test_a_camera_is_not_doubted_for_the_frames_of_another(count, guilty, n, seed):
    """Few lost frames look like a drift, which the prior of all drifts spreads over all."""
    rig = sync_takes.rig(count)
    shown = views(seed, seconds=60.0, rig=rig)
    shown[guilty] = without(shown[guilty], 30.0, n)
    found = cameras.synchronise(shown, rig)
    assert [name for name, clock in found.items() if clock.doubt] == [f"c{guilty}"]


@pytest.mark.parametrize("guilty", [0, 1])
@pytest.mark.parametrize("n", [4, 6])
def test_of_two_cameras_that_disagree_both_are_named(guilty, n):
    rig = sync_takes.rig(2)
    shown = views(1, seconds=60.0, rig=rig)
    shown[guilty] = without(shown[guilty], 30.0, n)
    doubts = {name: clock.doubt for name, clock in cameras.synchronise(shown, rig).items()}
    said = " ".join(f"{name}: {doubt}" for name, doubt in doubts.items() if doubt)
    assert "c0" in said and "c1" in said


@pytest.mark.parametrize("seed", range(3))
def test_whole_takes_are_not_doubted(seed):
    for known in (RIG, None):
        found = cameras.synchronise(views(seed), known)
        assert [clock.doubt for clock in found.values()] == ["", "", ""]


@pytest.mark.parametrize("known", [RIG, None], ids=["calibrated", "uncalibrated"])
@pytest.mark.parametrize(
    ("seconds", "rate_hz", "drift_ppm", "wrong_rate"),
    [(240.0, 15, 1500.0, True), (900.0, 10, 330.0, False)],
)
def test_a_drift_is_not_taken_for_missing_frames(seconds, rate_hz, drift_ppm, wrong_rate, known):
    """It moves the parts at the ends by more than 0.1 s."""
    shown = views(0, seconds=seconds, rate_hz=rate_hz, drift_ppm=drift_ppm)
    found = cameras.synchronise(shown, known)
    assert found["c1"].drift_ppm == pytest.approx(drift_ppm, abs=50)
    said = [clock.doubt for clock in found.values()]
    assert not any("frames are probably missing" in line for line in said)
    told = "expected a drift of at most 400 ppm, found"
    assert [told in line for line in said] == [False, wrong_rate, False]
    assert "or states a wrong rate" in said[1] or not wrong_rate
