"""Signals ignore axes, place and scale; their products are greatest at the true offset."""

import numpy as np
import pytest

from courtside.events import tpose
from courtside.records.devices.clocks import Clock
from courtside.synchronisation import motion_signals
from courtside.synchronisation.motion_signals import Signals
from fixtures.recordings import device_takes


def pair():
    take = device_takes.truth(0)
    first = device_takes.device(np.random.default_rng(0), take)
    second = device_takes.device(np.random.default_rng(1), take, rate_hz=60.0)
    return Signals(first, second)


def test_axes_scale_and_place_do_not_matter():
    time_s = np.arange(2.0, 8.0, 1 / 30)
    own = np.stack([time_s, time_s])
    changed = {"axes": device_takes.Y_UP, "turn": (0.3, -0.4, 1.0), "scale": 1.4}
    first = device_takes.device(np.random.default_rng(0), device_takes.truth(0))
    second = device_takes.device(
        np.random.default_rng(1), device_takes.truth(0), rate_hz=60.0, **changed
    )
    correlation = Signals(first, second).correlation(own)
    assert len(correlation) == len(motion_signals.PAIRS)
    assert correlation.min() > 0.98


def test_unlike_times_are_less_alike():
    signals = pair()
    time_s = np.arange(2.5, 7.5, 1 / 30)
    right = np.median(signals.correlation(np.stack([time_s, time_s])))
    wrong = [
        np.median(signals.correlation(np.stack([time_s, time_s + lag]))) for lag in (-0.5, 0.2, 0.7)
    ]
    assert right > 0.98 > 0.7 > max(wrong)


def test_terms_are_the_derivatives_of_the_products():
    signals = pair()
    time_s = np.arange(3.0, 7.0, 1 / 30)

    def slope(lag):
        return signals.terms(np.stack([time_s, time_s + lag]))[0, 1][0].sum()

    # The products' slope vanishes at the true offset and points to it from either side.
    assert slope(0.02) > 0 > slope(-0.02)
    curvature = signals.terms(np.stack([time_s, time_s]))[0, 1][1].sum()
    assert (slope(0.004) - slope(-0.004)) / 0.008 == pytest.approx(curvature, rel=0.1)
    assert abs(slope(0.0)) / curvature < 0.002


def test_signals_that_agree_get_the_weight():
    take = device_takes.truth(0)
    rng = np.random.default_rng(0)
    first = device_takes.device(rng, take)
    second = device_takes.device(rng, take, noise_m=(0.001, 0.001, 0.06))
    signals = Signals(first, second, [np.eye(3), np.eye(3)])  # of the camera: the third is depth
    time_s = np.arange(2.0, 8.0, 1 / 30)
    signals.weigh(np.stack([time_s, time_s]))
    weight = signals.weight.reshape(-1, 3)
    assert np.all(weight[:, 2] < 0.5 * weight[:, :2].min(axis=1))


@pytest.mark.parametrize("yaw", [0.0, 0.5, -0.8])
def test_the_common_axes_part_depth_from_the_rest_wherever_the_camera_stood(yaw):
    rng = np.random.default_rng(3)
    take = device_takes.truth(0)
    inertial = device_takes.mocopi(rng, take)
    camera = device_takes.device(rng, take, noise_m=(0.004, 0.004, 0.05), turn=(0, yaw, 0))
    motions = (camera, inertial)
    axes = motion_signals.common_axes(motions, [tpose.find(motion)[0] for motion in motions])
    assert abs(axes[0][2] @ [0, 0, 1]) > np.cos(np.radians(5))  # the last is the camera's depth
    # The same directions in both: from camera to body to mocopi.
    world = axes[0] @ device_takes.turned(device_takes.Y_DOWN, (0, yaw, 0))
    np.testing.assert_allclose(world, axes[1] @ device_takes.Y_UP, atol=0.12)


def test_missing_values_and_frames_nobody_performed_say_nothing():
    take = device_takes.truth(0)
    motion = device_takes.device(np.random.default_rng(0), take)
    xyz = motion.xyz.copy()
    xyz[100:] = np.nan
    holed = device_takes.of(xyz, motion.time_s)
    signals = Signals(motion, holed)
    time_s = motion.time_s[130:160]
    assert np.all(signals.correlation(np.stack([time_s, time_s])) == 0)
    slope, _, steep = signals.terms(np.stack([time_s, time_s]))[0, 1]
    assert not slope.any() and not steep.any()


def test_a_clock_is_not_in_the_signals():
    take = device_takes.truth(0)
    rng = np.random.default_rng(0)
    first = device_takes.device(rng, take)
    second = device_takes.device(rng, take, clock=Clock(3.0, 0.0))
    assert len(tpose.find(second)) == 2
    time_s = np.arange(2.5, 7.5, 1 / 30)
    assert Signals(first, second).correlation(np.stack([time_s, time_s + 3.0])).min() > 0.98
