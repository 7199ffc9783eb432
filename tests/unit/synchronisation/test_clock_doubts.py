"""Clocks of devices that their claps get wrong: told by the motion; right clocks are not doubted."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.events import detect
from courtside.records.devices.clocks import Clock
from courtside.study.errors import InputError
from courtside.synchronisation import devices
from fixtures.recordings import device_takes

TRUE = Clock(2.4, 55.0)


def two(**options):
    """Return a minute of a camera and a suit, with T-pose and clap at both ends."""
    take, rng = device_takes.truth(0, between_s=46.0, fine_hz=120.0), np.random.default_rng(0)
    camera = device_takes.device(rng, take, noise_m=(0.002,) * 3)
    return camera, device_takes.mocopi(rng, take, clock=TRUE, **options)


def found(reference, suit):
    motions = [reference, suit]
    own = device_takes.each_its_own(motions)
    happened = detect.of_devices(detect.detect(motions), own)
    claps = [len(happened[motion.source].claps) for motion in motions]
    solved = devices.synchronise(motions, happened, devices=own, known={}, latency={})
    return claps, solved[suit.source].clock


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
        claps, clock = found(one, suit)
        assert claps == [1, 2]
        assert abs(clock.from_reference(30.0) - TRUE.from_reference(30.0)) < 0.02
