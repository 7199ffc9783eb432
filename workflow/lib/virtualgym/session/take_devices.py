"""Devices of a virtual take, and the take's truth."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera
from courtside.records.devices.hierarchy import PosedHierarchy
from courtside.records.truth import take_truth
from courtside.study.execution import log
from virtualgym.body import skinned_body
from virtualgym.body.athlete import Athlete
from virtualgym.devices import depth_camera, inertial_suit, realsense_writer
from virtualgym.rendering.hall_renderer import Renderer
from virtualgym.session import parallel, session

if TYPE_CHECKING:  # it imports this module
    from virtualgym.session.take import TakeSettings

Device = depth_camera.DepthCamera | inertial_suit.InertialSuit
KINDS: dict[str, type[Device]] = {
    "rgbd": depth_camera.DepthCamera,
    "inertial": inertial_suit.InertialSuit,
}
# A take's stream of random numbers. ASSUME: no take has bystanders, whose stream in `take` is the
# same one; another number here or there makes all recordings of one of them anew.
DEVICES = 4


@dataclass(frozen=True, eq=False)
class Recorded:
    """Recordings of inertial devices, which are still to be written, and the truth, by device."""

    inertial: dict[str, PosedHierarchy]
    truth: dict[str, take_truth.DeviceTruth]


def build(name: str, settings: Mapping, players: Collection[str]) -> Device:
    """Make a device from a take's settings: `kind`, a key of KINDS, and its parameters.

    Raises
    ------
    ValueError
        If the kind, a key, a value or the subject is not valid.
    """
    kind = settings.get("kind")
    if kind not in KINDS:
        raise ValueError(f"expected a kind of {sorted(KINDS)} for device {name}, found {kind!r}")
    known = {part.name for part in fields(KINDS[kind])}
    strange = sorted(set(settings) - known - {"kind"})
    if strange:
        raise ValueError(f"expected keys of device {name} of {sorted(known)}, found {strange}")
    device = KINDS[kind](**{key: value for key, value in settings.items() if key != "kind"})
    if device.subject not in {None, *players}:
        raise ValueError(
            f"expected a subject of {sorted(players)} for device {name}, found {device.subject!r}"
        )
    return device


class Stage:
    """A hall with athletes (by person) and the depth cameras before them."""

    def __init__(
        self,
        take: "TakeSettings",
        settings: session.Settings,
        court: Court,
        athletes: Mapping[str, Athlete],
    ) -> None:
        self._take = take
        scene = session.build_hall(settings, court)
        renderer = Renderer(scene)
        self._recorders: dict[str, depth_camera.Recorder] = {}
        for at, (name, device) in enumerate(take.made_devices().items()):
            if isinstance(device, depth_camera.DepthCamera):
                colour, depth = device.place(name, athletes[subject(device, athletes)])
                seed = parallel.stream(take.seed, DEVICES, at)
                self._recorders[name] = depth_camera.Recorder(
                    device, colour, depth, renderer, list(athletes.values()), seed
                )

    def frame(self, name: str, index: int, time_s: float) -> tuple[NDArray, NDArray]:
        """Return colour and depth of frame `index` of a depth camera, at a time of the athletes."""
        return self._recorders[name].frame(index, time_s)


def subject(device: Device, athletes: Mapping[str, Athlete]) -> str:
    """Return the name of the person whom a device follows."""
    return device.subject or next(iter(athletes))


def record(
    take: "TakeSettings",
    settings: session.Settings,
    court: Court,
    athletes: Mapping[str, Athlete],
    folder: Path,
    *,
    threads: int = 1,
) -> Recorded:
    """Record with all devices of a take; `folder` receives `{device}.bag` of each depth camera.

    `threads` is the number of rendering processes; the files do not depend on it.
    """
    truth, worn = {}, {}
    filmed: dict[str, tuple[depth_camera.DepthCamera, tuple[Camera, Camera]]] = {}
    for at, (name, device) in enumerate(take.made_devices().items()):
        person = subject(device, athletes)
        if isinstance(device, inertial_suit.InertialSuit):
            found = inertial_suit.record(
                athletes[person],
                take.frame_times(name) + take.start_s,
                device.rate_hz,
                device.errors(),
                parallel.generator(take.seed, DEVICES, at),
            )
            worn[name], latency_s = found.posed, found.latency_s
            kind, pose = "inertial", found.device_from_world
        else:
            sensors = device.place(name, athletes[person])
            filmed[name] = device, sensors
            kind, latency_s, pose = "rgbd", 0.0, sensors[0].cam_from_world
        clock = take.clock(name)
        truth[name] = take_truth.DeviceTruth(
            kind, person, clock["offset_s"], clock["drift_ppm"], latency_s, pose
        )
    if filmed:
        with parallel.workers(Stage, (take, settings, court, athletes), threads) as call:
            for name, (camera, sensors) in filmed.items():
                _write_bag(folder / f"{name}.bag", take, name, camera, sensors, call)
    return Recorded(worn, truth)


def _write_bag(
    path: Path,
    take: "TakeSettings",
    name: str,
    device: depth_camera.DepthCamera,
    sensors: tuple[Camera, Camera],
    call: Callable[[str, Iterable[tuple]], Iterator],
) -> None:
    colour, depth = sensors
    times_s = take.frame_times(name) + take.start_s
    frames = call("frame", [(name, index, time_s) for index, time_s in enumerate(times_s)])
    own_s = np.arange(len(times_s)) / device.rate_hz
    shown = log.progress(zip(own_s, frames, strict=True), len(own_s), f"{name}: frames")
    realsense_writer.write(
        path,
        colour,
        depth,
        device.colour_from_depth,
        device.depth_unit_m,
        ((own, *pair) for own, pair in shown),
        baseline_m=device.baseline_m,
        rate_hz=round(device.rate_hz),
    )


def of_take(
    take: "TakeSettings",
    cameras: Mapping[int, Camera],
    athletes: Mapping[str, Athlete],
    devices: dict[str, take_truth.DeviceTruth],
) -> take_truth.TakeTruth:
    """Return the truth of a take.

    Parameters
    ----------
    take : TakeSettings
    cameras : dict of int to Camera
        Those that film, by their index in the layout.
    athletes : dict of str to Athlete
        By person.
    devices : dict of str to DeviceTruth
    """
    names = [camera.name for camera in cameras.values()]
    times_s = _covering(take, [*names, *devices])
    moving = list(athletes.values())
    at_s = times_s + take.start_s
    shaken = {}
    for at, camera in cameras.items():
        movement = take.shaking(camera, at)
        if movement is not None:
            own = [movement.camera_at(t).cam_from_world for t in take.frame_times(camera.name)]
            shaken[camera.name] = np.array(own)
    return take_truth.TakeTruth(
        time_s=times_s,
        joints=np.array(skinned_body.JOINTS),
        person_id=np.array(list(athletes)),
        xyz=np.array([[each.joints(t) for t in at_s] for each in moving]),
        racket=np.array([[each.racket(t) for t in at_s] for each in moving]),
        offset_s={name: take.clock(name)["offset_s"] for name in names},
        drift_ppm={name: take.clock(name)["drift_ppm"] for name in names},
        events={
            person: {name: time_s - take.start_s for name, time_s in each.motion.events.items()}
            for person, each in athletes.items()
        },
        shaken=shaken,
        devices=devices,
    )


def _covering(take: "TakeSettings", names: Iterable[str]) -> NDArray:
    """Return times (T,) s at the take's rate that cover the frames of all cameras and devices."""
    ends = [take.frame_times(name)[[0, -1]] for name in names]
    first = int(np.floor(min(start for start, _ in ends) * take.rate_hz + 1e-6))
    last = int(np.ceil(max(stop for _, stop in ends) * take.rate_hz - 1e-6))
    return np.arange(first, last + 1) / take.rate_hz
