"""A virtual athlete's T-poses and claps as devices give them: own axes, scale, clock, noise, smoothing."""

from functools import cache

import numpy as np
from scipy import signal
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

import performers
import sync_takes
from courtside.records.devices.clocks import Clock
from courtside.records.devices.device_motion import DeviceMotion
from virtualgym.body import stance

JOINTS = [
    *(f"{s}_{p}" for p in (*sync_takes.PARTS, "toe") for s in ("left", "right")),
    "head",
]
FINE_HZ = 240.0  # of the truth
Y_UP = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])  # of world axes: mocopi's
Y_DOWN = np.array(
    [[-1.0, 0, 0], [0, 0, -1], [0, -1, 0]]
)  # of world axes: a camera's, from the front


@cache
def truth(seed=0, between_s=2.0, name="tpose_clap", fine_hz=FINE_HZ):
    """Return (times, xyz (T, J, 3) m in world, events) of a take, fine in time."""
    motion = performers.perform(name, seed, between_s=between_s)
    times = np.arange(0, motion.seconds, 1 / fine_hz)
    placed = [stance.joints(motion.stance(t), performers.BODY) for t in times]
    return times, np.array([[p[j] for j in JOINTS] for p in placed]), motion.events


def device(rng, take, *, source="d415-rgb", kind="rgb", rate_hz=30.0, clock=None, noise_m=(0, 0, 0),
           memory_s=0.05, axes=Y_DOWN, turn=None, scale=1.0, cutoff_hz=None, causal_s=None):  # fmt: skip
    """Return what a device says of a take.

    noise_m is per axis of the device. cutoff_hz smooths forwards and backwards, causal_s by a filter with
    that delay; both before sampling. turn is a rotation vector beside `axes`.
    """
    times, xyz, _ = take
    clock = clock or Clock()
    fine_hz = 1 / (times[1] - times[0])
    if cutoff_hz:
        sections = signal.butter(2, cutoff_hz / 0.802, fs=fine_hz, output="sos")
        xyz = signal.sosfiltfilt(sections, xyz, axis=0)
    if causal_s:
        ratio = np.exp(-1 / (fine_hz * causal_s))
        first = xyz[:1] * ratio
        xyz = signal.lfilter([1 - ratio], [1, -ratio], xyz, axis=0, zi=first)[0]
    start, stop = clock.from_reference(times[[0, -1]])
    own = np.arange(start + rng.uniform(0, 1 / rate_hz), stop, 1 / rate_hz)
    at = np.clip(clock.to_reference(own), times[0], times[-1])
    sampled = CubicSpline(times, xyz)(at)
    rotation = axes if turn is None else turned(axes, turn)
    sampled = scale * (sampled - sampled.mean(axis=(0, 1))) @ rotation.T + [0.3, -0.2, 3.0]
    noise = sync_takes.memory_noise(rng, sampled.shape, np.exp(-1 / (rate_hz * memory_s)))
    sampled = sampled + noise * np.asarray(noise_m)
    return of(sampled, own, source, kind)


def turned(axes, turn):
    """Return a device's axes after it was turned by a rotation vector in its own frame."""
    return Rotation.from_rotvec(turn).as_matrix() @ axes


def of(xyz, time_s, source="d415-rgb", kind="rgb", joints=JOINTS):
    """Return a DeviceMotion of complete paths."""
    known = np.isfinite(xyz).all(axis=-1)
    return DeviceMotion(
        source=source,
        kind=kind,
        joints=np.array(joints),
        time_s=np.asarray(time_s, float),
        xyz=xyz,
        reason=np.where(known, 0, 1).astype(np.uint8),
        performed=np.ones(len(xyz), bool),
    )


def blazepose(rng, take, **options):
    """Return a noisy camera's motion: 12 mm across, 40 mm in depth."""
    return device(rng, take, **{"noise_m": (0.012, 0.012, 0.04), **options})


def mocopi(rng, take, **options):
    """Return a smooth inertial motion: little noise, 6 Hz low-pass, 60 Hz, y up."""
    given = {
        "source": "mocopi",
        "kind": "inertial",
        "rate_hz": 60.0,
        "axes": Y_UP,
        "cutoff_hz": 6.0,
    }
    return device(rng, take, **{**given, "noise_m": (0.001,) * 3, "memory_s": 0.3, **options})


def each_its_own(motions):
    """Return the device of each source, where every source is a device."""
    return {motion.source: motion.source for motion in motions}
