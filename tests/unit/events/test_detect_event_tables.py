"""Tables of wrist distance, events and clocks say what was found, and raise nothing where nothing was."""

import numpy as np
import pytest

from courtside.events import detect
from courtside.records.devices.clocks import Clock
from courtside.synchronisation import devices as device_sync
from fixtures.recordings import device_takes

CLOCK = Clock(2.0, 50.0)


def devices():
    rng = np.random.default_rng(0)
    take = device_takes.truth(0)
    return take, [device_takes.device(rng, take), device_takes.mocopi(rng, take, clock=CLOCK)]


def test_events_are_on_the_reference_clock():
    take, motions = devices()
    rows = detect.events(motions, {"mocopi": CLOCK})
    for source in ("d415-rgb", "mocopi"):
        own = rows[(rows.source == source) & (rows.event == "clap")]
        assert own.number.tolist() == [1, 2]
        assert own.used.all()
        for number, at_s in zip(own.number, own.time_s, strict=True):
            assert at_s == pytest.approx(take[2][f"clap_{number}"], abs=0.006)
        spells = rows[(rows.source == source) & rows.event.str.startswith("tpose")]
        assert len(spells) == 4
    mocopi = rows[rows.source == "mocopi"]
    np.testing.assert_allclose(CLOCK.to_reference(mocopi.own_time_s), mocopi.time_s)
    assert list(rows.columns) == detect.EVENT_COLUMNS


def test_a_device_that_shows_nothing_has_a_row_that_says_so():
    still = device_takes.of(np.tile(devices()[1][0].xyz[:1], (90, 1, 1)), np.arange(90) / 30)
    (row,) = detect.events([still]).to_dict("records")
    assert row["event"] == "none" and not row["used"]
    assert "expected a T-pose" in row["why"]


def test_wrists_are_as_far_apart_as_they_are():
    take, motions = devices()
    motions[0].performed[:5] = False
    rows = detect.wrists(motions, {"mocopi": CLOCK})
    rgb = rows[rows.source == "d415-rgb"]
    assert rgb.distance_m.isna().sum() == 5
    times, xyz, _ = take
    left, right = (device_takes.JOINTS.index(f"{side}_wrist") for side in ("left", "right"))
    apart = np.linalg.norm(xyz[:, left] - xyz[:, right], axis=1)
    true = np.interp(rgb.time_s[5:], times, apart)
    np.testing.assert_allclose(rgb.distance_m[5:], true, atol=0.01)


def test_checks_have_a_row_per_source():
    _, motions = devices()
    happened = detect.shown(motions, device_takes.each_its_own(motions))
    found = device_sync.synchronise(motions, happened, latency={"mocopi": (0.02, 0.005)})
    rows = detect.checks(found).set_index("source")
    assert rows.status.to_dict() == {"d415-rgb": "reference", "mocopi": "found"}
    assert rows.n_claps["mocopi"] == 2
    assert rows.latency_s["mocopi"] == 0.02
    assert rows.offset_s["mocopi"] == found["mocopi"].clock.offset_s
