"""A virtual athlete in an inertial suit, for tests: a performance, its true joints, recordings of it."""

from functools import cache

import numpy as np

import mannequin
import performers
from courtside.records.devices.hierarchy import forward
from virtualgym.body import athlete, skinned_body
from virtualgym.devices import inertial_suit
from virtualgym.movement import catalogue

RATE_HZ = 60.0


@cache
def performer(seed=3, free_s=9.0):
    """Return an `athlete.Athlete` that performs before a single camera."""
    figure = mannequin.dressed("m2")
    rng = np.random.default_rng(seed)
    motion = catalogue.single_view(figure.proportions, performers.COURT, rng, free_s=free_s)
    return athlete.Athlete(figure, motion, racket=False)


def times(seconds, start_s=0.0, rate_hz=RATE_HZ):
    return start_s + np.arange(round(seconds * rate_hz)) / rate_hz


def record(time_s, errors, *, seed=0, rate_hz=RATE_HZ, who=None):
    """Return an `inertial_suit.Recording`."""
    rng = np.random.default_rng(seed)
    return inertial_suit.record(who or performer(), time_s, rate_hz, errors, rng)


def found(recording):
    """Return the joints of a recording, name -> (T, 3) m; the first row is the rest pose."""
    xyz = forward(recording.posed)[0]
    return dict(zip(recording.posed.hierarchy.joints, np.moveaxis(xyz, 1, 0), strict=True))


def true(recording, time_s, who=None):
    """Return the true joints in the suit's world as it was at the start, name -> (T, 3) m."""
    xyz = np.array([(who or performer()).joints(t) for t in time_s])
    pose = recording.device_from_world
    xyz = xyz @ pose[:, :3].T + pose[:, 3]
    return dict(zip(skinned_body.JOINTS, np.moveaxis(xyz, 1, 0), strict=True))
