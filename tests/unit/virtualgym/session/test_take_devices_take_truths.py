"""The truth of a take covers what everything records, by the first clock's steps."""

import numpy as np
import pytest

from courtside.records.truth.take_truth import DeviceTruth
from virtualgym.body import skinned_body
from virtualgym.session import take as takes
from virtualgym.session import take_devices


class Walker:
    """Every joint is where the time says."""

    class motion:
        events = {"clap_1": 2.5}  # noqa: RUF012

    def joints(self, time_s):
        return np.full((len(skinned_body.JOINTS), 3), time_s)

    def racket(self, time_s):
        return np.full((2, 3), np.nan)


def truth(**change):
    settings = {
        "motion": "single_view",
        "seconds": 2.0,
        "players": {"p1": {"body": "m1"}},
        "seed": 0,
        "rate_hz": 25.0,
        "start_s": 0.5,
        "devices": {"a": {"kind": "inertial"}, "b": {"kind": "inertial", "rate_hz": 50}},
        "clocks": {"b": {"offset_s": 0.3, "drift_ppm": -200.0}},
    }
    take = takes.TakeSettings(**settings | change)
    devices = {
        name: DeviceTruth("inertial", "p1", 0.0, 0.0, 0.0, np.eye(3, 4)) for name in take.devices
    }
    return take_devices.of_take(take, {}, {"p1": Walker()}, devices)


def test_it_begins_with_the_first_device_and_ends_with_the_last():
    found = truth()
    # `b` starts 0.3 s before the reference, `a` ends 1 / 60 s before 2 s.
    np.testing.assert_allclose(found.time_s, np.arange(-8, 51) / 25)
    np.testing.assert_allclose(found.xyz[0, :, 3, 1], found.time_s + 0.5)
    assert found.events == {"p1": {"clap_1": 2.0}}
    assert (found.offset_s, found.drift_ppm, list(found.devices)) == ({}, {}, ["a", "b"])


@pytest.mark.parametrize("offset_s", [0.0, -1.0])
def test_a_late_clock_makes_it_longer(offset_s):
    found = truth(clocks={"b": {"offset_s": offset_s}})
    assert found.time_s[-1] == pytest.approx(2.0 - offset_s, abs=0.03)
    assert found.time_s[0] == 0
