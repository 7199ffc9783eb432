"""Devices of a virtual take and the truth that is recorded beside them."""

from dataclasses import dataclass, fields

import numpy as np

from courtside.devices.realsense import writer
from courtside.records.truth import take_truth
from courtside.study.execution import log
from virtualgym import presets
from virtualgym.body import skinned_body
from virtualgym.devices import depth_camera, inertial_suit
from virtualgym.hall import hall
from virtualgym.rendering.hall_renderer import Renderer
from virtualgym.session import parallel, session

KINDS = {"rgbd": depth_camera.DepthCamera, "inertial": inertial_suit.InertialSuit}
DEVICES = 4  # of a take's streams of random numbers, after those of `takes`


@dataclass(frozen=True, eq=False)
class Recorded:
    """What devices recorded.

    Attributes
    ----------
    inertial : dict of str to courtside.records.devices.hierarchy.PosedHierarchy
        By device: what is still to be written.
    truth : dict of str to take_truth.DeviceTruth
    """

    inertial: dict
    truth: dict


def build(name, settings, players):
    """Make a device of what a take says of it.

    Parameters
    ----------
    name : str
    settings : dict
        `kind`, a key of KINDS, and what that takes.
    players : collection of str

    Returns
    -------
    device : depth_camera.DepthCamera or inertial.InertialSuit

    Raises
    ------
    ValueError
        If the kind, a key, a value or the subject is none.
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
    """A hall with athletes and the depth cameras before them; in each process one.

    Parameters
    ----------
    take : takes.TakeSettings
    settings : capture.Settings
    court : courtside.calibration.court.court.Court
    athletes : dict of str to athlete.Athlete
    """

    def __init__(self, take, settings, court, athletes):
        self._take = take
        preset = presets.PRESETS[settings.preset]
        scene = hall.build(preset, court, parallel.stream(settings.seed, session.HALL))
        renderer = Renderer(scene)
        self._recorders = {}
        for at, (name, device) in enumerate(take.made_devices().items()):
            if isinstance(device, depth_camera.DepthCamera):
                colour, depth = device.place(name, athletes[subject(device, athletes)])
                seed = parallel.stream(take.seed, DEVICES, at)
                self._recorders[name] = depth_camera.Recorder(
                    device, colour, depth, renderer, list(athletes.values()), seed
                )

    def frame(self, name, index, time_s):
        """Return frame `index` of a depth camera, colour and depth, at a time of the athletes."""
        return self._recorders[name].frame(index, time_s)


def subject(device, athletes):
    """Return the name of whom a device follows."""
    return device.subject or next(iter(athletes))


def record(take, settings, court, athletes, folder, *, threads=1):
    """Let all devices of a take record.

    Parameters
    ----------
    take : takes.TakeSettings
    settings : capture.Settings
    court : courtside.calibration.court.court.Court
    athletes : dict of str to athlete.Athlete
    folder : Path
        Gets `{device}.bag` of each depth camera.
    threads : int
        Processes that render; the files do not depend on it.

    Returns
    -------
    recorded : Recorded
    """
    truth, worn, filmed = {}, {}, {}
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
            filmed[name] = device.place(name, athletes[person])
            kind, latency_s, pose = "rgbd", 0.0, filmed[name][0].cam_from_world
        clock = take.clock(name)
        truth[name] = take_truth.DeviceTruth(
            kind, person, clock["offset_s"], clock["drift_ppm"], latency_s, pose
        )
    if filmed:
        with parallel.crew(Stage, (take, settings, court, athletes), threads) as call:
            for name, sensors in filmed.items():
                _write_bag(folder / f"{name}.bag", take, name, sensors, call)
    return Recorded(worn, truth)


def _write_bag(path, take, name, sensors, call):
    device = take.made_devices()[name]
    colour, depth = sensors
    times_s = take.frame_times(name) + take.start_s
    frames = call("frame", [(name, index, time_s) for index, time_s in enumerate(times_s)])
    own_s = np.arange(len(times_s)) / device.rate_hz
    shown = log.progress(zip(own_s, frames, strict=True), len(own_s), f"{name}: frames")
    about = writer.Device(baseline_m=device.baseline_m, rate_hz=round(device.rate_hz))
    writer.write(
        path,
        colour,
        depth,
        device.colour_from_depth,
        device.depth_unit_m,
        ((own, *pair) for own, pair in shown),
        device=about,
    )


def of_take(take, cameras, athletes, devices):
    """Gather what really happened.

    Parameters
    ----------
    take : takes.TakeSettings
    cameras : dict of int to courtside.geometry.camera.Camera
        Those that film, by their place in the layout.
    athletes : dict of str to athlete.Athlete
    devices : dict of str to take_truth.DeviceTruth

    Returns
    -------
    truth : take_truth.TakeTruth
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


def _covering(take, names):
    """Return the times (T,) s of the first camera's frames, and of as many more as cover those of all."""
    ends = [take.frame_times(name)[[0, -1]] for name in names]
    first = int(np.floor(min(start for start, _ in ends) * take.rate_hz + 1e-6))
    last = int(np.ceil(max(stop for _, stop in ends) * take.rate_hz - 1e-6))
    return np.arange(first, last + 1) / take.rate_hz
