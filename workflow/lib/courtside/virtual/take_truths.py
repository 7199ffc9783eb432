"""The truth of a take that was just filmed."""

import numpy as np

from courtside.records import take_truth
from courtside.virtual import body


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
        joints=np.array(body.JOINTS),
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
