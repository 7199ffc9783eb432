"""Clocks of devices that their claps get wrong: the motion tells; right ones are not doubted."""

import re
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


def test_a_clap_that_one_device_misses_is_no_doubt():
    reference, suit = two()
    for missed in CLAPS_S:
        _, right = found(reference, hidden(suit, missed - 8.0, missed + 8.0))
        assert len(right.claps) == 1 and right.clock.doubt == ""


def other_take(seed):
    """Return a take with the same T-poses and claps, and motion of its own between them."""
    times, xyz, events = long()
    noise = np.random.default_rng(seed).normal(size=xyz.shape)
    noise = ndimage.gaussian_filter1d(noise, 0.15 * 120.0, axis=0)
    swing = ndimage.gaussian_filter1d(
        np.random.default_rng(seed + 50).normal(size=xyz.shape), 40.0, axis=0
    )
    wrists = np.char.endswith(np.array(device_takes.JOINTS), "_wrist")[:, None]
    both = 0.1 * noise / noise.std() + 0.25 * wrists * swing / swing.std()
    return times, xyz + both * np.clip(20.0 - np.abs(times - 30.0), 0.0, 1.0)[:, None, None], events


@pytest.mark.parametrize("lost_s", [0.4, 2.0])
def test_frames_lost_between_two_claps_leave_one_of_each_beside_the_clock(lost_s):
    """Half of the take is then off, and each pairing leaves one clap of each device over."""
    reference, suit = two(other_take(1))
    claps, doubted = found(reference, lacking(suit, 20.0, lost_s))
    assert claps == [2, 2] and len(doubted.claps) == 1
    line = re.search(r"the clap at \d+\.\d\d s is ([+-]\d+) ms beside", doubted.clock.doubt)
    assert line and abs(abs(int(line[1])) - 1e3 * lost_s) < 30


def test_the_file_of_another_take_is_told():
    (reference, suit), (_, stranger) = two(other_take(1)), two(other_take(2))
    _, right = found(reference, suit)
    _, wrong = found(reference, stranger)
    assert right.clock.doubt == ""
    assert "look whether both files are of this take, and none lacks frames" in wrong.clock.doubt


STATED = [
    (0.0, ""),
    (0.05, ""),  # a device's delay
    (1.0, "s is -1000 ms beside the clock: look whether it is stated right"),
    (-2 * TRUE.offset_s, "and its stated clock is right"),  # the wrong sign
]


@pytest.mark.parametrize("off_s, told", STATED)
def test_a_wrong_clock_that_is_stated_is_told(off_s, told):
    motions = two(other_take(1))
    own = device_takes.each_its_own(motions)
    stated = Clock(TRUE.offset_s + off_s, TRUE.drift_ppm, note="stated")
    solved = devices.synchronise(
        motions, detect.detect(motions), devices=own, known={"mocopi": stated}, latency={}
    )
    clock = solved["mocopi"].clock
    assert (clock.offset_s, clock.usable) == (stated.offset_s, True)
    line = re.sub(r"is -(9[89]|10[012])\d ms", "is -1000 ms", clock.doubt)
    assert told in line and bool(told) == bool(line)


def frozen():
    """Return T-pose and clap at both ends, and between them somebody who does not move at all."""
    times, xyz, events = long()
    held = (times > 11.0) & (times < 47.0)
    return times, np.where(held[:, None, None], xyz[times.searchsorted(11.0)], xyz), events


def test_somebody_who_stands_still_is_not_doubted():
    """Then the noise of the devices is all there is to compare."""
    for seed in range(3):
        rng = np.random.default_rng(seed)
        reference = device_takes.blazepose(rng, frozen())
        _, right = found(reference, device_takes.mocopi(rng, frozen(), clock=TRUE))
        assert right.clock.doubt == ""
