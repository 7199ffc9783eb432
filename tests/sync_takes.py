"""A made-up person on a court, seen by cameras with clocks of their own, as networks err: exact truth."""

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

import scene
from courtside.geometry.camera import Camera
from courtside.records.keypoints.keypoints import Keypoints2D

PARTS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
JOINTS = [f"{side}_{part}" for part in PARTS for side in ("left", "right")]
BODY = np.array([(x, 0, z) for h, z in zip((0.2, 0.3, 0.3, 0.12, 0.13, 0.13),
        (1.4, 1.15, 1.0, 0.95, 0.5, 0.08), strict=True) for x in (-h, h)])  # fmt: skip
SWING_M = np.repeat([0.04, 0.15, 0.32, 0.03, 0.12, 0.12], 2)
CENTRE = np.array([3.05, 6.7])
PLACES = [(-9, -10, 3), (15, -10, 3), (-9, 23, 3.5), (15, 23, 3)]
OTHER_SIDE = [at ^ 1 for at in range(12)]


def rig(count):
    """Return cameras about 20 m from the court's centre that look there."""
    matrix = np.array([[1700, 0, 959.5], [0, 1700, 539.5], [0, 0, 1.0]])
    return [
        Camera(f"c{at}", (1920, 1080), matrix, np.zeros(5), scene.look_at(place, (*CENTRE, 1)))
        for at, place in enumerate(PLACES[:count])
    ]


def athlete(rng, seconds, *, liveliness=1.0, reach_m=2.5):
    """Return a function of time (T,) that gives joints (T, 12, 3): splines through random places."""
    slow, fast = (np.arange(-15, seconds + 15, step) for step in (0.9, 0.22))
    path = CubicSpline(slow, CENTRE + reach_m * rng.uniform(-1, 1, (len(slow), 2)))
    turn = CubicSpline(slow, rng.normal(0, liveliness, len(slow)))
    swing = CubicSpline(
        fast, rng.normal(0, liveliness, (len(fast), 12, 3)) * SWING_M[:, np.newaxis]
    )

    def joints(time_s):
        cos, sin, local = np.cos(turn(time_s)), np.sin(turn(time_s)), BODY + swing(time_s)
        x = cos[:, None] * local[..., 0] - sin[:, None] * local[..., 1]
        y = sin[:, None] * local[..., 0] + cos[:, None] * local[..., 1]
        place = path(time_s)[:, None]
        return np.stack([x + place[..., 0], y + place[..., 1], local[..., 2]], axis=-1)

    return joints


def jumper(time_s):
    """Return (T, 12, 3) of a person who does the same thing every second, on the spot."""
    phase = 2 * np.pi * np.asarray(time_s)[:, None]
    joints = np.tile(BODY, (len(phase), 1, 1))
    joints[..., :2] += CENTRE
    joints[..., 0] += SWING_M * np.sin(phase + np.arange(12))
    joints[..., 2] += 0.15 * np.sin(phase)
    return joints


def memory_noise(rng, shape, ratio):
    """Return noise (T, ...) of standard deviation 1 whose neighbours correlate by a ratio."""
    made = rng.normal(0, 1, shape)
    made[1:] *= np.sqrt(1 - ratio**2)
    return lfilter([1.0], [1.0, -ratio], made, axis=0)


def seen(rng, camera, people, own_s, clock, *, noise_px=3.0, bias_px=4.0, faults=True):
    """Return the Keypoints2D of one camera at times of its own clock."""
    rate_hz = 1 / np.median(np.diff(own_s))
    tracklets = []
    for person in people:
        xyz = person(clock.to_reference(own_s))
        xy = scene.opencv_projection(camera, xyz.reshape(-1, 3)).reshape(len(own_s), 12, 2)
        xy += noise_px * memory_noise(rng, xy.shape, np.exp(-10 / rate_hz))
        xy += 0.5 * bias_px * memory_noise(rng, xy.shape, np.exp(-0.7 / rate_hz))
        xy += bias_px * rng.normal(0, 1, (12, 2))
        tracklets.append(_faulty(rng, xy) if faults else xy)
    xy = np.stack(tracklets)
    known = np.isfinite(xy).all(axis=-1)
    return Keypoints2D(
        camera=camera.name,
        model="m",
        joints=np.array(JOINTS),
        size=np.array(camera.size),
        time_s=own_s,
        xy=xy,
        score=np.where(known, 0.8, np.nan),
        reason=np.where(known, 0, 1).astype(np.uint8),
        xyz_in_body=np.full((*known.shape, 3), np.nan),
    )


def _faulty(rng, xy):
    """Exchange the sides in a few stretches, and lose joints in others."""
    for first in np.flatnonzero(rng.random(len(xy)) < 0.003):
        stretch = slice(first, first + rng.integers(1, 15))
        xy[stretch] = xy[stretch][:, OTHER_SIDE]
    for first, joint in np.argwhere(rng.random(xy.shape[:2]) < 0.004):
        xy[first : first + rng.integers(1, 20), joint] = np.nan
    return xy
