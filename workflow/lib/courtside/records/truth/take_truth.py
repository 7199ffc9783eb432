"""The truth of one virtual take: joints and rackets, clocks of the cameras, and how they shook.

Only code that evaluates a result may read it.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from courtside.records import npz
from courtside.study.errors import StrPath

FORM = "courtside take truth 2"
SPEC = {
    "time_s": ("float", ("T",)),
    "joints": ("str", ("J",)),
    "person_id": ("str", ("P",)),
    "xyz": ("float", ("P", "T", "J", "3")),
    "racket": ("float", ("P", "T", "2", "3")),
    "camera": ("str", ("C",)),
    "offset_s": ("float", ("C",)),
    "drift_ppm": ("float", ("C",)),
    "event_person": ("str", ("E",)),
    "event": ("str", ("E",)),
    "event_s": ("float", ("E",)),
    "shaken_camera": ("str", ("S",)),
    "cam_from_world": ("float", ("S", "F", "3", "4")),
    "device": ("str", ("D",)),
    "device_kind": ("str", ("D",)),
    "device_person": ("str", ("D",)),
    "device_clock": ("float", ("D", "3")),  # offset s, drift ppm, latency s
    "device_from_world": ("float", ("D", "3", "4")),
}


@dataclass(frozen=True, eq=False)
class DeviceTruth:
    """The truth of one device."""

    kind: str  # `inertial` or `rgbd`
    person: str  # whom it follows
    offset_s: float  # of its clock, as a camera's
    drift_ppm: float
    # Delay of its data: what happens at t_own on its clock is in its data at t_own + latency_s
    latency_s: float
    # (3, 4) float: world to the device's own axes, metres: of a camera its colour sensor's
    # cam_from_world; of an inertial suit at the start of the recording, for afterwards it drifts
    from_world: NDArray


@dataclass(frozen=True, eq=False)
class TakeTruth:
    """The true movement and events of a take."""

    # (T,) float: of each frame of the first camera (without cameras, the first device), whose clock
    # is the reference, and in the same steps before and after, as long as anything records:
    # mid-exposure of the middle row
    time_s: NDArray
    joints: NDArray  # (J,) str: names of the virtual body's joints
    person_id: NDArray  # (P,) str
    xyz: NDArray  # (P, T, J, 3) float: world, metres
    racket: NDArray  # (P, T, 2, 3) float: top and butt; NaN for a person without one
    # Of each camera, reference first: t_ref = (t_own - offset_s) / (1 + drift_ppm * 1e-6)
    offset_s: dict[str, float]
    drift_ppm: dict[str, float]
    # By person and event the time on the reference clock, s
    events: dict[str, dict[str, float]] = field(default_factory=dict)
    # (F, 3, 4) float: for cameras that moved: cam_from_world at each of their frames, mid-exposure
    # of the middle row
    shaken: dict[str, NDArray] = field(default_factory=dict)
    devices: dict[str, DeviceTruth] = field(default_factory=dict)


def write(path: StrPath, truth: TakeTruth) -> None:
    """Write the truth of a take to an npz file.

    A `ValueError` if shapes or cameras disagree, or events or devices name an unknown person.
    """
    people, cameras = [str(person) for person in truth.person_id], list(truth.offset_s)
    there = {*truth.events, *(device.person for device in truth.devices.values())}
    if cameras != list(truth.drift_ppm) or not there <= set(people):
        found = f"{cameras} and {list(truth.drift_ppm)}, {sorted(there)} of {people}"
        raise ValueError(
            f"{path}: expected clocks of the same cameras, events of people, found {found}"
        )
    rows = [
        (person, name, time_s)
        for person, events in truth.events.items()
        for name, time_s in events.items()
    ]
    who, what, when = zip(*rows, strict=True) if rows else ((), (), ())
    poses = np.array(list(truth.shaken.values()), dtype=float)
    arrays = {key: getattr(truth, key) for key in ("time_s", "xyz", "racket")}
    arrays |= {
        "joints": _names(truth.joints),
        "person_id": _names(people),
        "camera": _names(cameras),
        "offset_s": np.array(list(truth.offset_s.values()), dtype=float),
        "drift_ppm": np.array(list(truth.drift_ppm.values()), dtype=float),
        "event_person": _names(who),
        "event": _names(what),
        "event_s": np.array(when, dtype=float),
        "shaken_camera": _names(truth.shaken),
        "cam_from_world": poses if len(poses) else np.zeros((0, 0, 3, 4)),
    }
    arrays |= _of_devices(truth.devices)
    npz.write(path, FORM, SPEC, arrays)


def read(path: StrPath) -> TakeTruth:
    """Read the truth of a take; raise `InputError` if the file is not one of `write`."""
    arrays = npz.read(path, FORM, SPEC)
    cameras, people = arrays["camera"].tolist(), arrays["person_id"].tolist()
    events: dict[str, dict[str, float]] = {person: {} for person in people}
    rows = (arrays[key].tolist() for key in ("event_person", "event", "event_s"))
    for person, name, time_s in zip(*rows, strict=True):
        events.setdefault(person, {})[name] = time_s
    return TakeTruth(
        **{key: arrays[key] for key in ("time_s", "joints", "person_id", "xyz", "racket")},
        offset_s=dict(zip(cameras, arrays["offset_s"].tolist(), strict=True)),
        drift_ppm=dict(zip(cameras, arrays["drift_ppm"].tolist(), strict=True)),
        events=events,
        shaken=dict(zip(arrays["shaken_camera"].tolist(), arrays["cam_from_world"], strict=True)),
        devices=_devices(arrays),
    )


def _of_devices(devices: Mapping[str, DeviceTruth]) -> dict[str, NDArray]:
    """Return the arrays of the devices' truth."""
    those = list(devices.values())
    clocks = [(device.offset_s, device.drift_ppm, device.latency_s) for device in those]
    poses = [device.from_world for device in those]
    return {
        "device": _names(devices),
        "device_kind": _names(device.kind for device in those),
        "device_person": _names(device.person for device in those),
        "device_clock": np.array(clocks, dtype=float).reshape(-1, 3),
        "device_from_world": np.array(poses, dtype=float).reshape(-1, 3, 4),
    }


def _devices(arrays: Mapping[str, NDArray]) -> dict[str, DeviceTruth]:
    columns = (arrays[f"device_{key}"] for key in ("kind", "person", "clock", "from_world"))
    found = zip(arrays["device"].tolist(), *columns, strict=True)
    return {
        name: DeviceTruth(
            str(kind), str(person), float(offset), float(drift), float(late), from_world
        )
        for name, kind, person, (offset, drift, late), from_world in found
    }


def _names(values: Iterable[object]) -> NDArray:
    return np.array(list(map(str, values)), dtype=str)
