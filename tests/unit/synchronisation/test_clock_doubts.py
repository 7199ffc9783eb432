"""Clocks of devices that their claps get wrong: the motion tells; right ones are not doubted."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from courtside.events import detect
from courtside.records.devices.clocks import Clock
from courtside.study.errors import InputError
from courtside.synchronisation import devices
from fixtures.recordings import device_takes

TRUE = Clock(2.4, 55.0)


def long():
    return device_takes.truth(0, between_s=46.0, fine_hz=120.0)


def restless():
    """Return the same with motion that never repeats, from 10 s to 50 s."""
    times, xyz, events = long()
    noise = np.random.default_rng(1).normal(size=xyz.shape)
    noise = ndimage.gaussian_filter1d(noise, 0.15 * 120.0, axis=0)
    noise *= 0.1 / noise.std() * np.clip(20.0 - np.abs(times - 30.0), 0.0, 1.0)[:, None, None]
    return times, xyz + noise, events


def two(take=None):
    """Return a minute of a camera and a suit, with T-pose and clap at both ends."""
    rng = np.random.default_rng(0)
    camera = device_takes.device(rng, take or long(), noise_m=(0.002,) * 3)
    return camera, device_takes.mocopi(rng, take or long(), clock=TRUE)


def found(reference, suit):
    motions = [reference, suit]
    own = device_takes.each_its_own(motions)
    events_of = detect.of_devices(detect.detect(motions), own)
    claps = [len(events_of[motion.source].claps) for motion in motions]
    solved = devices.synchronise(motions, events_of, devices=own, known={}, latency={})
    return claps, solved[suit.source]


def hidden(motion, start_s, stop_s):
    """Return a motion whose wrists are not seen meanwhile, in seconds from its start."""
    from_start_s = motion.time_s - motion.time_s[0]
    at = (from_start_s >= start_s) & (from_start_s < stop_s)
    wrists = np.char.endswith(motion.joints.astype(str), "_wrist")
    xyz = np.where((at[:, None] & wrists)[..., None], np.nan, motion.xyz)
    return replace(motion, xyz=xyz)


def stopped(motion, after_s):
    kept = motion.time_s - motion.time_s[0] < after_s
    parts = {key: getattr(motion, key)[kept] for key in ("time_s", "xyz", "reason", "performed")}
    return replace(motion, **parts)


CLAPS_S = 10.0, 50.0  # the first clap is before, the second after


def test_claps_of_which_each_device_missed_another_are_refused():
    reference, suit = two()
    late = hidden(reference, 0.0, CLAPS_S[0])
    with pytest.raises(
        InputError, match=r"mocopi against d415-rgb: .* at 2\.\d\d s: each"
    ) as caught:
        found(late, stopped(suit, CLAPS_S[1]))
    assert "under clocks of the take" in str(caught.value)


def test_the_clap_that_both_show_is_enough():
    reference, suit = two()
    for one in (hidden(reference, 0.0, CLAPS_S[0]), stopped(reference, CLAPS_S[1])):
        claps, right = found(one, suit)
        clock = right.clock
        assert claps == [1, 2] and not right.clock.doubt
        assert abs(clock.from_reference(30.0) - TRUE.from_reference(30.0)) < 0.02


@pytest.mark.parametrize("seed", range(3))
def test_right_clocks_are_not_doubted(seed):
    rng = np.random.default_rng(seed)
    for take in (
        device_takes.truth(seed % 2),
        device_takes.truth(0, between_s=46.0, fine_hz=120.0),
    ):
        reference = device_takes.blazepose(rng, take, turn=(0, 0.4, 0))
        suit = device_takes.mocopi(rng, take, clock=Clock(1.3, 200.0), scale=1.05)
        _, right = found(reference, suit)
        assert right.clock.doubt == ""


def mirrored(motion):
    """Return a motion seen in a mirror: its left hand is the right one of the image."""
    names = [str(name) for name in motion.joints]
    lefts = [name.replace("right_", "left_") for name in names]
    rights = [name.replace("left_", "right_") for name in names]
    names = [b if a == name else a for name, a, b in zip(names, lefts, rights, strict=True)]
    return replace(motion, joints=np.array(names), xyz=motion.xyz * [1.0, 1.0, -1.0])


@pytest.mark.parametrize("which", [0, 1])
def test_a_mirrored_device_is_told(which):
    motions = list(two())
    motions[which] = mirrored(motions[which])
    _, doubted = found(*motions)
    line = doubted.clock.doubt
    assert line.startswith("the motions have a correlation of")
    assert "left and right of one exchanged" in line
    assert doubted.clock.usable


def lacking(motion, from_s, lost_s):
    """Return a motion that lost frames, so that all later ones have too early times."""
    from_start_s = motion.time_s - motion.time_s[0]
    kept = (from_start_s < from_s) | (from_start_s >= from_s + lost_s)
    parts = {key: getattr(motion, key)[kept] for key in ("xyz", "reason", "performed")}
    return replace(motion, time_s=motion.time_s[: kept.sum()], **parts)


@pytest.mark.parametrize("lost_s", [0.3, 1.0])
def test_lost_frames_are_told_with_when_and_how_much(lost_s):
    """One clap, so that nothing else contradicts the clock."""
    reference, suit = two(take=restless())
    _, doubted = found(reference, stopped(lacking(suit, 30.0, lost_s), CLAPS_S[1]))
    assert abs(doubted.clock.from_reference(10.0) - TRUE.from_reference(10.0)) < 0.02
    line = doubted.clock.doubt
    assert f"the motions agree -{1e3 * lost_s:.0f} ms beside the clock" in line


def test_a_drift_that_no_clock_has_is_told():
    take, rng = long(), np.random.default_rng(0)
    reference = device_takes.device(rng, take, noise_m=(0.002,) * 3)
    fast = Clock(2.4, 2000.0)
    _, doubted = found(reference, device_takes.mocopi(rng, take, clock=fast))
    assert abs(doubted.clock.drift_ppm - fast.drift_ppm) < 200
    line = doubted.clock.doubt
    assert "expected a drift of at most 800 ppm" in line
