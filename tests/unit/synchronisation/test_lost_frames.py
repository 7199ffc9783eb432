"""Frames that a video lost are told; whole takes are not doubted."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.synchronisation import cameras
from fixtures.cameras import sync_takes

RIG = sync_takes.rig(3)
SECONDS, RATE_HZ = 24.0, 30


def views(seed):
    rng = np.random.default_rng(seed)
    person = sync_takes.athlete(rng, SECONDS)
    own_s = np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ
    return [
        sync_takes.seen(rng, camera, [person], own_s, cameras.Clock(offset_s=0.7 * at))
        for at, camera in enumerate(RIG)
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


@pytest.mark.parametrize("seed", range(3))
def test_whole_takes_are_not_doubted(seed):
    for known in (RIG, None):
        found = cameras.synchronise(views(seed), known)
        assert [clock.doubt for clock in found.values()] == ["", "", ""]
