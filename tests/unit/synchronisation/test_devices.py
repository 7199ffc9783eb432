"""Clocks of virtual devices: offsets and drifts against those that the devices were given."""

import re
from dataclasses import replace

import numpy as np
import pytest

from courtside.events import detect
from courtside.records.devices.clocks import Clock
from courtside.records.devices.events import Clap
from courtside.study.errors import InputError
from courtside.synchronisation import devices
from courtside.synchronisation import devices as device_sync
from fixtures.recordings import device_takes

LONG = {"between_s": 46.0, "fine_hz": 120.0}
CAMERAS = {"source": "cameras", "kind": "cameras", "noise_m": (0.004,) * 3, "axes": np.eye(3)}


def shown(motions, owners):
    return detect.of_devices(detect.detect(motions), owners)


def solve(*motions, devices=None, known=None, latency=None, events_of=None):
    own = device_takes.each_its_own(motions)
    return device_sync.synchronise(
        list(motions),
        events_of or shown(motions, own),
        devices=own | (devices or {}),
        known=known or {},
        latency=latency or {},
    )


def worst_s(reference, found, true):
    ends = reference.time_s[[0, -1]]
    return np.abs(found.from_reference(ends) - true.from_reference(ends)).max()


@pytest.mark.parametrize("seed", range(2))
def test_a_minute_gives_offset_within_8_ms_and_drift(seed):
    take = device_takes.truth(0, **LONG)
    rng = np.random.default_rng(seed)
    reference = device_takes.device(rng, take, **CAMERAS)
    clocks = {"mocopi": Clock(2.4, 55.0), "d415-rgb": Clock(-1.7, -40.0)}
    mocopi = device_takes.mocopi(rng, take, clock=clocks["mocopi"], scale=1.05, turn=(0, 0.7, 0))
    rgb = device_takes.blazepose(
        rng, take, clock=clocks["d415-rgb"], noise_m=(0.006, 0.006, 0.03), turn=(0, 0.3, 0)
    )
    found = solve(reference, mocopi, rgb)
    assert found["cameras"].clock.status == "reference"
    for source, true in clocks.items():
        clock = found[source].clock
        assert worst_s(reference, clock, true) < 0.008
        assert len(found[source].claps) == 2
        assert abs(found[source].disagree_s) < 0.02
        assert clock.status == "found" and clock.usable
        assert worst_s(reference, clock, true) < 2.5 * clock.uncertainty_s
        drift_ppm = abs(clock.drift_ppm - true.drift_ppm)
        assert drift_ppm < 2.5 * clock.drift_uncertainty_ppm
        assert clock.drift_uncertainty_ppm < 45
        if source == "mocopi":
            assert drift_ppm < 30


def test_a_short_take_of_noisy_devices_is_covered():
    errors, stated = [], []
    for seed in range(6):
        take = device_takes.truth(seed % 2)
        rng = np.random.default_rng(seed)
        true = Clock(rng.uniform(-5, 5), rng.normal(0, 60))
        reference = device_takes.blazepose(rng, take)
        mocopi = device_takes.mocopi(rng, take, clock=true)
        clock = solve(reference, mocopi)["mocopi"].clock
        middle_s = np.mean(reference.time_s)
        errors.append(clock.from_reference(middle_s) - true.from_reference(middle_s))
        stated.append(clock.uncertainty_s)
    assert np.mean(np.abs(errors) <= 1.645 * np.array(stated)) >= 0.85
    assert np.sqrt(np.mean(np.square(errors))) < 0.008
    assert np.median(stated) < 0.01


@pytest.mark.parametrize("from_1970", [(True, False), (False, True)])
def test_a_clock_that_counts_from_1970_is_found_as_well(from_1970):
    take = device_takes.truth(0)
    rng = np.random.default_rng(0)
    reference = device_takes.device(rng, take, **CAMERAS)
    mocopi = device_takes.mocopi(rng, take, clock=Clock(0.4, 55.0))
    near = solve(reference, mocopi)["mocopi"].clock
    shifts = np.array(from_1970) * 1_715_151_474.879921
    moved = [
        replace(motion, time_s=motion.time_s + shift)
        for motion, shift in zip((reference, mocopi), shifts, strict=True)
    ]
    clock = solve(*moved)["mocopi"].clock
    own_s = near.from_reference(reference.time_s)
    assert clock.from_reference(moved[0].time_s) - shifts[1] == pytest.approx(own_s, abs=1e-5)


def test_a_stated_latency_is_reported_and_not_taken_off():
    take = device_takes.truth(0)
    rng = np.random.default_rng(0)
    reference = device_takes.device(rng, take, **CAMERAS)
    late = device_takes.mocopi(rng, take, cutoff_hz=None, causal_s=0.03)
    found = solve(reference, late, latency={"mocopi": (0.03, 0.005)})["mocopi"]
    assert (found.latency_s, found.latency_uncertainty_s) == (0.03, 0.005)
    assert found.clock.offset_s == pytest.approx(0.03, abs=0.012)  # the delay is in the offset
    assert found.clock.offset_s - found.latency_s == pytest.approx(0, abs=0.012)


def test_sources_of_one_device_have_one_clock_and_known_clocks_stay():
    take = device_takes.truth(0)
    rng = np.random.default_rng(0)
    true = Clock(1.5, 0.0)
    reference = device_takes.device(rng, take, **CAMERAS)
    rgb = device_takes.blazepose(rng, take, source="d415-rgb", clock=true)
    depth = device_takes.device(
        rng, take, source="d415-depth", kind="rgbd", clock=true, noise_m=(0.004,) * 3
    )
    mocopi = device_takes.mocopi(rng, take)
    stated = Clock(0.25, 0.0, 0.001, 0.0, "assumed", "stated")
    devices = {"d415-rgb": "d415", "d415-depth": "d415"}
    found = solve(reference, rgb, depth, mocopi, devices=devices, known={"mocopi": stated})
    assert found["d415-rgb"].clock == found["d415-depth"].clock
    assert found["d415-rgb"].clock.offset_s == pytest.approx(1.5, abs=0.008)
    assert replace(found["mocopi"].clock, doubt="") == stated
    assert re.search(r"is -2[45]\d ms beside the clock", found["mocopi"].clock.doubt)
    shared = solve(depth, rgb, devices=devices)
    assert shared["d415-rgb"].clock.offset_s == 0 and shared["d415-rgb"].clock.usable


def test_a_device_without_a_clap_is_refused_by_name():
    take = device_takes.truth(0)
    rng = np.random.default_rng(0)
    mocopi = device_takes.mocopi(rng, take)
    still = device_takes.of(
        np.tile(mocopi.xyz[:1], (300, 1, 1)), np.arange(300) / 60, "mocopi", "inertial"
    )
    with pytest.raises(InputError, match="mocopi: expected a T-pose"):
        shown([mocopi, still], {"mocopi": "suit", "mocopi-2": "suit-2"})


@pytest.mark.parametrize("still", ["cameras", "mocopi"])
def test_without_claps_of_one_source_clocks_are_unknown_and_it_is_named(still):
    take, rng = device_takes.truth(0), np.random.default_rng(0)
    motions = [device_takes.device(rng, take, **CAMERAS), device_takes.mocopi(rng, take)]
    events_of = shown(motions, device_takes.each_its_own(motions))
    events_of[still] = replace(events_of[still], claps=[])
    clock = solve(*motions, events_of=events_of)["mocopi"].clock
    assert clock.status == "unknown" and not clock.usable
    assert clock.note == f"no clap of {still}"


def test_other_peoples_claps_do_not_pair_silently():
    """With another person's motion the claps give the offset, and the note tells the difference."""
    rng = np.random.default_rng(0)
    first = device_takes.device(rng, device_takes.truth(0), **CAMERAS)
    second = device_takes.mocopi(rng, device_takes.truth(1))
    found = solve(first, second)["mocopi"]
    assert "too little alike" in found.clock.note
    assert np.isnan(found.motion_offset_s)


def test_a_recording_that_is_given_twice_is_told():
    """Its copy has another name, and agrees with it to the last digit."""
    rng, take = np.random.default_rng(0), device_takes.truth(0)
    reference = device_takes.device(rng, take, **CAMERAS)
    suits = [device_takes.mocopi(rng, take, source=name) for name in ("first", "other")]
    copy = replace(suits[0], source="copy")
    found = solve(reference, *suits, copy)
    assert [found[name].clock.doubt for name in ("first", "other")] == ["", ""]
    assert "found that of first to the last digit" in found["copy"].clock.doubt


def claps(*times_s, uncertainty_s=0.005):
    return [Clap(at_s, uncertainty_s, 0, 0.1, 2.5, 0.0, False) for at_s in times_s]


def nothing(offset_s):
    return 0.0


def times(pairs):
    return [(a.time_s, b.time_s) for a, b in pairs]


def test_claps_pair_by_their_intervals():
    pairs = devices.pair(claps(3.0, 20.0, 55.0), claps(13.01, 30.0, 65.02), nothing, "b")
    assert times(pairs) == [(3.0, 13.01), (20.0, 30.0), (55.0, 65.02)]
    assert devices.offset_s(pairs) == pytest.approx(10.01)


def test_a_clap_that_only_one_shows_is_left_out():
    pairs = devices.pair(claps(3.0, 20.0, 55.0), claps(30.0, 65.0), nothing, "b")
    assert times(pairs) == [(20.0, 30.0), (55.0, 65.0)]


def test_claps_of_a_fast_clock_still_pair():
    pairs = devices.pair(claps(0.0, 600.0), claps(5.0, 605.0 + 600 * 3e-4), nothing, "b")
    assert len(pairs) == 2


def test_the_motion_decides_where_intervals_do_not():
    def likeness(offset_s):
        return 0.8 if abs(offset_s - 47.0) < 0.1 else 0.1

    pairs = devices.pair(claps(3.0), claps(15.0, 50.0), likeness, "b")
    assert times(pairs) == [(3.0, 50.0)]


def test_what_nothing_decides_is_an_error_that_names_the_times():
    with pytest.raises(InputError, match=r"2 ways .*15\.00, 50\.00 s against 3\.00 s") as caught:
        devices.pair(claps(3.0), claps(15.0, 50.0), nothing, "mocopi against rgb")
    assert str(caught.value).startswith("mocopi against rgb")


def test_a_wrong_rate_is_named_where_as_many_claps_do_not_pair():
    """A file of 60 frames per second that states 50, for instance."""
    rate = "in order, the times between them are 1.2000 times as long: .* a wrong rate"
    with pytest.raises(InputError, match=rate):
        devices.pair(claps(4.0, 60.0), claps(4.8, 72.0), nothing, "mocopi against rgb")


def test_surer_claps_count_more():
    pairs = [*zip(claps(0.0), claps(1.0), strict=True)]
    pairs += zip(claps(9.0, uncertainty_s=0.0), claps(10.05, uncertainty_s=0.001), strict=True)
    assert devices.offset_s(pairs) == pytest.approx(1.049, abs=0.001)


def test_checks_have_a_row_per_source():
    take, rng = device_takes.truth(0), np.random.default_rng(0)
    motions = [
        device_takes.device(rng, take),
        device_takes.mocopi(rng, take, clock=Clock(2.0, 50.0)),
    ]
    found = solve(*motions, latency={"mocopi": (0.02, 0.005)})
    rows = devices.checks(found).set_index("source")
    assert rows.status.to_dict() == {"d415-rgb": "reference", "mocopi": "found"}
    assert rows.n_claps["mocopi"] == 2
    assert rows.latency_s["mocopi"] == 0.02
    assert rows.offset_s["mocopi"] == found["mocopi"].clock.offset_s
    doubtful = {"mocopi": replace(found["mocopi"], clock=Clock(doubt="sides exchanged"))}
    assert devices.checks(found | doubtful).doubt.tolist() == ["", "sides exchanged"]
